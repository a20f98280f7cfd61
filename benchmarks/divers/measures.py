"""Numbers of a hand in its picture: how large it is and how far it stands out from what is around it."""

import cv2
import numpy as np

from lightgesture.features.types import Box, Image

REFERENCE_WIDTH = 640
"""Pixels: sizes are told for pictures of this width."""

CORE = 0.55
"""Side of the middle of a box that is surely hand, as a share of the box's side."""

RING = 1.6
"""Side of the region around a box, likewise; what of it is outside the box is taken as background."""


def size_at_reference(box: Box, width: int) -> float:
    """Side, pixels of a picture `REFERENCE_WIDTH` wide, of the square as large as a box in a picture `width` wide."""
    return float(np.sqrt(box[2] * box[3]) * REFERENCE_WIDTH / width)


def contrast(image: Image, box: Box) -> float:
    """Distance of the mean colours of a box's middle and of what is around it: CIE76 in Lab, 0 to about 100.

    About 2 is just seen, beside each other. image: BGR. A box that the picture's edge leaves no middle or surroundings
    of has 0.
    """
    outer = _cut(image, box, RING)
    if outer is None:
        return 0.0
    patch, (left, top) = outer
    lab = cv2.cvtColor(patch.astype(np.float32) / 255.0, cv2.COLOR_BGR2Lab)
    around = np.ones(lab.shape[:2], bool)
    core = np.zeros(lab.shape[:2], bool)
    for mask, share, value in ((around, 1.0, False), (core, CORE, True)):
        x0, y0, x1, y1 = _corners(box, share)
        mask[max(0, y0 - top) : max(0, y1 - top), max(0, x0 - left) : max(0, x1 - left)] = value
    if not core.any() or not around.any():
        return 0.0
    return float(np.linalg.norm(lab[core].mean(axis=0) - lab[around].mean(axis=0)))


def _corners(box: Box, share: float) -> tuple[int, int, int, int]:
    x, y, width, height = box
    grow_x, grow_y = (share - 1.0) * width / 2, (share - 1.0) * height / 2
    return round(x - grow_x), round(y - grow_y), round(x + width + grow_x), round(y + height + grow_y)


def _cut(image: Image, box: Box, share: float) -> tuple[Image, tuple[int, int]] | None:
    x0, y0, x1, y1 = _corners(box, share)
    left, top = max(0, x0), max(0, y0)
    patch = image[top : max(top, y1), left : max(left, x1)]
    return (patch, (left, top)) if patch.size else None
