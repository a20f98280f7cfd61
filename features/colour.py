"""Colour normalisation: a map on which skin is bright through any cast of the water.

Water takes red first, so a hand under water has the water's own hue, and a fixed skin range finds
about a tenth of it. Giving the red channel back and then balancing the channels to grey brings skin
out again as the reddest thing in view.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

Float = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class ColourSettings:
    """How the colour map is made.

    working_pixels: area of the working picture in pixels (4,800 to 307,200). 19,200 is 160 × 120;
        a larger one finds no more hands and costs in proportion.
    red_compensation: share of the missing red that is given back, 0 to 1 (Ancuti's alpha).
    exponent: power that stands in for the lightness curve of CIELAB, 0.3 to 1; 0.73 was fitted to a*.
    yellow_weight: weight of the green-blue opponent beside the red-green one, 0 to 1.
    low_percentile, high_percentile: percent of pixels below and above the range that the levels
        share; a smaller high percentile lets a large red object use up the range.
    """

    working_pixels: int = 160 * 120
    red_compensation: float = 1.0
    exponent: float = 0.73
    yellow_weight: float = 0.15
    low_percentile: float = 20.0
    high_percentile: float = 99.8


@dataclass(frozen=True, slots=True, eq=False)
class ColourMap:
    """A frame made ready for the search.

    picture: uint8 (h, w, 3), BGR, reduced to about the working area.
    skin: uint8 (h, w), 0 least to 255 most skin-like.
    scale: (x, y) source pixels for one pixel of `picture`.
    source_size: (width, height) of the source frame, pixels.
    """

    picture: Image
    skin: Image
    scale: tuple[float, float]
    source_size: tuple[int, int]


def reduce_picture(image: Image, pixels: int) -> Image:
    """Reduce `image` to about `pixels` pixels, aspect kept; a smaller one is returned as it is.

    Two steps, the first to twice the size by plain sampling: one area-averaging step from full size
    costs four times as much and the difference does not show in the map.
    """
    height, width = image.shape[:2]
    ratio = (pixels / (height * width)) ** 0.5
    if ratio >= 1.0:
        return image
    target = max(1, round(width * ratio)), max(1, round(height * ratio))
    if ratio < 0.5:
        image = cv2.resize(image, (2 * target[0], 2 * target[1]), interpolation=cv2.INTER_LINEAR)  # type: ignore[assignment]
    return cv2.resize(image, target, interpolation=cv2.INTER_AREA)  # type: ignore[return-value]


def compensate_red(bgr: Float, share: float) -> Float:
    """Give the red channel back what the water took, led by the green channel.

    Ancuti, Ancuti, De Vleeschouwer and Bekaert, "Color Balance and Fusion for Underwater Image
    Enhancement", IEEE Transactions on Image Processing 27(1), 2018, equation 4:
    I_rc = I_r + alpha (mean(I_g) - mean(I_r)) (1 - I_r) I_g, channels in 0 to 1.
    """
    green, red = bgr[..., 1], bgr[..., 2]
    missing = max(float(green.mean()) - float(red.mean()), 0.0)
    compensated = bgr.copy()
    compensated[..., 2] = red + share * missing * (1.0 - red) * green
    return compensated


def gray_world(bgr: Float) -> Float:
    """Scale each channel to the common mean (Buchsbaum, "A spatial processor model for object colour
    perception", 1980); values are clipped to 1."""
    means = bgr.reshape(-1, 3).mean(axis=0)
    return np.asarray(np.minimum(bgr * (means.mean() / np.maximum(means, 1e-3)), 1.0), np.float32)


def redness(bgr: Float, exponent: float, yellow_weight: float) -> Float:
    """Opponent colour R^e - G^e + w (G^e - B^e): a stand-in for a* + 0.3 b* without CIELAB."""
    blue, green, red = np.moveaxis(np.power(bgr, exponent), -1, 0)
    return np.asarray((red - green) + yellow_weight * (green - blue), np.float32)


def stretch(values: Float, low_percentile: float, high_percentile: float) -> Image:
    """Map the range between two percentiles to 0 to 255; a constant map gives zeros."""
    low, high = np.percentile(values, [low_percentile, high_percentile])
    if high - low < 1e-4:
        return np.zeros(values.shape, np.uint8)
    return np.asarray(np.clip((values - low) * (255.0 / (high - low)), 0, 255), np.uint8)


class ColourStage:
    """Frame -> colour map."""

    def __init__(self, settings: ColourSettings | None = None) -> None:
        self.settings = settings or ColourSettings()

    def process(self, image: Image) -> ColourMap:
        """Make the colour map of one BGR frame, uint8 (height, width, 3), of any size from 1 × 1."""
        settings = self.settings
        picture = reduce_picture(image, settings.working_pixels)
        bgr = picture.astype(np.float32) * np.float32(1 / 255)
        bgr = gray_world(compensate_red(bgr, settings.red_compensation))
        opponent = redness(bgr, settings.exponent, settings.yellow_weight)
        opponent = np.asarray(cv2.GaussianBlur(opponent, (3, 3), 0), np.float32)
        skin = stretch(opponent, settings.low_percentile, settings.high_percentile)
        height, width = image.shape[:2]
        scale = width / picture.shape[1], height / picture.shape[0]
        return ColourMap(picture=picture, skin=skin, scale=scale, source_size=(width, height))
