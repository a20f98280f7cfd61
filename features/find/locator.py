"""Where hands are: a tiny int8 net over the whole standardised picture.

One stage, without anchors: heat at the middle of each hand (Zhou, Wang and Krähenbühl, "Objects as Points", 2019) and
the distances to the four edges of its box (Tian, Shen, Chen and He, "FCOS", 2019), on a grid of 4 working pixels. A
second plane of heat marks faces, which tell the axis of the body.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Network
from lightgesture.features.standardise import Float
from lightgesture.features.types import Image

MULTIPLE = 16
"""Height and width that the net sees are multiples of its coarsest grid; the rest is filled with the mean colour."""
INPUT, HEAT, EDGES = "picture", "heat", "edges"
"""Tensors of the net. Heat and edges are apart because one scale of eight bits would not fit both."""


class Locator:
    """Runs the net on working pictures of any size."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = Network(network)

    def process(self, picture: Image, tables: Float) -> Float:
        """Maps of a working picture, float32 (6, h, w) on cells of 4 pixels; see `features.peaks`.

        picture: uint8 (height, width, 3), BGR. tables: of `standardise.channel_tables`.
        """
        seen = np.asarray(cv2.LUT(picture, self._network.table(INPUT, tables)), np.int8)
        maps = self._network.run({INPUT: padded(seen, self._network.zero(INPUT))})
        return np.concatenate([maps[HEAT][0], maps[EDGES][0]], axis=2).transpose(2, 0, 1)


def padded(values: NDArray[np.int8], fill: int) -> NDArray[np.int8]:
    """int8 (h, w, 3) -> (1, H, W, 3), the sides filled up to multiples of 16 on the right and below."""
    height, width = values.shape[:2]
    down, right = -height % MULTIPLE, -width % MULTIPLE
    if down or right:
        values = np.asarray(
            cv2.copyMakeBorder(values, 0, down, 0, right, cv2.BORDER_CONSTANT, value=(fill,) * 3), np.int8
        )
    return values[None]
