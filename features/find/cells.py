"""Numbers of a proposal for the scorer: what the picture looks like inside and around its box.

Seven channels (luma, skin, gradient magnitude and the gradient in four directions) are averaged over a grid of
cells of the widened box through integral images, as in Dollár, Tu, Perona and Belongie, "Integral
Channel Features", 2009: a box costs the same whatever its size.
"""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.proposals import Proposals
from lightgesture.features.types import Float

CELLS: Final = 6
"""Along each side of the widened box."""
CONTEXT: Final = 1.4
"""Side of the widened box over the side of the region's own, so that the grid sees what stands around a hand."""
DIRECTIONS: Final = 4
"""Gradient directions over half a turn."""
SHAPE_NUMBERS: Final = 9
"""Place, size and outline of a region."""
COLUMNS: Final = (3 + DIRECTIONS) * CELLS**2 + SHAPE_NUMBERS
"""Numbers of one proposal."""


def channels(colour: ColourMap) -> Float:
    """float32 (7, h, w): luma and skin in 0 to 1, gradient magnitude, gradient in four directions."""
    luma = cv2.cvtColor(colour.picture, cv2.COLOR_BGR2GRAY).astype(np.float32) / 255.0
    # The square root lifts the dark end, where a back-lit hand differs from the wall by two grey levels.
    luma = np.sqrt(luma)
    dx = cv2.Sobel(luma, cv2.CV_32F, 1, 0, ksize=3)
    dy = cv2.Sobel(luma, cv2.CV_32F, 0, 1, ksize=3)
    magnitude = np.sqrt(dx * dx + dy * dy)
    angle = np.arctan2(dy, dx)
    direction = np.floor(angle * (DIRECTIONS / np.pi) + 0.5).astype(np.int32) % DIRECTIONS
    directed = [np.where(direction == index, magnitude, 0.0) for index in range(DIRECTIONS)]
    return np.stack([luma, colour.skin.astype(np.float32) / 255.0, magnitude, *directed]).astype(np.float32)


def _cell_means(stack: Float, boxes: NDArray[np.int32]) -> Float:
    """Mean of each channel in each cell: float32 (n, channels, cells, cells). Outside the picture counts
    as not there: a cell's mean is over its visible part, 0 where there is none."""
    height, width = stack.shape[1:]
    integrals = np.zeros((stack.shape[0], height + 1, width + 1), np.float64)
    for index, channel in enumerate(stack):
        integrals[index] = cv2.integral(channel, sdepth=cv2.CV_64F)
    steps = np.linspace(-0.5, 0.5, CELLS + 1) * CONTEXT
    centre = boxes[:, :2] + boxes[:, 2:] / 2.0
    columns = np.rint(centre[:, :1] + boxes[:, 2:3] * steps).astype(np.int64).clip(0, width)
    rows = np.rint(centre[:, 1:] + boxes[:, 3:4] * steps).astype(np.int64).clip(0, height)
    corners = integrals[:, rows[:, :, None], columns[:, None, :]].transpose(1, 0, 2, 3)
    sums = np.diff(np.diff(corners, axis=2), axis=3)
    areas = np.diff(rows, axis=1)[:, :, None] * np.diff(columns, axis=1)[:, None, :]
    return np.asarray(sums / np.maximum(areas, 1)[:, None], np.float32)


def _shapes(proposals: Proposals, size: tuple[int, int]) -> Float:
    """float32 (n, 9): place, size and outline of each region, free of the picture's resolution."""
    boxes = proposals.boxes.astype(np.float32)
    shorter = float(min(size))
    area = np.array([cv2.contourArea(contour) for contour in proposals.contours], np.float32)
    hull = np.array([cv2.contourArea(cv2.convexHull(c)) for c in proposals.contours], np.float32)
    length = np.array([len(contour) for contour in proposals.contours], np.float32)
    width, height = boxes[:, 2], boxes[:, 3]
    return np.stack(
        [
            (boxes[:, 0] + width / 2) / size[0],
            (boxes[:, 1] + height / 2) / size[1],
            np.log(width / shorter),
            np.log(height / shorter),
            np.log(width / height),
            area / (width * height),
            area / np.maximum(hull, 1.0),
            length / np.sqrt(np.maximum(area, 1.0)),
            proposals.cut.astype(np.float32),
        ],
        axis=1,
    ).astype(np.float32)


def describe(colour: ColourMap, proposals: Proposals) -> Float:
    """float32 (n, 7 × cells² + 9): one row for each proposal.

    Luma is taken relative to the box's own mean and spread, gradients relative to the box's mean
    gradient, so that neither exposure nor veil moves the numbers; skin stays as it is.
    """
    if not len(proposals):
        return np.zeros((0, COLUMNS), np.float32)
    means = _cell_means(channels(colour), proposals.boxes)
    luma = means[:, :1]
    centred = luma - luma.mean(axis=(2, 3), keepdims=True)
    luma = centred / (luma.std(axis=(2, 3), keepdims=True) + np.float32(0.01))
    gradient = means[:, 2:] / (means[:, 2:3].mean(axis=(2, 3), keepdims=True) + np.float32(0.005))
    cells = np.concatenate([luma, means[:, 1:2], gradient], axis=1).reshape(len(proposals), -1)
    height, width = colour.skin.shape
    return np.concatenate([cells, _shapes(proposals, (width, height))], axis=1).astype(np.float32)
