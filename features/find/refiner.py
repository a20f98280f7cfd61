"""Hand or not, and how far it reaches: a second look at each place through a tiny int8 net on a window of 32 × 32.

The locator sees a person at 160 × 120 pixels; a window shows one place at the resolution of the camera. A box of a
track, moved on by its filter, can be looked at just as well, so a followed hand costs no search.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Network
from lightgesture.features.patch import Square, cut_squares, squares_round
from lightgesture.features.standardise import luma_tables
from lightgesture.features.types import Float, Image

INPUT, HAND, BOX = "windows", "hand", "box"
"""Tensors of the net: the logit of a hand; left, upper, right and lower edge of its box, from the window's centre in
window sides."""
LEAST_SIDE: Final = 2.0
"""Pixels; no box is smaller."""
SIZE: Final = 32
"""Pixels along each side of a window."""
CONTEXT: Final = 1.5
"""Side of the window over the longer side of the box."""
LEAST_WINDOW: Final = 0.125
"""Least side of a window over its size."""
LARGEST_WINDOW: Final = 2.0
"""Largest side of a window over the longer side of the picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """What the refiner says of n windows.

    boxes: float32 (n, 4), x, y, width, height in working pixels. hand: float32 (n,), logit of being a hand.
    """

    boxes: Float
    hand: Float


class Refiner:
    """Runs the net on the windows of a frame."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = Network(network)

    def process(self, colour: ColourMap, boxes: Float, tables: Float) -> Refined:
        """Look at the places of `boxes`, float32 (n, 4), working pixels.

        tables: of `standardise.channel_tables` over the working picture.
        """
        if not len(boxes):
            return Refined(np.zeros((0, 4), np.float32), np.zeros(0, np.float32))
        scale = np.float32(colour.detail.shape[1] / colour.picture.shape[1])
        windows = windows_round(boxes * scale, colour.detail)
        cuts = cut_windows(colour.detail, windows)
        seen = np.empty((len(windows), SIZE, SIZE, 4), np.int8)
        colours = cv2.LUT(cuts.reshape(-1, SIZE, 3), self._network.table(INPUT, tables))
        seen[..., :3] = colours.reshape(cuts.shape)
        lumas, luma_values = luma_tables(cuts)
        for window, luma, levels in zip(seen, lumas, self._network.table(INPUT, luma_values), strict=True):
            window[..., 3] = cv2.LUT(luma, levels)
        outputs = self._network.run({INPUT: seen})
        edges = outputs[BOX].reshape(len(boxes), 4)
        places = np.array(windows, np.float32)
        sides = places[:, 2:]
        centres = places[:, :2] + sides / 2
        low, high = centres + edges[:, :2] * sides, centres + edges[:, 2:] * sides
        found = np.hstack([low, np.maximum(high - low, LEAST_SIDE)]) / scale
        return Refined(np.asarray(found, np.float32), outputs[HAND].reshape(len(boxes)))


def windows_round(boxes: NDArray[Any], picture: Image) -> list[Square]:
    """The windows of boxes, (n, 4), x, y, width, height in pixels of the picture."""
    return squares_round(boxes, CONTEXT, LEAST_WINDOW * SIZE, LARGEST_WINDOW * max(picture.shape[:2]))


def cut_windows(picture: Image, windows: Sequence[Square], size: int = SIZE) -> NDArray[np.uint8]:
    """uint8 (n, size, size, 3): windows of a picture; what lies outside it continues its edge."""
    seen = np.empty((len(windows), size, size, 3), np.uint8)
    for place, cut, (_, _, side) in zip(seen, cut_squares(picture, windows), windows, strict=True):
        # Interpolation alone would alias where the window shrinks.
        how = cv2.INTER_AREA if side > size else cv2.INTER_LINEAR
        cv2.resize(cut, (size, size), place, interpolation=how)
    return seen
