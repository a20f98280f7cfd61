"""Hand or not, and how far it reaches: a second look at each place through a tiny int8 net on a window of 32 × 32.

The locator sees a person at 160 × 120 pixels; a window shows one place at the resolution of the camera. A box of a
track, moved on by its filter, can be looked at just as well, so a followed hand costs no search.
"""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.features.find.choice import Refined
from lightgesture.features.find.windows import Window, WindowSettings, cut_window, window_of
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Network
from lightgesture.features.standardise import Float, luma_table
from lightgesture.features.types import Image

INPUT, HAND, BOX = "windows", "hand", "box"
"""Tensors of the net: the logit of a hand; left, upper, right and lower edge of its box, from the window's centre in
window sides."""
LEAST_SIDE = 2.0
"""Pixels; no box is smaller."""


class Refiner:
    """Runs the net on the windows of a frame."""

    def __init__(self, network: IntegerNetwork, settings: WindowSettings | None = None) -> None:
        self._network = Network(network)
        self._settings = settings or WindowSettings()

    def process(self, picture: Image, scale: float, boxes: Float, tables: Float) -> Refined:
        """Look at the places of `boxes`, float (n, 4), working pixels.

        picture: uint8 BGR, from which the windows are cut. scale: its pixels for one working pixel. tables: of
        `standardise.channel_tables` over the working picture.
        """
        if not len(boxes):
            return Refined(np.zeros((0, 4), np.float32), np.zeros(0, np.float32))
        size = self._settings.size
        windows = [window_of(box, picture, self._settings) for box in boxes * np.float32(scale)]
        colours = self._network.table(INPUT, tables)
        seen = np.empty((len(windows), size, size, 4), np.int8)
        for place, window in enumerate(windows):
            cut = cut_window(picture, window, size)
            seen[place, :, :, :3] = cv2.LUT(cut, colours)
            luma, table = luma_table(cut)
            seen[place, :, :, 3] = cv2.LUT(luma, self._network.table(INPUT, table))
        outputs = self._network.run({INPUT: seen})
        edges = outputs[BOX].reshape(len(boxes), 4)
        return Refined(boxes_of(edges, windows) / np.float32(scale), outputs[HAND].reshape(len(boxes)))


def boxes_of(edges: Float, windows: Sequence[Window]) -> Float:
    """The refiner's boxes, float32 (n, 4), in the pixels of the windows that it saw."""
    places = np.array(windows, np.float32)
    sides = places[:, 2:]
    centres = places[:, :2] + sides / 2
    low, high = centres + edges[:, :2] * sides, centres + edges[:, 2:] * sides
    return np.concatenate([low, np.maximum(high - low, LEAST_SIDE)], axis=1).astype(np.float32)
