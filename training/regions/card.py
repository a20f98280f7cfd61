"""The card of a selector: what it learnt from, and how."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np

from lightgesture.results.atomic import replacing
from lightgesture.training.nets.checkpoints import peak_memory_mib, sha256_of
from lightgesture.training.pool.left_out import CARD_KEY, LeftOut
from lightgesture.training.regions.learned import Pictures
from lightgesture.training.regions.nets import RegionTraining
from lightgesture.training.regions.region_pictures import NEGATIVE_SETS, ONE_IN

MODEL: Final = (
    "selector of hand regions: locator, refiner and verifier with trees; the classical choice beside them"
)


def write_card(
    out: Path,
    seed: int,
    without: LeftOut,
    settings: RegionTraining,
    pictures: Pictures,
    seconds: int | None,
    *,
    start: str | None,
    reader: str,
    keeps_classical: bool,
) -> None:
    """Write the card of the selector's file `out` beside it.

    seconds: of the training, None where unknown. start, reader: digests of the files that the nets went on from, read
    before the training. keeps_classical: the classical choice is that of the file from which the nets went on.
    """
    import sklearn
    import torch

    both = pictures.for_nets, pictures.for_trees
    card = {
        "model": MODEL,
        "data": {
            "whole frames (webcam/train, single pictures of frames/subhi)": sum(
                len(part.frames) for part in both
            ),
            "hands cut out of hands/train": sum(len(part.hands) for part in both),
            "underwater frames without a hand": sum(len(part.empty) for part in both),
            "real divers (divers)": sum(len(part.divers) for part in both),
            "composed pictures": len(pictures.composed) + len(pictures.unseen),
            "sets of negatives used": list(NEGATIVE_SETS),
            "kept from the nets, for the trees": f"one in {ONE_IN} sources, of real divers none",
        },
        **told_of(without, seed),
        "never trained on": "frames/robochatgest, frames/drone and its people in hands/train (emre_drone), "
        "the sequences of frames/subhi, webcam/val, hands/val",
        "licences": "pictures of public repositories, most without a stated licence; no picture is part of the package",
        "limits": "real divers are of few dives, their gloves of fewer; most water and darkness is composed",
        "nets_went_on_from_the_selector_of_sha256": start,
        "verifier_went_on_from_the_larger_net_of_sha256": reader,
        "classical_trees": "of that selector" if keeps_classical else "fitted with it",
        "steps": {
            "locator": settings.locator_steps,
            "refiner": settings.refiner_steps,
            "verifier": settings.verifier_steps,
        },
        "seconds": seconds,
        "peak_memory_mib": peak_memory_mib(),
        "versions": {
            "numpy": np.__version__,
            "opencv": cv2.__version__,
            "scikit-learn": sklearn.__version__,
            "torch": str(torch.__version__),
        },
    }
    _write(out, card)


def extend_card(start: Path, out: Path, part: str, told: Mapping[str, Any]) -> None:
    """Write the card of the file `start`, where it has one, beside `out`, with a word of a part that was made anew, and
    of the file beside whose other parts it stands."""
    card = start.with_suffix(".json")
    content = json.loads(card.read_text(encoding="utf-8")) if card.is_file() else {}
    beside = {"beside_the_selector_of_sha256": sha256_of(start)}
    _write(out, {**content, "model": MODEL, part: {**told, **beside}})


def told_of(without: LeftOut, seed: int) -> dict[str, Any]:
    """What a card tells of every training."""
    return {CARD_KEY: without.to_card(), "seed": seed}


def _write(out: Path, card: Mapping[str, Any]) -> None:
    with replacing(out.with_suffix(".json")) as temporary:
        temporary.write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")
