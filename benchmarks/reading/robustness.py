"""How a classifier reads what is not one whole hand in an exact box: bad boxes, cut and hidden hands, no hands at all.

What is read is what the product reads: its rule, its threshold, its extra doubt at the picture's edge.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np

from lightgesture.benchmarks.contact_sheet import Image
from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.reading.hands import UNSIDED
from lightgesture.benchmarks.reading.troubles import (
    EDGES,
    cut_by_edge,
    half_covered,
    random_boxes,
    scaled_box,
    shifted_boxes,
)
from lightgesture.benchmarks.scorer import Reading as FoundHand
from lightgesture.benchmarks.scorer import is_token, matched_readings, share
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.features.types import Box
from lightgesture.hands.reading import ReadingSettings, read_token
from lightgesture.models import NONE
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Sample, fold_of

SEEN_SETS = frozenset({"funie", "rov25", "u45"})
"""Sets of `negatives` that the shipped models learn from; of the others they have seen nothing."""


SHIFT: Final = 0.1
"""Of a bad box, a share of its sides."""

SMALL, LARGE = 0.85, 1.15
"""Factors on the sides of a bad box."""

CUTS: Final = (0.25, 0.5)
"""Shares of the box beyond the picture's edge."""

RANDOM_BOXES: Final = 20
"""In each frame without a gesturing diver."""

RANDOM_SIZES: Final = (0.1, 0.6)
"""Least and largest longer side of these over the frame's shorter side."""

BOXES_NOTE = (
    "lost: accuracy in exact boxes less that in these, over all of them; worst_lost: in the worst of the directions or "
    "sizes;\nargmax over the ten tokens, nothing refused."
)
TROUBLES_NOTE = (
    "every hand of the ten tokens, from each of the four sides; right, refused, wrong: shares of what the product "
    "reads.\nThe box of a cut hand goes round what is left to see; a covered one is given whole, and nobody tells the "
    "product that it\nis covered."
)
RANDOM_NOTE = (
    "accepted: boxes that the product gives a token, though nobody signs there; unseen: sets not trained on."
)


def box_table(classifier: Classifier, samples: Iterable[Sample], model: str) -> Table:
    """Accuracy lost where the box is shifted or of another size."""
    kinds = ["exact", *(f"shifted {number}" for number in range(4)), "smaller", "larger"]
    right: Counter[str] = Counter()
    hands = 0
    for sample, box, side, truth in _token_hands(samples):
        boxes = [box, *shifted_boxes(box, SHIFT), scaled_box(box, SMALL), scaled_box(box, LARGE)]
        rows = classifier.probabilities(read_picture(sample.path), boxes, [side] * len(boxes))
        hands += 1
        for kind, row in zip(kinds, rows, strict=True):
            right[kind] += _likeliest_token(row, classifier.classes) == truth
    groups = {
        f"shifted by {SHIFT:.0%}": kinds[1:5],
        f"sides × {SMALL}": kinds[5:6],
        f"sides × {LARGE}": kinds[6:7],
    }
    rows_out: list[dict[str, Cell]] = []
    for error, members in groups.items():
        exact = share(right["exact"], hands)
        found = share(sum(right[kind] for kind in members), hands * len(members))
        worst = share(min(right[kind] for kind in members), hands)
        cells: dict[str, Cell] = {"model": model, "error": error, "readings": hands * len(members)}
        if exact is not None and found is not None and worst is not None:
            cells |= {"exact": exact, "accuracy": found, "lost": exact - found, "worst_lost": exact - worst}
        rows_out.append(cells)
    columns = ("model", "error", "readings", "exact", "accuracy", "lost", "worst_lost")
    return Table("hands_boxes", "Hands in bad boxes", columns, tuple(rows_out), BOXES_NOTE)


def trouble_table(classifier: Classifier, samples: Iterable[Sample], model: str) -> Table:
    """What the product reads of hands that are cut by the picture's edge or half covered."""
    counts: dict[str, Counter[str]] = {}
    for sample, box, side, truth in _token_hands(samples):
        image = read_picture(sample.path)
        for trouble, shown, seen, is_cut in _troubled(image, box):
            row = classifier.probabilities(np.ascontiguousarray(shown), [seen], [side])[0]
            token = read_token(row, classifier.classes, is_cut, False, ReadingSettings())[0]
            word = "refused" if token is None else "right" if token == truth else "wrong"
            counts.setdefault(trouble, Counter())[word] += 1
    rows = []
    for trouble, words in counts.items():
        total = sum(words.values())
        shares = {word: share(words[word], total) for word in ("right", "refused", "wrong")}
        rows.append({"model": model, "trouble": trouble, "readings": total, **shares})
    columns = ("model", "trouble", "readings", "right", "refused", "wrong")
    return Table("hands_hidden", "Hands cut by the edge or half hidden", columns, tuple(rows), TROUBLES_NOTE)


def _troubled(image: Image, box: Box) -> Iterable[tuple[str, Image, Box, bool]]:
    """Name of the trouble, picture, box, and whether the picture's edge cuts the hand."""
    for cut in CUTS:
        for edge in EDGES:
            yield f"{cut:.0%} beyond the edge", *cut_by_edge(image, box, edge, cut), True
    for edge in EDGES:
        yield "half covered by skin", half_covered(image, box, edge), box, False


def random_table(classifier: Classifier, samples: Sequence[Sample], model: str) -> Table:
    """Random boxes in frames without a gesturing diver that get a token; the same boxes for every model."""
    boxes_of: Counter[str] = Counter()
    frames_of: Counter[str] = Counter()
    tokens_of: dict[str, Counter[str]] = {}
    for sample in samples:
        image = read_picture(sample.path)
        random = np.random.default_rng(fold_of(f"{sample.source}/{sample.path.name}", 2**32))
        boxes = list(random_boxes((image.shape[0], image.shape[1]), RANDOM_BOXES, RANDOM_SIZES, random))
        rows = classifier.probabilities(image, boxes, [UNSIDED] * len(boxes))
        read = [read_token(row, classifier.classes, False, False, ReadingSettings())[0] for row in rows]
        for group in ("all",) if sample.source in SEEN_SETS else ("all", "unseen"):
            frames_of[group] += 1
            boxes_of[group] += len(boxes)
            tokens_of.setdefault(group, Counter()).update(token for token in read if token is not None)
    rows_out = [
        {
            "model": model,
            "sets": group,
            "frames": frames_of[group],
            "boxes": boxes_of[group],
            "accepted": (accepted := sum(tokens_of[group].values())),
            "share": share(accepted, boxes_of[group]),
            "as": ", ".join(f"{token} ({count})" for token, count in tokens_of[group].most_common(4)),
        }
        for group in sorted(boxes_of, reverse=True)
    ]
    columns = ("model", "sets", "frames", "boxes", "accepted", "share", "as")
    title = "Random boxes in frames without a gesturing diver"
    return Table("hands_random", title, columns, tuple(rows_out), RANDOM_NOTE)


FOUND_NOTE = (
    "hands: labelled ones of the ten tokens, single pictures; found: by the learned selector (IoU >= 0.5), nothing "
    "read first;\nright: argmax over the ten tokens in the found box, as the found side; read, read_wrong: by the "
    "product's rule in that box."
)


def found_table(
    classifier: Classifier, found: Sequence[tuple[Sample, Sequence[FoundHand]]], model: str
) -> Table:
    """Hands of whole frames in the boxes that a selector found, per source."""
    counts: dict[str, Counter[str]] = {}
    for sample, hands in found:
        own = counts.setdefault(sample.source, Counter())
        matches = [
            (label.token, hand)
            for label, (hand, _) in zip(sample.labels, matched_readings(sample.labels, hands), strict=True)
            if is_token(label.token)
        ]
        own["hands"] += len(matches)
        seen = [(token, hand) for token, hand in matches if hand is not None]
        own["found"] += len(seen)
        if seen:
            sides = [hand.side or UNSIDED for _, hand in seen]
            boxes = [hand.box for _, hand in seen]
            rows = classifier.probabilities(read_picture(sample.path), boxes, sides)
            for (token, _), row in zip(seen, rows, strict=True):
                read = read_token(row, classifier.classes, False, False, ReadingSettings())[0]
                own["right"] += _likeliest_token(row, classifier.classes) == token
                own["read"] += read == token
                own["read_wrong"] += read not in (None, token)
    columns = ("model", "source", "hands", "found", "right", "read", "read_wrong")
    rows_out: list[dict[str, Cell]] = [
        {"model": model, "source": source, **{name: own[name] for name in columns[2:]}}
        for source, own in counts.items()
    ]
    return Table(
        "hands_found", "Hands in boxes that the selector found", columns, tuple(rows_out), FOUND_NOTE
    )


def find_hands(
    read: Callable[[Image], Sequence[FoundHand]], samples: Iterable[Sample]
) -> list[tuple[Sample, Sequence[FoundHand]]]:
    """Each frame with the hands that `read` finds in it, at most two."""
    return [(sample, read(read_picture(sample.path))[:2]) for sample in samples]


def _token_hands(samples: Iterable[Sample]) -> Iterable[tuple[Sample, Box, str, str]]:
    for sample in samples:
        for label in sample.labels:
            if label.token is not None and is_token(label.token):
                yield sample, label.box, label.side or UNSIDED, label.token


def _likeliest_token(row: np.ndarray, classes: Sequence[str]) -> str:
    tokens = [place for place, name in enumerate(classes) if name != NONE]
    return classes[max(tokens, key=lambda place: row[place])]
