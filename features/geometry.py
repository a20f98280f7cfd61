"""Arithmetic on boxes; boxes are float or int arrays (n, 4) of x, y, width, height."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box


def pairwise_iou(first: NDArray[Any], second: NDArray[Any]) -> NDArray[np.float64]:
    """Intersection over union of every box of `first` (n, 4) with every one of `second` (m, 4)."""
    a = np.asarray(first, np.float64).reshape(-1, 4).T[:, :, None]
    b = np.asarray(second, np.float64).reshape(-1, 4).T[:, None, :]
    return _overlaps(a, b)


def matched_iou(first: NDArray[Any], second: NDArray[Any]) -> NDArray[np.float64]:
    """Intersection over union of each box of `first` (n, 4) with the one of `second` (n, 4) in its place."""
    return _overlaps(np.asarray(first, np.float64).T, np.asarray(second, np.float64).T)


def _overlaps(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of boxes by coordinate: (4, n, 1) and (4, 1, m), or (4, n) both."""
    both = np.minimum(a[:2] + a[2:], b[:2] + b[2:])
    both -= np.maximum(a[:2], b[:2])
    np.maximum(both, 0.0, out=both)
    overlap = both[0] * both[1]
    union = a[2] * a[3] + b[2] * b[3]
    union -= overlap
    return np.asarray(overlap / np.maximum(union, 1e-9), np.float64)


def box_iou(one: Box, other: Box) -> float:
    """Intersection over union of two boxes, without the arrays that take longer to make than this takes."""
    across = min(one[0] + one[2], other[0] + other[2]) - max(one[0], other[0])
    down = min(one[1] + one[3], other[1] + other[3]) - max(one[1], other[1])
    both = max(across, 0) * max(down, 0)
    return both / max(one[2] * one[3] + other[2] * other[3] - both, 1)


def keep_distinct(same: NDArray[np.bool_], order: Iterable[int], most: int) -> list[int]:
    """Greedy choice: the first `most` numbers of `order` that are not the same as one kept before.

    same: bool (n, n), symmetric, which two boxes stand for one thing. order: numbers below n, the best first.
    """
    kept: list[int] = []
    dropped = np.zeros(len(same), bool)
    for index in order:
        if len(kept) == most:
            break
        if not dropped[index]:
            kept.append(int(index))
            dropped |= same[index]
    return kept


def scale_boxes(boxes: NDArray[Any], scale: tuple[float, float], size: tuple[int, int]) -> list[Box]:
    """Boxes of the working picture, (n, 4), in source pixels, kept inside `size` (width, height)."""
    across, down = scale
    found = []
    # A handful of boxes: the calls on arrays would take longer than the numbers.
    for x, y, width, height in boxes.astype(np.float64).tolist():
        left = min(max(round(x * across), 0), size[0] - 1)
        top = min(max(round(y * down), 0), size[1] - 1)
        right, bottom = min(round((x + width) * across), size[0]), min(round((y + height) * down), size[1])
        found.append((left, top, max(right - left, 1), max(bottom - top, 1)))
    return found


def whole_box(place: tuple[float, float, float, float], size: tuple[int, int]) -> Box:
    """x, y, width, height in whole pixels, kept inside a picture of `size` (width, height): `scale_boxes` of one."""
    x, y, width, height = place
    left, top = min(max(round(x), 0), size[0] - 1), min(max(round(y), 0), size[1] - 1)
    right, bottom = min(round(x + width), size[0]), min(round(y + height), size[1])
    return left, top, max(right - left, 1), max(bottom - top, 1)


def mirror_box(box: Box, width: int) -> Box:
    """The box in the picture flipped left to right; `width` of the picture in pixels."""
    return width - box[0] - box[2], box[1], box[2], box[3]


def turn_box(box: Box, size: tuple[int, int], degrees: int) -> Box:
    """The box in the picture turned clockwise by 0, 90, 180 or 270 degrees; `size`: its width and height before."""
    (x, y, wide, tall), (width, height) = box, size
    for _ in range(degrees // 90 % 4):
        x, y, wide, tall = height - y - tall, x, tall, wide
        width, height = height, width
    return x, y, wide, tall
