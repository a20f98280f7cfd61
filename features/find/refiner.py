"""Hand or not, and how far it reaches: a second look at each place through a tiny int8 net on a window of 32 × 32.

The locator sees a person at 320 × 240 pixels and on a grid of eight; a window shows one place as it is. A box of a
track, moved on by its filter, can be looked at just as well, so a followed hand costs no search.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import WORKING_PIXELS, ColourMap
from lightgesture.features.find.windows import (
    LARGEST_WINDOW,
    LEAST_WINDOW,
    WindowSettings,
    windows_in,
)
from lightgesture.features.net.network import IntegerNetwork, Quantisation
from lightgesture.features.net.runner import Levels, Network
from lightgesture.features.patch import Square, cut_squares, shrink_square, squares_round
from lightgesture.features.standardise import (
    as_levels,
    channel_tables,
    level_tables,
    luma_tables,
    scales_of,
    square_roots,
)
from lightgesture.features.types import Float, Image

INPUT, HAND, BOX = "windows", "hand", "box"
"""Tensors of the net: the logit of a hand; left, upper, right and lower edge of its box, from the window's centre in
window sides."""
LEAST_SIDE: Final = 2.0
"""Pixels; no box is smaller."""
WINDOW: Final = WindowSettings(size=32, context=1.5)
SAMPLE: Final = (80, 60)
"""Width and height of what stands for a whole frame where only its mean colours are asked for."""

Rectangle = tuple[float, float, float, float]
"""x, y, width, height."""


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

    def table(self, picture: Image) -> Levels:
        """int8 (1, 256, 3): the integer that stands for each value of each channel of a picture."""
        return self._network.table(INPUT, channel_tables(picture))

    def process(self, colour: ColourMap, boxes: Float, tables: Levels) -> Refined:
        """Look at the places of `boxes`, float32 (n, 4), working pixels.

        tables: `table` of the working picture.
        """
        if not len(boxes):
            return Refined(np.zeros((0, 4), np.float32), np.zeros(0, np.float32))
        cuts, windows, scale = windows_in(colour, boxes, WINDOW)
        lumas, luma_values = luma_tables(cuts)
        levels = [
            cv2.LUT(luma, table)
            for luma, table in zip(lumas, self._network.table(INPUT, luma_values), strict=True)
        ]
        found, hand = self._run(_with_luma(cuts, tables, np.concatenate(levels)), windows)
        return Refined(np.array(found, np.float32) / np.float32(scale), np.array(hand, np.float32))

    def look(self, image: Image, boxes: Sequence[Sequence[float]]) -> tuple[list[Rectangle], list[float]]:
        """Look at boxes of a whole frame, one or more, source pixels: the refined boxes and the logit of each.

        No working picture is needed: windows are cut from the frame itself, and its colours are told from a sample.
        """
        height, width = image.shape[:2]
        sample = image
        if width * height > SAMPLE[0] * SAMPLE[1]:
            sample = np.asarray(cv2.resize(image, SAMPLE, interpolation=cv2.INTER_LINEAR), np.uint8)
        # As small as a window of the working picture's detail may be, which has about so many pixels.
        size = WINDOW.size
        least = LEAST_WINDOW * size * max((width * height / (4 * WORKING_PIXELS)) ** 0.5, 1.0)
        windows = squares_round(boxes, WINDOW.context, least, LARGEST_WINDOW * max(width, height))
        cuts = np.empty((len(windows), size, size, 3), np.uint8)
        for cut, square in zip(cuts, cut_squares(image, windows), strict=True):
            shrink_square(square, cut)
        quantisation = self._network.quantisation(INPUT)
        tables = level_tables(sample, quantisation)
        return self._run(_with_luma(cuts, tables, _luma_levels(cuts, quantisation)), windows)

    def _run(self, seen: Levels, windows: Sequence[Square]) -> tuple[list[Rectangle], list[float]]:
        """Refined boxes in the pixels of the windows, and logits, of what n windows show, int8 (n, size, size, 4)."""
        outputs = self._network.run({INPUT: seen})
        found = []
        for (left, top, side), (x0, y0, x1, y1) in zip(
            windows, outputs[BOX].reshape(len(windows), 4).tolist(), strict=True
        ):
            x, y = left + (0.5 + x0) * side, top + (0.5 + y0) * side
            found.append((x, y, max((x1 - x0) * side, LEAST_SIDE), max((y1 - y0) * side, LEAST_SIDE)))
        return found, outputs[HAND].ravel().tolist()


def _luma_levels(cuts: NDArray[np.uint8], quantisation: Quantisation) -> Levels:
    """int8 (n * size, size): the luma of each of n windows, standardised by itself; see `luma_tables`."""
    size = cuts.shape[2]
    luma = np.asarray(cv2.cvtColor(cuts.reshape(-1, size, 3), cv2.COLOR_BGR2GRAY), np.uint8)
    roots = square_roots(luma)
    levels = np.empty(luma.shape, np.int8)
    for first in range(0, len(luma), size):
        own = slice(first, first + size)
        ((factor, offset),) = scales_of(luma[own], roots[own], quantisation)
        levels[own] = as_levels(roots[own], quantisation, factor, offset)
    return levels


def _with_luma(cuts: NDArray[np.uint8], tables: Levels, luma: Levels) -> Levels:
    """int8 (n, size, size, 4): blue, green and red of windows by the tables of their frame, and luma as it is."""
    # Several times as fast as laying channels side by side with NumPy.
    seen = cv2.merge([cv2.LUT(cuts.reshape(-1, cuts.shape[2], 3), tables), luma])
    return np.asarray(seen, np.int8).reshape(*cuts.shape[:3], 4)
