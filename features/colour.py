"""Frame -> working picture and skin map.

Water takes red first, so a hand under water has the water's own hue, and a fixed skin range finds
about a tenth of it. Giving the red channel back and then balancing the channels to grey brings skin
out again as the reddest thing in view.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import cv2

from lightgesture.features.image import as_bgr8, check_frame
from lightgesture.features.profile import ColourProfile
from lightgesture.features.skin_map import SkinMapSettings, skin_map
from lightgesture.features.types import Image

LONGEST_SIDE = 1024
"""Pixels of the working picture: of a frame of 1 × 100,000, which no camera gives, less is looked at."""


@dataclass(frozen=True, slots=True)
class ColourSettings:
    """How the colour map is made.

    working_pixels: area of the working picture in pixels (4,800 to 307,200). 19,200 is 160 × 120;
        a larger one finds no more hands and costs in proportion.
    skin: how the default skin map is made.
    """

    working_pixels: int = 160 * 120
    skin: SkinMapSettings = field(default_factory=SkinMapSettings)


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

    @property
    def detail_scale(self) -> float:
        """Pixels of `detail` for one of `picture`."""
        return float(self.detail.shape[1] / self.picture.shape[1])


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
    target = _side(width * ratio), _side(height * ratio)
    if ratio < 0.5 or max(height, width) > 2 * LONGEST_SIDE:
        image = cv2.resize(image, (2 * target[0], 2 * target[1]), interpolation=cv2.INTER_LINEAR)  # type: ignore[assignment]
    return cv2.resize(image, target, interpolation=cv2.INTER_AREA), image  # type: ignore[return-value]


def _side(length: float) -> int:
    return min(max(round(length), 1), LONGEST_SIDE)


class ColourStage:
    """Frame -> colour map.

    profile: the colours of this diver's hands; None for the default map, on which any skin is bright.
    """

    def __init__(self, settings: ColourSettings | None = None, profile: ColourProfile | None = None) -> None:
        self.settings = settings or ColourSettings()
        self.profile = profile

    def process(self, image: Image) -> ColourMap:
        """Make the colour map of one frame of any size from 1 × 1, BGR or what `as_bgr8` makes of it.

        Raises ValueError, one line, for an array that is no picture.
        """
        check_frame(image)
        if image.ndim == 3:
            # Alpha goes first: on Arm OpenCV reduces four channels by another rounding than three.
            image = image[..., :3]
        # Reduced first: of a huge frame of 16 bits only what is looked at is converted.
        picture, detail = (as_bgr8(part) for part in reduce_picture(image, self.settings.working_pixels))
        height, width = image.shape[:2]
        scale = width / picture.shape[1], height / picture.shape[0]
        return ColourMap(picture, detail, scale, (width, height), self._skin)

    def _skin(self, picture: Image) -> Image:
        if self.profile is not None:
            return self.profile.map(picture)
        return skin_map(picture, self.settings.skin)
