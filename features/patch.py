"""The square patch round a hand that classifiers read: cut, mirrored and resized, the same in training and use."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.image import as_bgr8
from lightgesture.features.types import Box, Image

Square = tuple[int, int, int]
"""Left, upper edge and side in whole pixels of a picture; may reach out of it."""


@dataclass(frozen=True, slots=True)
class PatchSettings:
    """How a patch is cut."""

    size: int = 32
    """Side of the patch in pixels, 16 to 128; the cost of the features grows with its square."""
    context: float = 1.1
    """Side of the square over the longer side of the hand's box, 0.8 to 2. Smaller loses finger tips when a box is too
    small, larger gives the room behind the hand more say."""


def cut_patch(
    image: NDArray[np.uint8], box: Box, side: str, settings: PatchSettings | None = None
) -> NDArray[np.uint8]:
    """Patch round one hand, uint8 (size, size, 3), BGR, a right hand mirrored so that both sides obey one rule.

    image: uint8 (height, width, 3) BGR or (height, width) grey. box: outline of the hand, x, y, width, height
    in pixels; it may reach over the picture's edge, where the edge pixels are repeated. side: "left" or "right",
    the diver's own.
    Raises ValueError for another picture, a box without area or wholly outside the picture, and an unknown side.
    """
    return np.asarray(cut_patches(image, [box], [side], settings)[0], np.uint8)


def cut_patches(
    image: NDArray[np.uint8],
    boxes: Sequence[Box],
    sides: Sequence[str],
    settings: PatchSettings | None = None,
) -> NDArray[np.uint8]:
    """Patches of several hands of one picture, uint8 (n, size, size, 3); see `cut_patch`."""
    settings = settings or PatchSettings()
    if image.dtype != np.uint8:
        raise ValueError(f"picture has values of type {image.dtype}; convert it to 8 bit (uint8) first")
    picture = as_bgr8(image)
    _check(boxes, sides, (picture.shape[1], picture.shape[0]))
    size = settings.size
    squares = squares_round(boxes, settings.context)
    patches = np.empty((len(boxes), size, size, 3), np.uint8)
    for patch, square, side in zip(patches, cut_squares(picture, squares), sides, strict=True):
        shrink_square(square, patch)
        if side == "right":
            cv2.flip(patch, 1, patch)
    return patches


def shrink_square(square: Image, patch: Image) -> None:
    """A square, uint8 (side, side, 3), brought to the size of a patch, uint8 (size, size, 3), which is written to.

    Averaging areas keeps thin fingers when shrinking; it would make blocks of pixels when growing. A large square is
    sampled at twice the size first: averaging all its pixels takes three to four times as long, for nothing.
    """
    size = len(patch)
    if len(square) > 2 * size:
        square = cv2.resize(square, (2 * size, 2 * size), interpolation=cv2.INTER_LINEAR)  # type: ignore[assignment]
    method = cv2.INTER_AREA if len(square) >= size else cv2.INTER_LINEAR
    cv2.resize(square, (size, size), patch, interpolation=method)


def _check(boxes: Sequence[Box], sides: Sequence[str], picture: tuple[int, int]) -> None:
    """Refuse boxes and sides that are none of hands in a picture of (width, height). Raises ValueError."""
    if len(boxes) != len(sides):
        raise ValueError(f"{len(boxes)} boxes but {len(sides)} sides; give one side for each box")
    for (x, y, width, height), side in zip(boxes, sides, strict=True):
        if side not in ("left", "right"):
            raise ValueError(f'side is {side!r}; it must be "left" or "right"')
        if not (width > 0 and height > 0):
            raise ValueError(f"box {(x, y, width, height)} has no area; give x, y, width, height in pixels")
        if x >= picture[0] or y >= picture[1] or x + width <= 0 or y + height <= 0:
            raise ValueError(
                f"box {(x, y, width, height)} lies outside the picture of {picture[0]} × {picture[1]} pixels"
            )


def squares_round(
    boxes: NDArray[Any] | Sequence[Sequence[float]],
    context: float,
    least: float = 1.0,
    most: float = math.inf,
) -> list[Square]:
    """Squares about the middles of boxes, (n, 4), x, y, width, height: `context` times the longer side, but at least
    `least` and at most `most` pixels wide, rounded to whole ones, never below 1."""
    squares = []
    # A handful of boxes: the calls on arrays would take longer than the numbers.
    for x, y, width, height in boxes.tolist() if isinstance(boxes, np.ndarray) else boxes:
        side = max(round(min(max(context * max(width, height), least), most)), 1)
        squares.append((round(x + (width - side) / 2), round(y + (height - side) / 2), side))
    return squares


def cut_squares(picture: Image, squares: Sequence[Square]) -> list[Image]:
    """The squares of a picture, uint8 (side, side, 3) each; what lies outside repeats its edge."""
    height, width = picture.shape[:2]
    cuts = []
    for left, top, side in squares:
        x0, y0 = min(max(left, 0), width - 1), min(max(top, 0), height - 1)
        x1, y1 = max(min(left + side, width), x0 + 1), max(min(top + side, height), y0 + 1)
        cut = picture[y0:y1, x0:x1]
        margins = y0 - top, top + side - y1, x0 - left, left + side - x1
        if any(margins):
            # Of a square wholly beside the picture a margin is negative.
            above, below, before, after = (max(margin, 0) for margin in margins)
            cut = cv2.copyMakeBorder(cut, above, below, before, after, cv2.BORDER_REPLICATE)  # type: ignore[assignment]
        cuts.append(cut)
    return cuts
