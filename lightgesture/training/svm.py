"""From a manifest to a model file and its card: the training of the SVM from end to end."""

import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

from lightgesture._version import __version__
from lightgesture.features.vector import block_lengths
from lightgesture.models import CLASSES
from lightgesture.models.archive import write_file
from lightgesture.models.projection import Progress
from lightgesture.models.svm_file import SvmModel, write_svm_model
from lightgesture.models.train_svm import HeldOut, SvmSettings, train_svm
from lightgesture.training.card import LIMITS, data_section, held_out_section, operating_points
from lightgesture.training.negatives import Scene, read_backgrounds, read_scenes
from lightgesture.training.samples import HandRow, LabelledHand, load_hand, read_rows
from lightgesture.training.stream import StreamSettings, stream
from lightgesture.training.synthetic import SyntheticSettings, synthetic_hands


@dataclass(frozen=True, slots=True)
class SvmTraining:
    """What is trained from what.

    data: manifest, or folder with a folder a class, or None to train on rendered hands alone. backgrounds: folders of
    pictures without hands. scenes: table of whole pictures with boxes of hands and faces, or None. without: sources of
    `data` that are left out. synthetic: number of rendered hands beside the real ones. seed: of everything drawn. The
    rest: settings.
    """

    data: Path | None
    backgrounds: tuple[Path, ...] = ()
    scenes: Path | None = None
    without: tuple[str, ...] = ()
    synthetic: int = 0
    seed: int = 0
    stream: StreamSettings = field(default_factory=StreamSettings)
    svm: SvmSettings = field(default_factory=SvmSettings)
    rendered: SyntheticSettings = field(default_factory=SyntheticSettings)


def train_to_file(training: SvmTraining, out: Path, progress: Progress) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    Raises InputError for unreadable data and ModelError for samples or files that will not do; neither file is
    touched before the training is done.
    """
    started = time.monotonic()
    every_row = [] if training.data is None else read_rows(training.data)
    rows = [row for row in every_row if row.source not in training.without]
    hands = load_hands(rows, progress)
    negative = training.stream.negative
    backgrounds = [scene for folder in training.backgrounds for scene in read_backgrounds(folder, negative)]
    scenes = read_scenes(training.scenes, negative) if training.scenes else []
    present = {row.token for row in rows} or set(CLASSES)
    rendered = synthetic_hands(
        training.synthetic,
        training.seed,
        training.rendered,
        training.stream.augment,
        original=not rows,
    )
    samples = chain(stream(hands, backgrounds, scenes, training.stream, training.seed), rendered)
    model, held_out = train_svm(
        samples,
        training.svm,
        classes=[name for name in CLASSES if name in present],
        seed=training.seed,
        progress=progress,
    )
    card = make_card(training, rows, (backgrounds, scenes), model, held_out)
    card["training"]["seconds"] = round(time.monotonic() - started)
    write_svm_model(model, out)
    write_file(out.with_suffix(".json"), (json.dumps(card, indent=1) + "\n").encode())
    return card


def load_hands(rows: Sequence[HandRow], progress: Progress) -> list[LabelledHand]:
    """Read the pictures of all rows."""
    hands = []
    for number, row in enumerate(rows, 1):
        hands.append(load_hand(row))
        progress("read pictures", number, len(rows))
    return hands


def make_card(
    training: SvmTraining,
    rows: Sequence[HandRow],
    others: tuple[Sequence[Scene], Sequence[Scene]],
    model: SvmModel,
    held_out: HeldOut,
) -> dict[str, Any]:
    """The card of a trained model, ready for JSON."""
    backgrounds, scenes = others
    gradients, contour = block_lengths(model.features)
    return {
        "name": "svm",
        "version": __version__,
        "what": "hand patch to token: gradients and contour numbers, radial least-squares SVM of fixed size",
        "classes": list(model.classes),
        "use": "bare hands of a diver facing the camera, in boxes of lightgesture's selector",
        "limits": list(LIMITS),
        "data": {
            **data_section(rows),
            "backgrounds": {"pictures": len(backgrounds), "sources": sorted({s.source for s in backgrounds})},
            "scenes": {"pictures": len(scenes), "sources": len({s.source for s in scenes})},
            "left_out": list(training.without),
            "rendered_hands": training.synthetic,
        },
        "training": {
            "seed": training.seed,
            "samples": len(held_out.truth),
            "originals": int(held_out.original.sum()),
            "settings": {
                "stream": asdict(training.stream),
                "svm": asdict(training.svm),
                "rendered": asdict(training.rendered),
            },
        },
        "model": {
            "numbers_of_a_patch": {"gradients": gradients, "contour": contour},
            "vectors": len(model.centres),
            "gamma": model.gamma,
            "temperature": model.temperature,
        },
        "held_out_sources": held_out_section(held_out, model.classes),
        "operating_points": operating_points(held_out, model.classes),
    }
