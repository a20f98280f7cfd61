"""Numbers of a region for the scorer: what the picture looks like inside and around its box.

Seven channels (luma, skin, gradient magnitude and the gradient in four directions) are averaged over a grid of
cells of the widened box through integral images, as in Dollár, Tu, Perona and Belongie, "Integral
Channel Features", 2009: a box costs the same whatever its size.

All is whole numbers up to the last division, so that a compiled loop (`features/compiled/`) and NumPy (`PLAIN`) give
the same bytes.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.proposals import Proposals
from lightgesture.features.types import Float, Image

CELLS: Final = 6
"""Along each side of the widened box."""
CONTEXT_TENTHS: Final = 14
"""Side of the widened box over the side of the region's own, in tenths, so that the grid sees what stands around a
hand."""
DIRECTIONS: Final = 4
"""Gradient directions over half a turn."""
SHAPE_NUMBERS: Final = 9
"""Place, size and outline of a region."""
COLUMNS: Final = (3 + DIRECTIONS) * CELLS**2 + SHAPE_NUMBERS
"""Numbers of one region."""
PART: Final = 16
"""Steps of a level in the mean of a cell."""
LUMA_FLOOR: Final = 41
"""Added to the deviation of luma over the cells, in steps: one hundredth of the range, below which it is noise."""
GRADIENT_FLOOR: Final = 5
"""Added to the mean gradient of the cells, in steps."""

AT_ONCE: Final = 48
"""Boxes that NumPy looks at together: what is kept of more of them leaves the near caches."""

Sums = NDArray[np.int32]
"""int32 (2 + DIRECTIONS, h + 1, w + 1): integral images of luma, skin and the gradient in each direction, of 8 bits."""


@dataclass(frozen=True, slots=True)
class CellLoops:
    """The passes over pixels and over cells.

    sums: (luma, skin, room): writes the `Sums` of two pictures, uint8 (h, w), there. cells: (sums, boxes), boxes int32
        (n, 4), -> float32 (n, (3 + DIRECTIONS) CELLS²). shapes: (regions, size) -> float32 (n, SHAPE_NUMBERS), place,
        size and outline of each region in a picture of `size`, (width, height), free of its resolution.
    """

    sums: Callable[[Image, Image, Sums], None]
    cells: Callable[[Sums, NDArray[np.int32]], Float]
    shapes: Callable[[Proposals, tuple[int, int]], Float]


# The square root lifts the dark end, where a back-lit hand differs from the wall by two grey levels.
_ROOTS: Final = np.rint(np.sqrt(np.arange(256) * 255.0)).astype(np.uint8)


def channel_sums(
    picture: Image, skin: Image, loops: CellLoops | None = None, room: Sums | None = None
) -> Sums:
    """The integral images of a BGR picture, uint8 (h, w, 3), and its skin map, uint8 (h, w).

    room: is used for them where it has their size, because memory that the system must give anew for every frame takes
    longer than the sums.
    """
    luma = np.asarray(cv2.LUT(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), _ROOTS), np.uint8)
    shape = 2 + DIRECTIONS, luma.shape[0] + 1, luma.shape[1] + 1
    found = room if room is not None and room.shape == shape else np.empty(shape, np.int32)
    (loops or PLAIN).sums(luma, skin, found)
    return found


def describe(sums: Sums, regions: Proposals, size: tuple[int, int], loops: CellLoops | None = None) -> Float:
    """float32 (n, COLUMNS): one row for each region of a picture of `size`, (width, height).

    Luma is taken relative to the box's own mean and spread, gradients relative to the box's mean
    gradient, so that neither exposure nor veil moves the numbers; skin stays as it is.
    """
    if not len(regions):
        return np.zeros((0, COLUMNS), np.float32)
    loops = loops or PLAIN
    return np.concatenate([loops.cells(sums, regions.boxes), loops.shapes(regions, size)], axis=1)


def _plain_shapes(regions: Proposals, size: tuple[int, int]) -> Float:
    x, y, width, height = regions.boxes.T.astype(np.float64)
    contours = regions.contours
    area = np.array([cv2.contourArea(contour) for contour in contours])
    hull = np.array([cv2.contourArea(cv2.convexHull(contour)) for contour in contours])
    rows = np.empty((len(regions), SHAPE_NUMBERS), np.float32)
    rows[:, 0] = (x + width / 2) / size[0]
    rows[:, 1] = (y + height / 2) / size[1]
    rows[:, 2] = width / min(size)
    rows[:, 3] = height / min(size)
    rows[:, 4] = width / height
    rows[:, 5] = area / (width * height)
    rows[:, 6] = area / np.maximum(hull, 1.0)
    rows[:, 7] = regions.lengths / np.sqrt(np.maximum(area, 1.0))
    rows[:, 8] = regions.cut
    return rows


def _plain_sums(luma: Image, skin: Image, room: Sums) -> None:
    dx = np.asarray(cv2.Sobel(luma, cv2.CV_16S, 1, 0, ksize=3), np.int16)
    dy = np.asarray(cv2.Sobel(luma, cv2.CV_16S, 0, 1, ksize=3), np.int16)
    across, down = np.abs(dx), np.abs(dy)
    wide, tall = across.astype(np.int32), down.astype(np.int32)
    strength = np.sqrt((wide * wide + tall * tall).astype(np.float32))
    # A step of luma gives Sobel's sums four times itself; stronger edges than 255 levels count as that.
    strength *= np.float32(0.25)
    magnitude = np.minimum(strength, np.float32(255.0)).astype(np.uint8)
    # 12 / 29 is the tangent of an eighth of a turn's half.
    along_x, along_y = 29 * tall < 12 * wide, 29 * wide < 12 * tall
    rising = (dx ^ dy) >= 0
    slanted = ~(along_x | along_y)
    masks = along_x, slanted & rising, along_y, slanted & ~rising
    planes = [luma, skin, *(magnitude * mask for mask in masks)]
    for plane, found in zip(planes, room, strict=True):
        cv2.integral(plane, found, cv2.CV_32S)


def _edges(start: NDArray[np.int32], side: NDArray[np.int32], end: int) -> NDArray[np.int32]:
    """int32 (n, CELLS + 1): the borders of the cells, start + side (1/2 + 1.4 (k / 6 - 1/2)) to the nearest pixel."""
    steps = np.arange(CELLS + 1, dtype=np.int32) * CONTEXT_TENTHS + (5 * CELLS - CELLS * CONTEXT_TENTHS // 2)
    unit = 10 * CELLS
    return ((unit * start[:, None] + side[:, None] * steps + unit // 2) // unit).clip(0, end)


def _plain_cells(sums: Sums, boxes: NDArray[np.int32]) -> Float:
    parts = [_some_cells(sums, boxes[first : first + AT_ONCE]) for first in range(0, len(boxes), AT_ONCE)]
    return np.concatenate([np.zeros((0, (3 + DIRECTIONS) * CELLS**2), np.float32), *parts])


def _some_cells(sums: Sums, boxes: NDArray[np.int32]) -> Float:
    planes, height, width = sums.shape
    columns = _edges(boxes[:, 0], boxes[:, 2], width - 1)
    rows = _edges(boxes[:, 1], boxes[:, 3], height - 1)
    places = rows[:, :, None] * width + columns[:, None, :]
    corners = sums.reshape(planes, -1).take(places, axis=1)
    strips = corners[:, :, 1:] - corners[:, :, :-1]
    totals = strips[..., 1:] - strips[..., :-1]
    areas = np.diff(rows, axis=1)[:, :, None] * np.diff(columns, axis=1)[:, None, :]
    # Double precision holds all these whole numbers, and rounding does not lift a quotient to the next one.
    whole = np.concatenate([totals[:2], totals[2:].sum(axis=0, keepdims=True), totals[2:]]).astype(np.float64)
    means = np.floor((whole * PART + areas // 2) / np.maximum(areas, 1))
    means = means.reshape(len(whole), len(boxes), CELLS**2)
    luma, skin, gradients = means[0], means[1], means[2:]
    count = CELLS**2
    total = luma.sum(axis=1, keepdims=True)
    spread = np.sqrt(count * (luma * luma).sum(axis=1, keepdims=True) - total * total)
    found = np.empty((len(boxes), 3 + DIRECTIONS, count), np.float32)
    found[:, 0] = (count * luma - total) / (spread + count * LUMA_FLOOR)
    found[:, 1] = skin / (255 * PART)
    strength = gradients[0].sum(axis=1) + count * GRADIENT_FLOOR
    found[:, 2:] = ((count * gradients) / strength[:, None]).transpose(1, 0, 2)
    return found.reshape(len(boxes), (3 + DIRECTIONS) * count)


PLAIN: Final = CellLoops(_plain_sums, _plain_cells, _plain_shapes)
