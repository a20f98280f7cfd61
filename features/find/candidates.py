"""Candidates for hands: which places stand for different things, and their numbers, for the trees that score them.

Of a place: each net knows something that the other does not. The locator sees the person round the hand, the refiner
sees its fingers; the trees predict the overlap (IoU) of the refined box with a hand, from 0 for none.

Of a pair: do they look like the two hands of one person? Two hands that sign are about as large and as high as each
other, stand apart, have one skin, and a face between them.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from itertools import combinations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.locator import Peaks
from lightgesture.features.find.refiner import Refined
from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.geometry import keep_distinct, matched_iou, pairwise_iou
from lightgesture.features.types import Float

Rows = NDArray[np.float64]
"""float64 (n, 9), a candidate a row: box x, y, width, height in working pixels; score, its predicted IoU with a hand;
strength, how clearly it stands out (the level of its threshold or the heat of its peak; only the difference between two
counts); mean blue, green and red inside, 0 to 1."""
Point = tuple[float, float]
Numbers = Callable[[Rows, Rows, tuple[int, int], Point | None], Float]
"""See `numbers_of`."""

PLACE_COLUMNS: Final = 14
"""Numbers of one place."""
PAIR_COLUMNS: Final = 17
"""Numbers of one pair."""
MOST: Final = 8
"""Candidates kept for pairing; the time for pairs grows with the square."""
LEAST_SCORE: Final = 0.06
"""Of a candidate, 0 to 1; what lies below costs time and is never believed."""
DISTINCT_IOU: Final = 0.3
"""Candidates overlap less than this."""
APART_IOU: Final = 0.1
"""The two hands of a pair overlap at most this much."""
FAR: Final = 9.0
"""Stands for the distance of a face where none is seen, in hand sizes."""
DARKEST: Final = 0.02
"""Added to mean colours (0 to 1) before their ratio is taken, about five grey levels."""


def best_distinct(overlap: NDArray[np.float64], scores: Float) -> list[int]:
    """Numbers of the regions of the highest scores that do not overlap a better one, the best first.

    overlap: float64 (n, n), IoU of every two. scores: float32 (n,).
    """
    order = np.argsort(-scores, kind="stable")
    return keep_distinct(overlap >= DISTINCT_IOU, order[scores[order] >= LEAST_SCORE], MOST)


def logit(probabilities: Float) -> Float:
    """log(p / (1 - p)), kept finite."""
    p = np.minimum(np.maximum(probabilities, 1e-4), 1.0 - 1e-4)
    return np.asarray(np.log(p / (1.0 - p)), np.float32)


def describe_places(peaks: Peaks, refined: Refined, size: tuple[int, int]) -> Float:
    """float32 (n, PLACE_COLUMNS), one row for each peak; `size` (width, height) of the working picture."""
    count = len(peaks.heat)
    if not count:
        return np.zeros((0, PLACE_COLUMNS), np.float32)
    boxes = refined.boxes
    wide, tall = boxes[:, 2], boxes[:, 3]
    low, high = boxes[:, :2], boxes[:, :2] + boxes[:, 2:]
    sides = np.sqrt(wide * tall)
    centres = low + boxes[:, 2:] / 2
    others = pairwise_iou(boxes, boxes)
    others.ravel()[:: count + 1] -= 1.0
    inside = np.maximum(np.minimum(high, size) - np.maximum(low, 0), 0)
    numbers = np.empty((count, PLACE_COLUMNS), np.float32)
    # Written in place: laying a dozen short columns side by side takes longer than making them.
    numbers[:, 0] = logit(peaks.heat)
    numbers[:, 1] = refined.hand
    numbers[:, 2] = matched_iou(peaks.boxes, boxes)
    numbers[:, 3] = np.log(sides / min(size))
    numbers[:, 4] = np.log(wide / tall)
    numbers[:, 5] = np.log(sides / np.sqrt(peaks.boxes[:, 2] * peaks.boxes[:, 3]))
    numbers[:, 6:8] = centres / np.array(size)
    numbers[:, 8:10] = FAR
    if peaks.face is not None:
        numbers[:, 8:10] = np.abs(centres - np.array(peaks.face)) / sides[:, None]
    numbers[:, 10] = others.max(axis=1)
    numbers[:, 11] = inside[:, 0] * inside[:, 1] / (wide * tall)
    numbers[:, 12] = np.arange(count)
    numbers[:, 13] = count
    return numbers


def candidate_rows(
    boxes: NDArray[np.float32 | np.int32],
    scores: Float,
    strengths: NDArray[np.float32 | np.uint8],
    colours: Sequence[Float] | Float,
) -> Rows:
    """The rows of n candidates: boxes (n, 4), scores (n,), strengths (n,), n mean colours (3,); see `Rows`."""
    rows = np.empty((len(boxes), 9), np.float64)
    rows[:, :4], rows[:, 4], rows[:, 5] = boxes, scores, strengths
    rows[:, 6:] = np.reshape(colours, (-1, 3))
    return rows


def pair_numbers(
    candidates: Rows,
    size: tuple[int, int],
    face: Point | None,
    overlap: NDArray[np.float64] | None = None,
    numbers: Numbers | None = None,
) -> tuple[NDArray[np.intp], Float]:
    """All pairs of candidates that overlap at most `APART_IOU`, intp (pairs, 2), and their numbers, float32 (pairs,
    PAIR_COLUMNS).

    A pair has the same numbers whichever of the two comes first. size: (width, height) of the working picture. face:
    centre of the likeliest face, None where none is seen. overlap: float64 (n, n), IoU of every two where it is known.
    numbers: None for `numbers_of`.
    """
    if overlap is None:
        overlap = pairwise_iou(candidates[:, :4], candidates[:, :4])
    every = _every_two(len(candidates))
    pairs = every[overlap.take(every[:, 0] * len(candidates) + every[:, 1]) <= APART_IOU]
    if not len(pairs):
        return pairs, np.zeros((0, PAIR_COLUMNS), np.float32)
    middles = candidates[:, 0] + candidates[:, 2] / 2
    is_swapped = middles.take(pairs[:, 0]) > middles.take(pairs[:, 1])
    left, right = np.where(is_swapped, pairs.T[::-1], pairs.T)
    told = numbers or numbers_of
    return pairs, told(candidates.take(left, axis=0), candidates.take(right, axis=0), size, face)


@lru_cache(maxsize=MOST + 1)
def _every_two(count: int) -> NDArray[np.intp]:
    """intp (pairs, 2): all pairs of so many, the lower first."""
    return np.array(list(combinations(range(count), 2)), np.intp).reshape(-1, 2)


def numbers_of(a: Rows, b: Rows, size: tuple[int, int], face: Point | None) -> Float:
    """float32 (n, PAIR_COLUMNS) of n pairs, `a` being the left ones."""
    sides_a, sides_b = np.sqrt(a[:, 2] * a[:, 3]), np.sqrt(b[:, 2] * b[:, 3])
    unit = np.sqrt(sides_a * sides_b)
    centres_a, centres_b = a[:, :2] + a[:, 2:4] / 2, b[:, :2] + b[:, 2:4] / 2
    apart = (centres_b - centres_a) / unit[:, None]
    middle = (centres_a + centres_b) / 2
    contrast = np.log((a[:, 6:] + DARKEST) / (b[:, 6:] + DARKEST))
    numbers = np.empty((len(a), PAIR_COLUMNS), np.float32)
    numbers[:, 0] = np.minimum(a[:, 4], b[:, 4])
    numbers[:, 1] = np.maximum(a[:, 4], b[:, 4])
    numbers[:, 2] = np.abs(np.log(sides_a / sides_b))
    numbers[:, 3:5] = np.abs(np.log(a[:, 2:4] / b[:, 2:4]))
    numbers[:, 5] = apart[:, 0]
    numbers[:, 6] = np.abs(apart[:, 1])
    numbers[:, 7] = (b[:, 0] - a[:, 0] - a[:, 2]) / unit
    numbers[:, 8] = np.abs((a[:, 1] + a[:, 3]) - (b[:, 1] + b[:, 3])) / unit
    numbers[:, 9:11] = middle / np.array(size)
    numbers[:, 11] = np.log(unit / min(size))
    numbers[:, 12] = np.abs(contrast.mean(axis=1))
    numbers[:, 13] = np.abs(contrast[:, 2] - contrast[:, 1])
    numbers[:, 14] = np.abs(a[:, 5] - b[:, 5])
    numbers[:, 15:] = FAR
    if face is not None:
        to_face = (np.array(face) - middle) / unit[:, None]
        numbers[:, 15], numbers[:, 16] = np.abs(to_face[:, 0]), to_face[:, 1]
    return numbers


def score_pairs(trees: Trees, candidates: Rows, size: tuple[int, int], face: Point | None) -> Float:
    """float32 (n, n), symmetric, 0 to 1: how well each two candidates go together; 0 for those that overlap."""
    return scored_pairs(partial(evaluate, trees), candidates, size, face)


def scored_pairs(
    score: Callable[[Float], Float],
    candidates: Rows,
    size: tuple[int, int],
    face: Point | None,
    overlap: NDArray[np.float64] | None = None,
    numbers: Numbers | None = None,
) -> Float:
    """`score_pairs` by whatever scores rows of `pair_numbers`, float32 (pairs, PAIR_COLUMNS) -> (pairs,)."""
    together = np.zeros((len(candidates), len(candidates)), np.float32)
    pairs, rows = pair_numbers(candidates, size, face, overlap, numbers)
    if len(pairs):
        together[pairs[:, 0], pairs[:, 1]] = score(rows).clip(0.0, 1.0)
    return np.maximum(together, together.T)
