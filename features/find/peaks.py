"""From the maps of the locator to boxes: local maxima of the heat, each with the distances to its four edges."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.geometry import keep_distinct, pairwise_iou

Float = NDArray[np.float32]

STRIDE = 4
"""Working pixels for one cell of the maps."""
HAND, FACE = 0, 1
"""Planes of heat, as logits; the four that follow are the logarithms of the distances from a cell's centre to the
left, upper, right and lower edge of the hand, in working pixels."""
PLANES = 6


@dataclass(frozen=True, slots=True)
class PeakSettings:
    """most: peaks kept, 2 to 16; each costs the time of a look by the refiner. least_heat: of a peak, 0 to 1; lower
    finds hands that hardly show and costs looks. same_iou: of two peaks whose boxes overlap more, the weaker goes.
    least_face: heat at which a face is believed. most_maxima: local maxima that are looked at, so that a picture of
    specks costs a bounded time.
    """

    most: int = 6
    least_heat: float = 0.06
    same_iou: float = 0.4
    least_face: float = 0.3
    most_maxima: int = 48


@dataclass(frozen=True, slots=True, eq=False)
class Peaks:
    """boxes: float32 (n, 4), x, y, width, height in working pixels. heat: float32 (n,), 0 to 1, falling.
    face: centre x, y of the likeliest face in working pixels, None where none is seen."""

    boxes: Float
    heat: Float
    face: tuple[float, float] | None


def logistic(values: Float) -> Float:
    """1 / (1 + exp(-x))."""
    return np.asarray(1.0 / (1.0 + np.exp(-values)), np.float32)


def _maxima(plane: Float, least: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of cells above `least` that no neighbour exceeds, highest first."""
    highest = cv2.dilate(plane, np.ones((3, 3), np.uint8))
    rows, columns = np.nonzero((plane >= highest) & (plane > least))
    order = np.argsort(-plane[rows, columns], kind="stable")
    return rows[order], columns[order]


def boxes_at(maps: Float, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Float:
    """Boxes that the maps (PLANES, h, w) give for some cells: float32 (n, 4)."""
    left, top, right, bottom = np.exp(np.clip(maps[2:PLANES, rows, columns], -2.0, 6.0))
    x, y = (columns + 0.5) * STRIDE, (rows + 0.5) * STRIDE
    return np.stack([x - left, y - top, left + right, top + bottom], axis=1).astype(np.float32)


def find_peaks(maps: Float, settings: PeakSettings | None = None) -> Peaks:
    """Hands and face of the locator's maps, float32 (PLANES, h, w)."""
    settings = settings or PeakSettings()
    least = float(np.log(settings.least_heat / (1.0 - settings.least_heat)))
    rows, columns = _maxima(maps[HAND], least)
    rows, columns = rows[: settings.most_maxima], columns[: settings.most_maxima]
    boxes = boxes_at(maps, rows, columns)
    same = pairwise_iou(boxes, boxes) >= settings.same_iou
    kept = keep_distinct(same, range(len(boxes)), settings.most)
    heat = logistic(maps[HAND, rows, columns])
    return Peaks(boxes[kept], heat[kept], _face(maps[FACE], settings))


def _face(plane: Float, settings: PeakSettings) -> tuple[float, float] | None:
    _, highest, _, (column, row) = cv2.minMaxLoc(plane)
    if highest < np.log(settings.least_face / (1.0 - settings.least_face)):
        return None
    return (column + 0.5) * STRIDE, (row + 0.5) * STRIDE
