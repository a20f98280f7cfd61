"""Where hands are: a tiny int8 net over the whole standardised picture.

One stage, without anchors: heat at the middle of each hand (Zhou, Wang and Krähenbühl, "Objects as Points", 2019) and
the distances to the four edges of its box (Tian, Shen, Chen and He, "FCOS", 2019), on a grid of 4 working pixels. A
second plane of heat marks faces, which tell the axis of the body. Peaks are local maxima of the heat, each with a box.

The net sees twice the width and height of the working picture, at which the fingers of a diver's small, pale hand still
stand apart. Its first layers halve the picture three times, so that this takes a third more products than the working
picture would, and not four times as many.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.geometry import keep_distinct, pairwise_iou
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Levels, Network, logistic
from lightgesture.features.standardise import channel_tables
from lightgesture.features.types import Float, Image

DETAIL: Final = 2
"""Pixels that the net sees along one of the working picture."""
MULTIPLE: Final = 32
"""Height and width that the net sees are multiples of its coarsest grid; the rest is filled with the mean colour."""
INPUT, HEAT, EDGES = "picture", "heat", "edges"
"""Tensors of the net. Heat and edges are apart because one scale of eight bits would not fit both."""
STRIDE: Final = 4
"""Working pixels for one cell of the maps."""
HAND, FACE = 0, 1
"""Planes of heat, as logits; the four that follow are the logarithms of the distances from a cell's centre to the
left, upper, right and lower edge of the hand, in working pixels."""
PLANES: Final = 6
MOST_PEAKS: Final = 6
"""Peaks kept; each costs the time of a look by the refiner."""
LEAST_HEAT: Final = 0.06
"""Of a peak, 0 to 1; lower finds hands that hardly show and costs looks."""
SAME_IOU: Final = 0.4
"""Of two peaks whose boxes overlap more, the weaker goes."""
LEAST_FACE: Final = 0.3
"""Heat at which a face is believed, 0 to 1."""
MOST_MAXIMA: Final = 48
"""Local maxima that are looked at, so that a picture of specks costs a bounded time."""


_NEIGHBOURS: Final = np.ones((3, 3), np.uint8)


@dataclass(frozen=True, slots=True, eq=False)
class Peaks:
    """boxes: float32 (n, 4), x, y, width, height in working pixels. heat: float32 (n,), 0 to 1, falling.
    face: centre x, y of the likeliest face in working pixels, None where none is seen."""

    boxes: Float
    heat: Float
    face: tuple[float, float] | None


class Locator:
    """Runs the net on pictures of any size."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = Network(network)

    def table(self, picture: Image) -> Levels:
        """int8 (1, 256, 3): the integer that stands for each value of each channel of a picture."""
        return self._network.table(INPUT, channel_tables(picture))

    def process(self, colour: ColourMap, tables: Levels) -> Float:
        """Maps of a picture, float32 (6, h, w) on cells of 4 working pixels; see `HAND`.

        tables: `table` of the working picture.
        """
        seen = np.asarray(cv2.LUT(detailed(colour), tables), np.int8)
        maps = self._network.run({INPUT: padded(seen, self._network.zero(INPUT))})
        return np.concatenate([maps[HEAT][0], maps[EDGES][0]], axis=2).transpose(2, 0, 1)


def detailed(colour: ColourMap) -> Image:
    """What the net sees, uint8 (height, width, 3): `DETAIL` times the size of the working picture."""
    height, width = colour.picture.shape[:2]
    size = DETAIL * width, DETAIL * height
    if colour.detail.shape[1::-1] == size:
        return colour.detail
    return np.asarray(cv2.resize(colour.detail, size, interpolation=cv2.INTER_LINEAR), np.uint8)


def padded(values: NDArray[np.int8], fill: int) -> NDArray[np.int8]:
    """int8 (h, w, 3) -> (1, H, W, 3), the sides filled up to multiples of 32 on the right and below."""
    height, width = values.shape[:2]
    down, right = -height % MULTIPLE, -width % MULTIPLE
    if down or right:
        values = np.asarray(
            cv2.copyMakeBorder(values, 0, down, 0, right, cv2.BORDER_CONSTANT, value=(fill,) * 3), np.int8
        )
    return values[None]


def _maxima(plane: Float, least: float) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of cells above `least` that no neighbour exceeds, highest first."""
    highest = cv2.dilate(plane, _NEIGHBOURS)
    peaks = plane >= highest
    peaks &= plane > least
    rows, columns = np.nonzero(peaks)
    order = np.argsort(-plane[rows, columns], kind="stable")
    return rows[order], columns[order]


def boxes_at(maps: Float, rows: NDArray[np.intp], columns: NDArray[np.intp]) -> Float:
    """Boxes that the maps (PLANES, h, w) give for some cells: float32 (n, 4)."""
    edges = np.exp(np.minimum(np.maximum(maps[2:PLANES, rows, columns], -2.0), 6.0))
    boxes = np.empty((len(rows), 4), np.float32)
    boxes[:, 0] = (columns + 0.5) * STRIDE - edges[0]
    boxes[:, 1] = (rows + 0.5) * STRIDE - edges[1]
    boxes[:, 2:] = (edges[:2] + edges[2:]).T
    return boxes


def find_peaks(maps: Float, most: int = MOST_PEAKS, least_heat: float = LEAST_HEAT) -> Peaks:
    """Hands and face of the locator's maps, float32 (PLANES, h, w).

    most: peaks kept, at least 1. least_heat: of a peak, above 0 and below 1.
    """
    rows, columns = _maxima(maps[HAND], float(np.log(least_heat / (1.0 - least_heat))))
    rows, columns = rows[:MOST_MAXIMA], columns[:MOST_MAXIMA]
    boxes = boxes_at(maps, rows, columns)
    same = pairwise_iou(boxes, boxes) >= SAME_IOU
    kept = keep_distinct(same, range(len(boxes)), most)
    heat = logistic(maps[HAND, rows, columns])
    return Peaks(boxes[kept], heat[kept], _face(maps[FACE]))


def _face(plane: Float) -> tuple[float, float] | None:
    _, highest, _, (column, row) = cv2.minMaxLoc(plane)
    if highest < np.log(LEAST_FACE / (1.0 - LEAST_FACE)):
        return None
    return (column + 0.5) * STRIDE, (row + 0.5) * STRIDE
