"""The card beside a model: what it was made of, how well it reads whom, and what it is not for."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture._version import __version__
from lightgesture.models import NONE
from lightgesture.training.pool.kept_hands import ONE_IN
from lightgesture.training.pool.kept_sources import LEAST_FITTED, HeldOut
from lightgesture.training.pool.originals import Originals
from lightgesture.training.pool.patch_kinds import RENDERED_SOURCE
from lightgesture.training.pool.patch_pool import PatchPool
from lightgesture.training.pool.posed import POSED_SOURCE
from lightgesture.training.pool.samples import HandRow

THRESHOLDS: Final = (0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98)
"""Least probabilities of a token at which a card tells what is kept and what is wrong."""
COST_OF_WRONG: Final = 10.0
"""Refused hands that are as bad as one that is read wrongly: a refused sign is held a moment longer, a wrong one may
move a vehicle near a person once it has lasted for a whole hold."""
LICENCE_NOTE: Final = (
    "Where no licence is stated none is granted; MIT and Apache-2.0 allow use and change, CC BY-SA asks for "
    "attribution and the same terms for changed pictures. Whether weights are a change of the pictures is open. "
    "Pictures under the GPL are left out. No picture is part of the package; docs/data.md says more."
)
"""What the licences of the training pictures allow, in the card of each model."""
FEW: Final = 20
"""Pictures of a class below which a card warns."""


def make_card(
    rows: Sequence[HandRow],
    originals: Originals,
    pool: PatchPool,
    without: Sequence[str],
    held_out: HeldOut,
    classes: Sequence[str],
) -> dict[str, Any]:
    """What the card of any classifier says of its training, ready for JSON. without: sources left out."""
    return {
        "version": __version__,
        "classes": list(classes),
        "use": "hands that look like those of the pictures below, in boxes of lightgesture's selector",
        "limits": limits(rows, held_out, classes),
        "data": data_section(rows, originals, pool, without),
        "held_out_sources": held_out_section(rows, held_out, classes),
        "operating_points": operating_points(held_out, classes),
    }


def limits(rows: Sequence[HandRow], held_out: HeldOut, classes: Sequence[str]) -> list[str]:
    """What this training could not learn or not tell, a line each."""
    lines = []
    pictures = Counter(row.token for row in rows)
    sources = {name: {row.source for row in rows if row.token == name} for name in pictures}
    alone = [f"{name} ({min(sources[name])})" for name in classes if len(sources.get(name, ())) == 1]
    if alone:
        lines.append(
            f"classes whose pictures come from one source: {', '.join(alone)}; what was learnt may be "
            "that person or room, add pictures of others"
        )
    few = [f"{name} ({pictures[name]})" for name in classes if 0 < pictures[name] < FEW]
    if few:
        lines.append(f"classes of few pictures: {', '.join(few)}; add more")
    if not rows:
        lines.append("trained on rendered hands alone: no real hand was seen")
    if not held_out.original.any():
        lines.append("no hand was held out, there are too few: nothing here says how well it reads")
    elif not whole_sources(rows, held_out):
        lines.append(
            "no source was held out: the scores are of other pictures of people that it learnt from, and say little of "
            "others"
        )
    if len(held_out.truth) < LEAST_FITTED:
        lines.append(
            f"probabilities are not calibrated: {len(held_out.truth)} hands and copies were held out, {LEAST_FITTED} "
            "are needed"
        )
    if NONE not in classes:
        lines.append(
            f"there is no class {NONE}: whatever is in a box is read as one of the signs unless the probability is "
            "low; add a folder of other hands, faces and things"
        )
    unstated = sum(row.licence.startswith("none stated") for row in rows)
    if unstated:
        lines.append(
            f"{unstated} of {len(rows)} pictures state no licence: check them before you publish a product"
        )
    return lines


def whole_sources(rows: Sequence[HandRow], held_out: HeldOut) -> list[str]:
    """Sources of which the model saw nothing."""
    every = Counter(row.source for row in rows)
    kept = Counter(held_out.sources[held_out.original].tolist())
    return sorted(source for source, count in kept.items() if count >= every[source])


def data_section(
    rows: Sequence[HandRow], originals: Originals, pool: PatchPool, without: Sequence[str]
) -> dict[str, Any]:
    """Counts of pictures, sources, classes and licences as far as stated, and what stood beside the hands."""
    return {
        "pictures": len(rows),
        "sources": len({row.source for row in rows}),
        "per_class": dict(sorted(Counter(row.token for row in rows).items())),
        "sources_per_class": dict(
            sorted(Counter(token for token, _ in {(row.token, row.source) for row in rows}).items())
        ),
        "licences": dict(Counter(row.licence for row in rows).most_common()),
        "what_they_allow": LICENCE_NOTE,
        "backgrounds": {
            "pictures": len(originals.backgrounds),
            "sources": sorted({scene.source for scene in originals.backgrounds}),
        },
        "scenes": {
            "pictures": len(originals.scenes),
            "sources": len({scene.source for scene in originals.scenes}),
        },
        "divers": {
            "pictures": len(originals.divers.scenes),
            "dives": len({scene.source for scene in originals.divers.scenes}),
            "signs": len(originals.divers.shown),
            "other_hands": len(originals.divers.resting),
        },
        "left_out": list(without),
        "rendered_hands": int(np.char.startswith(pool.sources, f"{RENDERED_SOURCE} ").sum()),
        "posed_hands": int(np.char.startswith(pool.sources, f"{POSED_SOURCE} ").sum()),
        "patches": len(pool.tokens),
        "patches_with_landmarks": 0
        if pool.landmarks is None
        else int(np.isfinite(pool.landmarks).any(axis=1).sum()),
    }


def held_out_section(rows: Sequence[HandRow], held_out: HeldOut, classes: Sequence[str]) -> dict[str, Any]:
    """Scores of originals and of altered copies by machines that saw none of their sources.

    Accuracy is over tokens alone: the likeliest token, `none` left aside and nothing refused.
    """
    originals = _tokens(held_out, classes) & held_out.original
    altered = _tokens(held_out, classes) & ~held_out.original
    right = _right(held_out, classes)
    section: dict[str, Any] = {
        "kept": f"one hand or group of sources in {ONE_IN}, for the temperature and these scores",
        "whole_sources": len(whole_sources(rows, held_out)),
        "hands": int(held_out.original.sum()),
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
    """What a user wants to know first, a line each: what was learnt, how well it reads, what is wrong with it."""
    scores, data = card["held_out_sources"], card["data"]
    counts = [f"{name} {data['per_class'][name]}" for name in card["classes"] if name in data["per_class"]]
    seconds = card["training"]["seconds"]
    time = "an unknown time" if seconds is None else f"{seconds} s"
    lines = [
        f"{data['pictures']} hands of {data['sources']} sources in {time}"
        f"{': ' if counts else ''}{', '.join(counts)}"
    ]
    if scores["accuracy"] is not None:
        what = f"{scores['whole_sources']} sources" if scores["whole_sources"] else "hands of known sources"
        words = [f"{name} {value:.3f}" for name, value in scores["per_class"].items() if value is not None]
        lines += [
            f"{what} held out, {scores['hands']} hands: {scores['accuracy']} of the tokens right, "
            f"{scores['accuracy_of_altered_copies']} of the altered copies",
            "per class: " + ", ".join(words),
        ]
    lines += [f"warning: {line}" for line in card["limits"]]
    return [
        *lines,
        f"wrote {out} ({out.stat().st_size / 1e6:.2f} MB) and {out.with_suffix('.json')}",
    ]
