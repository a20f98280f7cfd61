"""Scoring arithmetic: boxes against labels, tokens against tokens. Pure functions, no I/O, no NumPy.

Boxes are (x, y, width, height) in pixels. A hand counts as found when a box overlaps its label with an
intersection over union (IoU) of at least `FOUND_IOU`; tokens are compared on found hands only, and a hand
that was not found counts as not read.
"""

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations

from lightgesture.features.types import Box
from lightgesture.training.datasets import Label

FOUND_IOU = 0.5
"""Least IoU of a found hand: the PASCAL VOC criterion (Everingham et al., IJCV 2010)."""

NOT_READ = "-"
"""Column of a confusion matrix for a hand that was not found or not given a token."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What a method says of one hand: its box, the diver's own side, a token or None, its track where it has one."""

    box: Box
    side: str | None
    token: str | None
    track: int | None = None


@dataclass(frozen=True, slots=True)
class Score:
    """Counts over frames; scores add up.

    hands, found: labelled hands, and those with a box at IoU >= 0.5. sides, sides_right: found hands whose
    side is known, and right. tokens: labelled hands with one of the ten tokens; read: of these, found with
    the right token; wrong: found hands (of any known token, "none" included) that were given another token.
    pairs: frames with two labelled hands, both of the ten tokens; both: of these, both hands read. extra:
    boxes on no hand, in completely labelled frames. iou_sum: summed IoU of the found hands.
    """

    frames: int = 0
    hands: int = 0
    found: int = 0
    sides: int = 0
    sides_right: int = 0
    tokens: int = 0
    read: int = 0
    wrong: int = 0
    pairs: int = 0
    both: int = 0
    extra: int = 0
    iou_sum: float = 0.0

    def __add__(self, other: "Score") -> "Score":
        return Score(*(getattr(self, name) + getattr(other, name) for name in Score.__slots__))

    @property
    def mean_iou(self) -> float | None:
        """Mean IoU of the found hands, None where none was found."""
        return self.iou_sum / self.found if self.found else None


def iou(first: Box, second: Box) -> float:
    """Intersection over union of two boxes, 0 to 1; 0 when either is empty."""
    width = min(first[0] + first[2], second[0] + second[2]) - max(first[0], second[0])
    height = min(first[1] + first[3], second[1] + second[3]) - max(first[1], second[1])
    if width <= 0 or height <= 0:
        return 0.0
    common = width * height
    return common / (first[2] * first[3] + second[2] * second[3] - common)


def match_boxes(
    boxes: Sequence[Box], labels: Sequence[Box], threshold: float = FOUND_IOU
) -> list[tuple[int, int, float]]:
    """Pair boxes with labels, one to one: as many at IoU >= threshold as can be, then the largest sum of IoU.

    Returns (index of box, index of label, IoU) in the order of the labels. Every assignment is tried, which
    suits the few hands of a frame (factorial in the smaller of the two counts).
    """
    overlaps = [[iou(box, label) for label in labels] for box in boxes]
    size = min(len(boxes), len(labels))
    best: list[tuple[int, int, float]] = []
    best_key = (0, 0.0)
    for columns in combinations(range(len(labels)), size):
        for rows in permutations(range(len(boxes)), size):
            matches = [
                (row, column, overlaps[row][column])
                for row, column in zip(rows, columns, strict=True)
                if overlaps[row][column] >= threshold
            ]
            key = (len(matches), sum(match[2] for match in matches))
            if key > best_key:
                best, best_key = matches, key
    return best


def matched_readings(
    labels: Sequence[Label], readings: Sequence[Reading]
) -> list[tuple[Reading | None, float]]:
    """For each label the reading on it, or None, and their IoU (0 without a reading)."""
    matches = match_boxes([reading.box for reading in readings], [label.box for label in labels])
    by_label = {column: (readings[row], overlap) for row, column, overlap in matches}
    return [by_label.get(index, (None, 0.0)) for index in range(len(labels))]


def score_frame(labels: Sequence[Label], readings: Sequence[Reading], complete: bool = True) -> Score:
    """Score one frame; `complete` says that every visible hand is labelled, so that other boxes are wrong."""
    pairs = list(zip(labels, matched_readings(labels, readings), strict=True))
    found = [(label, reading) for label, (reading, _) in pairs if reading is not None]
    sided = [(label, reading) for label, reading in found if label.side is not None]
    named = [label for label in labels if is_token(label.token)]
    read = [label for label, reading in found if is_token(label.token) and reading.token == label.token]
    is_pair = len(labels) == 2 and len(named) == 2
    return Score(
        frames=1,
        hands=len(labels),
        found=len(found),
        sides=len(sided),
        sides_right=sum(reading.side == label.side for label, reading in sided),
        tokens=len(named),
        read=len(read),
        wrong=sum(
            label.token is not None and reading.token is not None and reading.token != label.token
            for label, reading in found
        ),
        pairs=int(is_pair),
        both=int(is_pair and len(read) == 2),
        extra=len(readings) - len(found) if complete else 0,
        iou_sum=sum(overlap for _, (_, overlap) in pairs),
    )


def is_token(token: str | None) -> bool:
    """Whether a label is one of the ten tokens."""
    return token is not None and token != "none"


def total(scores: Iterable[Score]) -> Score:
    """Sum of scores."""
    return sum(scores, Score())


def share(right: int, count: int) -> float | None:
    """right / count, None when there is nothing to count."""
    return right / count if count else None


@dataclass(frozen=True, slots=True)
class Tally:
    """How many of `count` were right."""

    right: int
    count: int

    @property
    def accuracy(self) -> float | None:
        return share(self.right, self.count)


def accuracy_by(keys: Sequence[str], truth: Sequence[str], answers: Sequence[str | None]) -> dict[str, Tally]:
    """Right answers per key (a class, a source), keys in order of first appearance."""
    counts: Counter[str] = Counter()
    right: Counter[str] = Counter()
    for key, expected, answer in zip(keys, truth, answers, strict=True):
        counts[key] += 1
        right[key] += expected == answer
    return {key: Tally(right[key], counts[key]) for key in counts}


def macro_average(tallies: Mapping[str, Tally]) -> float | None:
    """Mean of the accuracies, each key with the same weight; None without any."""
    accuracies = [tally.accuracy for tally in tallies.values() if tally.accuracy is not None]
    return sum(accuracies) / len(accuracies) if accuracies else None


def worst(tallies: Mapping[str, Tally]) -> tuple[str, Tally] | None:
    """The key with the lowest accuracy; of equals, the one with more samples."""
    if not tallies:
        return None
    return min(tallies.items(), key=lambda item: (item[1].accuracy or 0.0, -item[1].count))


def confusion(truth: Sequence[str], answers: Sequence[str | None]) -> Counter[tuple[str, str]]:
    """How often each (truth, answer) occurred; an answer of None counts as `NOT_READ`."""
    return Counter((expected, answer or NOT_READ) for expected, answer in zip(truth, answers, strict=True))


def wilson_interval(right: int, count: int, z: float = 1.96) -> tuple[float, float]:
    """Confidence interval of a share (Wilson, JASA 1927); z = 1.96 gives 95 %. (0, 1) without samples."""
    if count == 0:
        return 0.0, 1.0
    p = right / count
    denominator = 1 + z * z / count
    centre = (p + z * z / (2 * count)) / denominator
    half = z * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count)) / denominator
    return max(0.0, centre - half), min(1.0, centre + half)


def auroc(positive: Sequence[float], negative: Sequence[float]) -> float | None:
    """Area under the ROC curve: the share of (positive, negative) pairs in right order, ties counting half.

    The Mann-Whitney statistic from average ranks (Hanley & McNeil, Radiology 1982). None when either is
    empty.
    """
    if not positive or not negative:
        return None
    ranked = sorted([(score, True) for score in positive] + [(score, False) for score in negative])
    rank_sum = 0.0
    start = 0
    while start < len(ranked):
        end = start
        while end < len(ranked) and ranked[end][0] == ranked[start][0]:
            end += 1
        average_rank = (start + 1 + end) / 2
        rank_sum += average_rank * sum(is_positive for _, is_positive in ranked[start:end])
        start = end
    least = len(positive) * (len(positive) + 1) / 2
    return (rank_sum - least) / (len(positive) * len(negative))


def percentile(values: Sequence[float], percent: float) -> float:
    """Linear-interpolated percentile of a non-empty sequence, percent 0 to 100."""
    ordered = sorted(values)
    position = (len(ordered) - 1) * percent / 100
    low = math.floor(position)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (ordered[high] - ordered[low]) * (position - low)
