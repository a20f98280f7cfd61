"""Frame -> working picture and skin map.

Water takes red first, so a hand under water has the water's own hue, and a fixed skin range finds
about a tenth of it. Giving the red channel back and then balancing the channels to grey brings skin
out again as the reddest thing in view.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import cv2

from lightgesture.features.profile import ColourProfile
from lightgesture.features.skin_map import skin_map
from lightgesture.features.types import Image

WORKING_PIXELS: Final = 160 * 120
"""Area of the working picture in pixels; a larger one finds no more hands and costs in proportion."""
LONGEST_SIDE: Final = 1024
"""Pixels of the working picture: of a frame of 1 × 100,000, which no camera gives, less is looked at."""


@dataclass(frozen=True, eq=False)
class ColourMap:
    """A frame made ready for the search.

    picture: uint8 (h, w, 3), BGR, reduced to about the working area.
    detail: uint8 (h', w', 3), BGR, about twice as wide and high, from which a region is cut for a closer look.
    scale: (x, y) source pixels for one pixel of `picture`.
    source_size: (width, height) of the source frame, pixels.
    skin_of: makes the skin map of a working picture.
    """

    picture: Image
    detail: Image
    scale: tuple[float, float]
    source_size: tuple[int, int]
    skin_of: Callable[[Image], Image]

    @cached_property
    def skin(self) -> Image:
        """uint8 (h, w), 0 least to 255 most skin-like; made when it is first asked for."""
        return self.skin_of(self.picture)


def reduce_picture(image: Image, pixels: int) -> tuple[Image, Image]:
    """`image` reduced to about `pixels` pixels, aspect kept, and the step before; a smaller one is returned as it is.

    Two steps, the first to twice the size by plain sampling: one area-averaging step from full size
    costs four times as much and the difference does not show in the map.
    """
    height, width = image.shape[:2]
    ratio = (pixels / (height * width)) ** 0.5
    if ratio >= 1.0 and max(height, width) <= LONGEST_SIDE:
        return image, image
    ratio = min(ratio, 1.0)
    target = (
        min(max(round(width * ratio), 1), LONGEST_SIDE),
        min(max(round(height * ratio), 1), LONGEST_SIDE),
    )
    if ratio < 0.5 or max(height, width) > 2 * LONGEST_SIDE:
        image = cv2.resize(image, (2 * target[0], 2 * target[1]), interpolation=cv2.INTER_LINEAR)  # type: ignore[assignment]
    return cv2.resize(image, target, interpolation=cv2.INTER_AREA), image  # type: ignore[return-value]


class ColourStage:
    """Frame -> colour map.

    profile: the colours of this diver's hands; None for the default map, on which any skin is bright.
    """

    def __init__(self, profile: ColourProfile | None = None) -> None:
        self._skin_of = skin_map if profile is None else profile.map

    def process(self, image: Image) -> ColourMap:
        """Make the colour map of one frame, uint8 (height, width, 3), BGR, of any size from 1 × 1."""
        picture, detail = reduce_picture(image, WORKING_PIXELS)
        height, width = image.shape[:2]
        scale = width / picture.shape[1], height / picture.shape[0]
        return ColourMap(picture, detail, scale, (width, height), self._skin_of)
