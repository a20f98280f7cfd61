"""The square patch round a hand that classifiers read: cut, mirrored and resized, the same in training and use."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image


@dataclass(frozen=True, slots=True)
class PatchSettings:
    """How a patch is cut.

    size: side of the patch in pixels, 16 to 128; the cost of the features grows with its square.
    context: side of the square over the longer side of the hand's box, 0.8 to 2. Smaller loses finger tips
        when a box is too small, larger gives the room behind the hand more say.
    """

    size: int = 32
    context: float = 1.1


def as_bgr(image: NDArray[Any]) -> Image:
    """The picture as uint8 (height, width, 3): a grey one, (h, w) or (h, w, 1), gets three equal channels.

    Raises ValueError for any other shape, another depth than 8 bit, or no pixels.
    """
    if image.dtype != np.uint8:
        raise ValueError(f"picture has values of type {image.dtype}; convert it to 8 bit (uint8) first")
    if image.ndim == 2:
        image = image[:, :, None]
    if image.ndim != 3 or image.shape[2] not in (1, 3) or 0 in image.shape:
        raise ValueError(
            f"picture has shape {image.shape}; it must be (height, width, 3) BGR or (height, width) grey"
        )
    return np.repeat(image, 3, axis=2) if image.shape[2] == 1 else image


def cut_patch(
    image: NDArray[np.uint8], box: Box, side: str, settings: PatchSettings | None = None
) -> NDArray[np.uint8]:
    """Patch round one hand, uint8 (size, size, 3), BGR, a right hand mirrored so that both sides obey one rule.

    image: uint8 (height, width, 3) BGR or (height, width) grey. box: outline of the hand, x, y, width, height
    in pixels; it may reach over the picture's edge, where the edge pixels are repeated. side: "left" or "right",
    the diver's own.
    Raises ValueError for a box without area or wholly outside the picture, and for an unknown side.
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
    if len(boxes) != len(sides):
        raise ValueError(f"{len(boxes)} boxes but {len(sides)} sides; give one side for each box")
    picture = as_bgr(image)
    patches = np.empty((len(boxes), settings.size, settings.size, 3), np.uint8)
    for patch, box, side in zip(patches, boxes, sides, strict=True):
        if side not in ("left", "right"):
            raise ValueError(f'side is {side!r}; it must be "left" or "right"')
        _resize(_cut_square(picture, box, settings.context), patch)
        if side == "right":
            cv2.flip(patch, 1, patch)
    return patches


def _resize(square: Image, patch: Image) -> None:
    """Write the square picture into the patch, at its size.

    Averaging areas keeps thin fingers when shrinking; it would make blocks of pixels when growing. A large hand
    is sampled at twice the size first: averaging all its pixels takes three to four times as long and reads no better.
    """
    size = len(patch)
    if square.shape[0] > 2 * size:
        square = np.asarray(
            cv2.resize(square, (2 * size, 2 * size), interpolation=cv2.INTER_LINEAR), np.uint8
        )
    method = cv2.INTER_AREA if square.shape[0] >= size else cv2.INTER_LINEAR
    cv2.resize(square, (size, size), patch, interpolation=method)


def _cut_square(image: Image, box: Box, context: float) -> Image:
    """The square of `context` times the longer side of `box` about its centre, edge pixels repeated outside."""
    x, y, width, height = box
    rows, columns = image.shape[:2]
    if not (width > 0 and height > 0):
        raise ValueError(f"box {tuple(box)} has no area; give x, y, width, height in pixels")
    if x >= columns or y >= rows or x + width <= 0 or y + height <= 0:
        raise ValueError(f"box {tuple(box)} lies outside the picture of {columns} × {rows} pixels")
    side = max(1, round(context * max(width, height)))
    left, top = round(x + (width - side) / 2), round(y + (height - side) / 2)
    inside = image[max(top, 0) : max(top + side, 0), max(left, 0) : max(left + side, 0)]
    before = max(-top, 0), max(-left, 0)
    after = max(top + side - rows, 0), max(left + side - columns, 0)
    if any(before) or any(after):
        padded = cv2.copyMakeBorder(inside, before[0], after[0], before[1], after[1], cv2.BORDER_REPLICATE)
        return np.asarray(padded, np.uint8)
    return inside
