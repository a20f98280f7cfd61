"""Frames of any camera as 8-bit BGR, the one form that the stages read."""

from collections.abc import Callable
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

DEPTHS: Final = (8, 10, 12, 14, 16)
"""Bits of a channel that cameras fill of the 16 that a picture has for it."""


def as_bgr8(image: NDArray[Any], bits: int = 16) -> Image:
    """The frame as uint8 (height, width, 3), BGR; one that is so already is returned as it is, not copied.

    image: uint8 or uint16, (height, width) or (height, width, 1) for grey, (height, width, 3) for BGR or
        (height, width, 4) for BGRA, whose alpha is dropped. bits: of `DEPTHS`, what the values of a uint16 frame fill:
        their upper 8 are kept, and no value may exceed them. A source of such frames has one `BitDepth`.
    Raises ValueError, one line, for another type of number or another shape, one without a pixel included.
    """
    check_frame(image)
    eight = image if image.dtype == np.uint8 else (image >> (bits - 8)).astype(np.uint8)
    if image.ndim == 2 or image.shape[2] == 1:
        eight = cv2.cvtColor(eight.reshape(image.shape[:2]), cv2.COLOR_GRAY2BGR)
    elif image.shape[2] == 4:
        eight = cv2.cvtColor(eight, cv2.COLOR_BGRA2BGR)
    return np.asarray(eight, np.uint8)


def turned(image: NDArray[Any], degrees: int) -> NDArray[Any]:
    """The frame turned clockwise by 0, 90, 180 or 270 degrees; by 0 it is returned as it is, not copied."""
    quarters = degrees // 90 % 4
    return np.ascontiguousarray(np.rot90(image, -quarters)) if quarters else image


class BitDepth:
    """The bits that the 16-bit frames of one source fill, decided once, so that its brightness never jumps.

    bits: what the source declares; None to take them from the first frame: the least of `DEPTHS` that hold its
    brightest value. A later frame that exceeds them raises them from there on; `report` is told so, in words.
    """

    def __init__(self, report: Callable[[str], None], bits: int | None = None) -> None:
        self._report, self._bits = report, bits

    def declare(self, brightest: int) -> None:
        """Take the largest value that the source says it may have, unless the bits are decided already."""
        self._bits = self._bits or bits_for(brightest)

    def bgr8(self, image: NDArray[Any]) -> Image:
        """The next frame of the source, as `as_bgr8` has it."""
        check_frame(image)
        if image.dtype == np.uint8:
            return as_bgr8(image)
        needed = bits_for(int(image.max()))
        if self._bits is not None and needed > self._bits:
            self._report(
                f"a picture is brighter than {self._bits} bits can be; read with {needed} bits from here on"
            )
        self._bits = max(needed, self._bits or 0)
        return as_bgr8(image, self._bits)


def bits_for(brightest: int) -> int:
    """The least of `DEPTHS` that hold a value, 0 to 65,535."""
    return next(bits for bits in DEPTHS if brightest < 1 << bits)


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
