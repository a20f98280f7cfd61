"""Numbers of a pair of regions: do they look like the two hands of one person?

Two hands that sign are about as large and as high as each other, stand apart, have one skin, and a face
between them.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.geometry import pairwise_iou

Float = NDArray[np.float32]
Point = tuple[float, float]

COLUMNS = 17
"""Numbers of one pair."""
FAR = 9.0
"""Stands for the distance of a face where none is seen, in hand sizes."""
DARKEST = 0.02
"""Added to mean colours (0 to 1) before their ratio is taken, about five grey levels."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A scored region. box: float32 (4,), x, y, width, height, working pixels. score: predicted IoU with a hand.
    strength: how clearly it stands out, the level of its threshold or the heat of its peak; only the difference
    between two counts. colour: float32 (3,), mean blue, green and red inside, 0 to 1."""

    box: Float
    score: float
    strength: float
    colour: Float


def describe_pairs(
    first: Sequence[Candidate], second: Sequence[Candidate], size: tuple[int, int], face: Point | None
) -> Float:
    """float32 (pairs, COLUMNS), one row for each first with its second, the same whichever of the two comes first.

    size: (width, height) of the working picture. face: centre of the likeliest face, None where none is seen.
    """
    if not first:
        return np.zeros((0, COLUMNS), np.float32)
    a, b = _table(first), _table(second)
    swapped = a[:, 0] + a[:, 2] / 2 > b[:, 0] + b[:, 2] / 2
    a[swapped], b[swapped] = b[swapped], a[swapped]
    sides_a, sides_b = np.sqrt(a[:, 2] * a[:, 3]), np.sqrt(b[:, 2] * b[:, 3])
    unit = np.sqrt(sides_a * sides_b)
    centres_a, centres_b = a[:, :2] + a[:, 2:4] / 2, b[:, :2] + b[:, 2:4] / 2
    apart = (centres_b - centres_a) / unit[:, None]
    middle = (centres_a + centres_b) / 2
    contrast = np.log((a[:, 6:] + DARKEST) / (b[:, 6:] + DARKEST))
    to_face = np.full((len(a), 2), FAR) if face is None else (np.array(face) - middle) / unit[:, None]
    return np.column_stack(
        [
            np.minimum(a[:, 4], b[:, 4]),
            np.maximum(a[:, 4], b[:, 4]),
            np.abs(np.log(sides_a / sides_b)),
            np.abs(np.log(a[:, 2:4] / b[:, 2:4])),
            apart[:, 0],
            np.abs(apart[:, 1]),
            (b[:, 0] - a[:, 0] - a[:, 2]) / unit,
            np.abs((a[:, 1] + a[:, 3]) - (b[:, 1] + b[:, 3])) / unit,
            middle / np.array(size),
            np.log(unit / min(size)),
            np.abs(contrast.mean(axis=1)),
            np.abs(contrast[:, 2] - contrast[:, 1]),
            np.abs(a[:, 5] - b[:, 5]),
            np.abs(to_face[:, 0]),
            to_face[:, 1],
        ]
    ).astype(np.float32)


def _table(candidates: Sequence[Candidate]) -> NDArray[np.float64]:
    """float64 (n, 9): box, score, strength, colour."""
    return np.array([(*item.box, item.score, item.strength, *item.colour) for item in candidates], np.float64)


def pair_numbers(
    candidates: Sequence[Candidate], size: tuple[int, int], face: Point | None, apart_iou: float
) -> tuple[list[tuple[int, int]], Float]:
    """All pairs of candidates that overlap at most `apart_iou`, and their numbers, float32 (pairs, COLUMNS)."""
    boxes = np.array([item.box for item in candidates]).reshape(-1, 4)
    overlap = pairwise_iou(boxes, boxes)
    count = len(candidates)
    pairs = [(i, j) for i in range(count) for j in range(i + 1, count) if overlap[i, j] <= apart_iou]
    first, second = [candidates[i] for i, _ in pairs], [candidates[j] for _, j in pairs]
    return pairs, describe_pairs(first, second, size, face)


def score_pairs(
    trees: Trees, candidates: Sequence[Candidate], size: tuple[int, int], face: Point | None, apart_iou: float
) -> Float:
    """float32 (n, n), symmetric, 0 to 1: how well each two candidates go together; 0 for those that overlap."""
    together = np.zeros((len(candidates), len(candidates)), np.float32)
    pairs, rows = pair_numbers(candidates, size, face, apart_iou)
    if pairs:
        first, second = np.array(pairs).T
        together[first, second] = evaluate(trees, rows).clip(0.0, 1.0)
    return np.maximum(together, together.T)
