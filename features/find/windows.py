"""Windows round places of a frame, as the nets see them that look at one place at a time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.patch import Square, cut_squares, squares_round
from lightgesture.features.types import Float, Image

LEAST_WINDOW: Final = 0.125
"""Least side of a window over its size."""
LARGEST_WINDOW: Final = 2.0
"""Largest side of a window over the longer side of the picture."""


@dataclass(frozen=True, slots=True)
class WindowSettings:
    """How a window is cut."""

    size: int
    """Pixels along each side of what the net sees, 16 to 128; its time grows with the square."""
    context: float
    """Side of the window over the longer side of the box, 1 to 4. Larger shows what is round a hand, smaller its
    fingers more clearly."""


def windows_round(boxes: NDArray[Any], picture: Image, settings: WindowSettings) -> list[Square]:
    """The windows of boxes, (n, 4), x, y, width, height in pixels of the picture."""
    least, largest = LEAST_WINDOW * settings.size, LARGEST_WINDOW * max(picture.shape[:2])
    return squares_round(boxes, settings.context, least, largest)


def cut_windows(picture: Image, windows: Sequence[Square], size: int) -> NDArray[np.uint8]:
    """uint8 (n, size, size, 3): windows of a picture; what lies outside it continues its edge."""
    seen = np.empty((len(windows), size, size, 3), np.uint8)
    for place, cut, (_, _, side) in zip(seen, cut_squares(picture, windows), windows, strict=True):
        # Interpolation alone would alias where the window shrinks.
        how = cv2.INTER_AREA if side > size else cv2.INTER_LINEAR
        cv2.resize(cut, (size, size), place, interpolation=how)
    return seen


def windows_in(
    colour: ColourMap, boxes: Float, settings: WindowSettings
) -> tuple[NDArray[np.uint8], list[Square], float]:
    """What is round places of a frame, at its finest detail.

    boxes: float32 (n, 4), one or more, working pixels. Returns uint8 (n, size, size, 3), the windows in pixels of the
    detail, and how many of these lie along a working pixel.
    """
    scale = colour.detail.shape[1] / colour.picture.shape[1]
    windows = windows_round(boxes * np.float32(scale), colour.detail, settings)
    return cut_windows(colour.detail, windows, settings.size), windows, scale
