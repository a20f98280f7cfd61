"""Square windows round boxes, reduced to the few pixels at which the refiner looks at a hand."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

Window = tuple[int, int, int]
"""Left, top and side in whole pixels; may reach out of the picture."""


@dataclass(frozen=True, slots=True)
class WindowSettings:
    """size: pixels along each side of a window. context: side of the window over the longer side of the box, 1 to 2.
    least_side, largest_side: of a window, over its size and over the longer side of the picture.
    """

    size: int = 32
    context: float = 1.5
    least_side: float = 0.125
    largest_side: float = 2.0


def window_of(box: NDArray[np.floating], picture: Image, settings: WindowSettings) -> Window:
    """The window of a box (x, y, width, height), in pixels of the picture, rounded to whole ones."""
    x, y, width, height = (float(value) for value in box)
    longest = settings.largest_side * max(picture.shape[:2])
    side = round(
        min(max(settings.context * max(width, height), settings.least_side * settings.size), longest)
    )
    side = max(side, 1)
    return round(x + (width - side) / 2), round(y + (height - side) / 2), side


def cut_window(picture: Image, window: Window, size: int) -> Image:
    """uint8 (size, size, 3): a window; what lies outside the picture continues its edge."""
    left, top, side = window
    height, width = picture.shape[:2]
    x0, y0 = min(max(left, 0), width - 1), min(max(top, 0), height - 1)
    x1, y1 = max(min(left + side, width), x0 + 1), max(min(top + side, height), y0 + 1)
    part = picture[y0:y1, x0:x1]
    margins = y0 - top, top + side - y1, x0 - left, left + side - x1
    if any(margins):
        above, below, before, after = (max(margin, 0) for margin in margins)
        part = cv2.copyMakeBorder(part, above, below, before, after, cv2.BORDER_REPLICATE)  # type: ignore[assignment]
    # Interpolation alone would alias where the window shrinks.
    how = cv2.INTER_AREA if side > size else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(part, (size, size), interpolation=how), np.uint8)
