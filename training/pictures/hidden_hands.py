"""Hands of which too little is seen to be read: cut by the picture's edge, or behind an arm, a face or a thing.

A net that has seen whole hands alone reads half a hand as the sign that its rest resembles: half a `5` as `2`. These
copies teach it to say `none`.
"""

from collections.abc import Sequence
from typing import Final

import cv2
import numpy as np

from lightgesture.features.types import Box, Float, Image

Random = np.random.Generator


CUT_SHARE: Final = 0.5
"""Of hands, those that the picture's edge cuts; the others are covered."""
LOST: Final = (0.35, 0.7)
"""Least and most of the box's extent that is lost."""
SKIN_SHARE: Final = 0.7
"""Of covers, those that are as the hand itself, as an arm or a face in the same light is; the others are pieces of
other pictures."""
COVER_RADIUS: Final = (0.6, 3.0)
"""Of a cover's rim over the box's longer side: the roundest and the flattest."""


def hide(image: Image, box: Box, others: Sequence[Image], random: Random) -> tuple[Image, Box]:
    """The picture without a part of its hand, and the box that a selector would give.

    others: pictures, at least a few pixels wide, of which covers are pieces.
    """
    lost = random.uniform(*LOST)
    if random.random() < CUT_SHARE:
        return _cut(image, box, lost, int(random.integers(4)))
    return _covered(image, box, others, lost, random), box


def _cut(image: Image, box: Box, lost: float, edge: int) -> tuple[Image, Box]:
    """The picture ends where it hides that share of the box; the new box goes round what is left.

    edge: 0 left, 1 top, 2 right, 3 bottom.
    """
    rows, columns = image.shape[:2]
    x, y, width, height = box
    left, top, right, bottom = 0, 0, columns, rows
    if edge == 0:
        left = round(x + lost * width)
    elif edge == 1:
        top = round(y + lost * height)
    elif edge == 2:
        right = round(x + (1.0 - lost) * width)
    else:
        bottom = round(y + (1.0 - lost) * height)
    left, top = min(max(left, 0), columns - 2), min(max(top, 0), rows - 2)
    right, bottom = max(min(right, columns), left + 2), max(min(bottom, rows), top + 2)
    seen_x, seen_y = max(x, left), max(y, top)
    seen = (
        seen_x - left,
        seen_y - top,
        max(2, min(x + width, right) - seen_x),
        max(2, min(y + height, bottom) - seen_y),
    )
    return np.ascontiguousarray(image[top:bottom, left:right]), seen


def _covered(image: Image, box: Box, others: Sequence[Image], lost: float, random: Random) -> Image:
    """A disc comes in from a random direction and hides that share of the box's extent along it."""
    rows, columns = image.shape[:2]
    x, y, width, height = box
    longer = max(width, height)
    radius = longer * np.exp(random.uniform(*np.log(COVER_RADIUS)))
    angle = random.uniform(0.0, 2.0 * np.pi)
    across, down = np.cos(angle), np.sin(angle)
    extent = abs(across) * width + abs(down) * height
    away = radius + (0.5 - lost) * extent
    centre_x, centre_y = x + width / 2 + across * away, y + height / 2 + down * away
    down_of, across_of = np.mgrid[:rows, :columns].astype(np.float32)
    distance = np.hypot(across_of + 0.5 - centre_x, down_of + 0.5 - centre_y)
    cover = np.clip(radius - distance, 0.0, 1.0)[..., None].astype(np.float32)
    if random.random() < SKIN_SHARE:
        shade = (1.0 - random.uniform(0.0, 0.5) * np.clip(distance / radius, 0.0, 1.0) ** 4)[..., None]
        front = shade * _skin(image, box, random)
    else:
        front = _piece(others[int(random.integers(len(others)))], (columns, rows), random)
    covered = image + cover * (front - image)
    return np.asarray(np.clip(np.rint(covered), 0, 255), np.uint8)


def _skin(image: Image, box: Box, random: Random) -> Float:
    """The middle of the hand, enlarged to the whole picture and without detail, a little lighter or darker."""
    rows, columns = image.shape[:2]
    x, y, width, height = box
    left, top = min(max(x + width // 3, 0), columns - 2), min(max(y + height // 3, 0), rows - 2)
    middle = image[top : max(top + 2, y + height - height // 3), left : max(left + 2, x + width - width // 3)]
    coarse = cv2.resize(middle, (2, 2), interpolation=cv2.INTER_AREA)
    smooth = cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_LINEAR)
    return np.asarray(smooth, np.float32) * np.float32(np.exp(random.normal(0.0, 0.15)))


def _piece(picture: Image, size: tuple[int, int], random: Random) -> Float:
    """A random part of a picture, enlarged or reduced to `size` (columns, rows)."""
    rows, columns = picture.shape[:2]
    side = max(2, int(min(rows, columns) * random.uniform(0.2, 0.8)))
    top, left = random.integers(rows - side + 1), random.integers(columns - side + 1)
    part = cv2.resize(picture[top : top + side, left : left + side], size, interpolation=cv2.INTER_AREA)
    return np.asarray(part, np.float32)
