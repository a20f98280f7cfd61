"""Frames of any camera as 8-bit BGR, the one form that the stages read."""

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

SIXTEEN_TO_EIGHT = 257
"""65,535 / 255: full scale stays full scale."""


def as_bgr8(image: NDArray[Any]) -> Image:
    """The frame as uint8 (height, width, 3), BGR; one that is so already is returned as it is, not copied.

    image: uint8 or uint16, (height, width) or (height, width, 1) for grey, (height, width, 3) for BGR or
        (height, width, 4) for BGRA, whose alpha is dropped. 16 bits are taken to use their whole range.
    Raises ValueError, one line, for another type of number or another shape, one without a pixel included.
    """
    check_frame(image)
    eight = image if image.dtype == np.uint8 else cv2.convertScaleAbs(image, alpha=1 / SIXTEEN_TO_EIGHT)
    if image.ndim == 2 or image.shape[2] == 1:
        eight = cv2.cvtColor(eight.reshape(image.shape[:2]), cv2.COLOR_GRAY2BGR)
    elif image.shape[2] == 4:
        eight = cv2.cvtColor(eight, cv2.COLOR_BGRA2BGR)
    return np.asarray(eight, np.uint8)


def check_frame(image: NDArray[Any]) -> None:
    """Raise the ValueError of `as_bgr8` for an array that is no frame; costs nothing."""
    if not isinstance(image, np.ndarray) or image.dtype not in (np.uint8, np.uint16):
        raise ValueError(f"frame of {_describe(image)}: pixels must be uint8 or uint16; convert it first")
    is_picture = image.ndim == 2 or (image.ndim == 3 and image.shape[2] in (1, 3, 4))
    if not is_picture or 0 in image.shape:
        raise ValueError(
            f"frame of {_describe(image)}: the shape must be (height, width), or with 1, 3 (BGR) or 4 (BGRA) "
            "channels, and hold a pixel; convert it first"
        )


def _describe(image: object) -> str:
    if isinstance(image, np.ndarray):
        return f"{image.dtype} {image.shape}"
    return f"type {type(image).__name__}"
