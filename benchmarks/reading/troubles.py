"""What happens to hands in life, made from whole ones: badly boxed, cut by the picture's edge, half hidden.

Pure functions of a picture and the hand's box in its pixels.
"""

from collections.abc import Iterator
from typing import Literal, get_args

import numpy as np

from lightgesture.benchmarks.contact_sheet import Image
from lightgesture.features.types import Box

Edge = Literal["left", "top", "right", "bottom"]
EDGES: tuple[Edge, ...] = get_args(Edge)
DIRECTIONS = {"left": (-1, 0), "top": (0, -1), "right": (1, 0), "bottom": (0, 1)}


def shifted_boxes(box: Box, share: float) -> list[Box]:
    """The box moved by a share of its own width or height: left, up, right and down."""
    x, y, width, height = box
    return [
        (round(x + share * width * across), round(y + share * height * down), width, height)
        for across, down in DIRECTIONS.values()
    ]


def scaled_box(box: Box, factor: float) -> Box:
    """The box with both sides times `factor` about its middle."""
    x, y, width, height = box
    wide, high = max(1, round(width * factor)), max(1, round(height * factor))
    return round(x + (width - wide) / 2), round(y + (height - high) / 2), wide, high


def cut_by_edge(image: Image, box: Box, edge: Edge, share: float) -> tuple[Image, Box]:
    """The picture moved so that `share` of the hand's box lies beyond its edge, and the box of what is left to see."""
    rows, columns = image.shape[:2]
    x, y, width, height = box
    low_x, low_y, high_x, high_y = 0, 0, columns, rows
    if edge == "left":
        low_x = round(x + share * width)
    elif edge == "right":
        high_x = round(x + (1.0 - share) * width)
    elif edge == "top":
        low_y = round(y + share * height)
    else:
        high_y = round(y + (1.0 - share) * height)
    low_x, low_y = min(max(low_x, 0), columns - 1), min(max(low_y, 0), rows - 1)
    high_x, high_y = max(min(high_x, columns), low_x + 1), max(min(high_y, rows), low_y + 1)
    left, top = max(x, low_x), max(y, low_y)
    right, bottom = max(min(x + width, high_x), left + 1), max(min(y + height, high_y), top + 1)
    seen = left - low_x, top - low_y, right - left, bottom - top
    return image[low_y:high_y, low_x:high_x], seen


def half_covered(image: Image, box: Box, edge: Edge) -> Image:
    """The picture with a disc of the hand's own colour before one half of the hand, as a face or the other arm.

    The disc's rim goes through the middle of the box; its radius is the box's longer side, its colour the median of the
    middle third of the box, darker towards the rim as a ball in front light is.
    """
    rows, columns = image.shape[:2]
    x, y, width, height = box
    radius = float(max(width, height))
    across, down = DIRECTIONS[edge]
    centre_x, centre_y = x + width / 2 + across * radius, y + height / 2 + down * radius
    down_of, across_of = np.mgrid[:rows, :columns]
    distance = np.hypot(across_of + 0.5 - centre_x, down_of + 0.5 - centre_y) / radius
    shade = 1.0 - 0.35 * np.clip(distance, 0.0, 1.0) ** 4
    cover = np.clip((1.0 - distance) * radius, 0.0, 1.0)[..., None]
    covered = image + cover * (shade[..., None] * _middle_colour(image, box) - image)
    return np.asarray(np.clip(np.rint(covered), 0, 255), np.uint8)


def _middle_colour(image: Image, box: Box) -> np.ndarray:
    """Median colour of the middle third of a box, (3,)."""
    rows, columns = image.shape[:2]
    x, y, width, height = box
    left, top = min(max(x + width // 3, 0), columns - 1), min(max(y + height // 3, 0), rows - 1)
    part = image[top : max(y + height - height // 3, top + 1), left : max(x + width - width // 3, left + 1)]
    return np.asarray(np.median(part.reshape(-1, 3), axis=0))


def random_boxes(
    size: tuple[int, int], count: int, share: tuple[float, float], random: np.random.Generator
) -> Iterator[Box]:
    """Boxes that lie in a picture of `size` (height, width), wide or tall by up to a factor of 1.5.

    share: least and largest longer side over the picture's shorter side.
    """
    rows, columns = size
    for _ in range(count):
        longer = min(rows, columns) * random.uniform(*share)
        shorter = longer / random.uniform(1.0, 1.5)
        width, height = (longer, shorter) if random.random() < 0.5 else (shorter, longer)
        wide, high = max(2, round(width)), max(2, round(height))
        left, top = random.integers(max(columns - wide, 0) + 1), random.integers(max(rows - high, 0) + 1)
        yield int(left), int(top), wide, high
