"""The card beside a model: what it was made of, how well it reads whom, and what it is not for."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.models import NONE
from lightgesture.training.pool.patch_kinds import Originals
from lightgesture.training.pool.samples import HandRow
from lightgesture.training.svm.machine import HeldOut

LIMITS = (
    "Trained on bare hands in air; water and darkness are simulated. Gloves were seen on a few rendered hands only.",
    "Hands seen obliquely, half closed, or with the fingers together are rarer in the data than in life.",
    "A region that is no hand can still be read as a token: ask for several equal frames before acting.",
    "Pictures of real people, most published without a stated licence: check before you publish a product.",
)
"""What a user of a model has to know, whatever it was trained on."""


def data_section(
    rows: Sequence[HandRow], originals: Originals, without: Sequence[str], rendered: int
) -> dict[str, Any]:
    """Counts of pictures, sources, classes and licences as far as stated, and what stood beside the hands.

    without: sources left out. rendered: number of rendered hands.
    """
    return {
        "pictures": len(rows),
        "sources": len({row.source for row in rows}),
        "per_class": dict(sorted(Counter(row.token for row in rows).items())),
        "licences": dict(Counter(row.licence for row in rows).most_common()),
        "backgrounds": {
            "pictures": len(originals.backgrounds),
            "sources": sorted({scene.source for scene in originals.backgrounds}),
        },
        "scenes": {
            "pictures": len(originals.scenes),
            "sources": len({scene.source for scene in originals.scenes}),
        },
        "left_out": list(without),
        "rendered_hands": rendered,
    }


def held_out_section(held_out: HeldOut, classes: Sequence[str]) -> dict[str, Any]:
    """Scores of originals and of altered copies by machines that saw none of their sources.

    Accuracy is over tokens alone: the likeliest token, `none` left aside and nothing refused.
    """
    originals = _tokens(held_out, classes) & held_out.original
    altered = _tokens(held_out, classes) & ~held_out.original
    right = _right(held_out, classes)
    section: dict[str, Any] = {
        "accuracy": _mean(right[originals]),
        "accuracy_of_altered_copies": _mean(right[altered]),
        "per_class": {
            name: _mean(right[originals & (held_out.truth == number)])
            for number, name in enumerate(classes)
            if name != NONE
        },
        "per_source": {
            str(source): {
                "accuracy": _mean(right[originals & (held_out.sources == source)]),
                "pictures": int((originals & (held_out.sources == source)).sum()),
            }
            for source in np.unique(held_out.sources[originals])
        },
    }
    if NONE in classes:
        none = held_out.probabilities[:, list(classes).index(NONE)]
        truth = held_out.truth == list(classes).index(NONE)
        section["none_auroc"] = auroc(none[held_out.original & truth], none[originals])
    return section


def auroc(positives: NDArray[np.float32], negatives: NDArray[np.float32]) -> float | None:
    """Probability that a positive's value is above a negative's, ties half; None without one of either."""
    if not len(positives) or not len(negatives):
        return None
    ordered = np.sort(negatives)
    below = np.searchsorted(ordered, positives, side="left")
    not_above = np.searchsorted(ordered, positives, side="right")
    return round(float((below + not_above).mean() / (2 * len(negatives))), 4)


def _tokens(held_out: HeldOut, classes: Sequence[str]) -> NDArray[np.bool_]:
    if NONE not in classes:
        return np.ones(len(held_out.truth), bool)
    return np.asarray(held_out.truth != list(classes).index(NONE))


def _right(held_out: HeldOut, classes: Sequence[str]) -> NDArray[np.bool_]:
    tokens = held_out.probabilities.copy()
    if NONE in classes:
        tokens[:, list(classes).index(NONE)] = -1.0
    return np.asarray(tokens.argmax(axis=1) == held_out.truth)


def _mean(right: NDArray[np.bool_] | NDArray[np.float64]) -> float | None:
    return round(float(right.mean()), 4) if len(right) else None


THRESHOLDS = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
"""Least probabilities of a token at which a card tells what is kept and what is wrong."""
COST_OF_WRONG = 10.0
"""Refused hands that are as bad as one that is read wrongly: a refused sign is held a moment longer, a wrong one may
move a vehicle near a person once it has lasted for a whole hold."""


def operating_points(held_out: HeldOut, classes: Sequence[str]) -> list[dict[str, float | None]]:
    """For each threshold: the share of tokens that are read rightly, and of all hands those read as a wrong token.

    Over originals and altered copies; a hand whose likeliest class is `none` is not read. cost: of a hand, refused
    tokens counted once and wrong ones `COST_OF_WRONG` times; where it is least, the threshold is worth the most.
    """
    best = held_out.probabilities.argmax(axis=1)
    likely = held_out.probabilities.max(axis=1)
    is_token = _tokens(held_out, classes)
    names = np.array(classes)
    points = []
    for threshold in THRESHOLDS:
        is_read = (likely >= threshold) & (names[best] != NONE)
        is_right = is_read & (best == held_out.truth)
        is_wrong = is_read & ~is_right
        cost = np.where(is_token & ~is_read, 1.0, 0.0) + COST_OF_WRONG * is_wrong
        points.append(
            {
                "threshold": threshold,
                "tokens_read_rightly": _mean(is_right[is_token]),
                "hands_read_wrongly": _mean(is_wrong),
                "none_read_as_a_token": _mean(is_read[~is_token]),
                "cost": _mean(cost),
            }
        )
    return points


def summary(card: dict[str, Any], out: Path) -> list[str]:
    """What a user wants to know first, a line each."""
    scores = card["held_out_sources"]
    words = [f"{name} {value:.3f}" for name, value in scores["per_class"].items() if value is not None]
    return [
        f"{card['data']['pictures']} hands of {card['data']['sources']} sources"
        f" in {card['training']['seconds']} s",
        f"sources held out: {scores['accuracy']} of the tokens right, {scores['accuracy_of_altered_copies']} of the"
        " altered copies",
        "per class: " + ", ".join(words),
        f"wrote {out} ({out.stat().st_size / 1e6:.2f} MB) and {out.with_suffix('.json')}",
    ]
