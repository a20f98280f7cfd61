"""The default skin map: red compensation, gray-world, an opponent colour and a stretch, in a quarter millisecond.

`reference_skin_map` says what is computed, step by step; `skin_map` computes it through tables and whole-picture
operations of OpenCV, and a test holds the two together.
"""

import math
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float, Image

RED_COMPENSATION: Final = 1.0
"""Share of the missing red that is given back, 0 to 1 (Ancuti's alpha)."""
EXPONENT: Final = 0.73
"""Power that stands in for the lightness curve of CIELAB, fitted to a*."""
YELLOW_WEIGHT: Final = 0.15
"""Weight of the green-blue opponent beside the red-green one, 0 to 1."""
LOW_PERCENTILE: Final = 20.0
"""Percent of pixels below the range that the levels share."""
HIGH_PERCENTILE: Final = 99.8
"""Percent of pixels up to its end; a smaller one lets a large red object use up the range."""
BINS: Final = 2048
"""Of the histogram from which the fast version reads the percentiles; both versions then differ by a level, by two in
pictures with a few glowing pixels."""
DARKEST_LIGHT: Final = 1e-3
"""An estimate of the light below this counts as this, so that a black channel is not divided by zero."""

_LEVELS = np.arange(256, dtype=np.float32) / np.float32(255)

FLAT: Final = 1e-4
"""A map whose percentiles lie closer together than this holds nothing but noise and is given as zeros."""


def compensate_red(bgr: Float) -> Float:
    """Give the red channel back what the water took, led by the green channel.

    Ancuti, Ancuti, De Vleeschouwer and Bekaert, "Color Balance and Fusion for Underwater Image
    Enhancement", IEEE Transactions on Image Processing 27(1), 2018, equation 4:
    I_rc = I_r + alpha (mean(I_g) - mean(I_r)) (1 - I_r) I_g, channels in 0 to 1.
    """
    green, red = bgr[..., 1], bgr[..., 2]
    missing = max(float(green.mean()) - float(red.mean()), 0.0)
    compensated = bgr.copy()
    compensated[..., 2] = red + RED_COMPENSATION * missing * (1.0 - red) * green
    return compensated


def gray_world(bgr: Float) -> Float:
    """Divide each channel by its mean, the mean of the three kept; values are clipped to 1.

    Buchsbaum, "A spatial processor model for object colour perception", Journal of the Franklin Institute
    310(1), 1980: the average of a scene is grey. So the mean is the colour of the light (von Kries).
    """
    light = bgr.reshape(-1, 3).mean(axis=0)
    return np.asarray(np.minimum(bgr * (light.mean() / np.maximum(light, DARKEST_LIGHT)), 1.0), np.float32)


def redness(bgr: Float) -> Float:
    """Opponent colour R^e - G^e + w (G^e - B^e): a stand-in for a* + 0.3 b* without CIELAB."""
    blue, green, red = np.moveaxis(np.power(bgr, EXPONENT), -1, 0)
    return np.asarray((red - green) + YELLOW_WEIGHT * (green - blue), np.float32)


def stretch(values: Float) -> Image:
    """Map the range between the two percentiles to 0 to 255; a constant map gives zeros."""
    low, high = np.percentile(values, [LOW_PERCENTILE, HIGH_PERCENTILE])
    if high - low < FLAT:
        return np.zeros(values.shape, np.uint8)
    return np.asarray(np.clip((values - low) * (255.0 / (high - low)), 0, 255), np.uint8)


def reference_skin_map(picture: Image) -> Image:
    """What `skin_map` computes, written out: uint8 (h, w, 3) BGR -> uint8 (h, w), 255 most skin-like."""
    bgr = picture.astype(np.float32) * np.float32(1 / 255)
    opponent = redness(gray_world(compensate_red(bgr)))
    return stretch(np.asarray(cv2.GaussianBlur(opponent, (3, 3), 0), np.float32))


def skin_map(picture: Image) -> Image:
    """Skin map of a BGR picture, uint8 (h, w, 3) -> uint8 (h, w), 0 least to 255 most skin-like."""
    opponent = cv2.GaussianBlur(_fast_redness(picture), (3, 3), 0)
    return _fast_stretch(np.asarray(opponent, np.float32))


def _fast_redness(picture: Image) -> Float:
    """`redness` of the balanced picture, float32 (h, w).

    Balancing scales a channel and the power follows it, so blue and green are one table of 256 entries each. The
    compensated red is no function of red alone: it is computed as it stands.
    """
    blue, green, red = cv2.split(picture)
    mean_blue, mean_green, mean_red = (mean / 255.0 for mean in cv2.mean(picture)[:3])
    share = RED_COMPENSATION * max(mean_green - mean_red, 0.0)
    compensated = cv2.multiply(cv2.bitwise_not(red), green, scale=share / 255.0**2, dtype=cv2.CV_32F)
    compensated = cv2.addWeighted(red, 1 / 255.0, compensated, 1.0, 0.0, dtype=cv2.CV_32F)
    light = np.array([mean_blue, mean_green, cv2.mean(compensated)[0]])
    gains = light.mean() / np.maximum(light, DARKEST_LIGHT)
    tables = _power_tables(gains[:2])
    cool = cv2.add(cv2.LUT(blue, tables[0]), cv2.LUT(green, tables[1]))
    clipped = cv2.threshold(compensated, 1.0 / max(gains[2], DARKEST_LIGHT), 0, cv2.THRESH_TRUNC)[1]
    warm = cv2.pow(clipped, EXPONENT)
    return np.asarray(cv2.scaleAdd(warm, gains[2] ** EXPONENT, cool), np.float32)


def _power_tables(gains: NDArray[np.float64]) -> Float:
    """float32 (2, 256): what each value of blue and of green adds to the redness."""
    values = np.minimum(_LEVELS * gains[:, None].astype(np.float32), 1.0) ** np.float32(EXPONENT)
    weights = np.array([[-YELLOW_WEIGHT], [YELLOW_WEIGHT - 1.0]], np.float32)
    return np.asarray(values * weights, np.float32)


def _fast_stretch(values: Float) -> Image:
    """`stretch` with percentiles from a histogram."""
    low, high = histogram_percentiles(values, (LOW_PERCENTILE, HIGH_PERCENTILE), BINS)
    if high - low < FLAT:
        return np.zeros(values.shape, np.uint8)
    scale = 255.0 / (high - low)
    # The conversion rounds and the reference cuts off: half a level less makes both the same.
    levels = cv2.addWeighted(values, scale, values, 0.0, -low * scale - 0.5, dtype=cv2.CV_8U)
    return np.asarray(levels, np.uint8)


def histogram_percentiles(values: Float, percents: tuple[float, float], bins: int) -> tuple[float, float]:
    """Two percentiles of an array of finite values from a histogram of `bins` bins over its range.

    Exact to a bin.
    """
    lowest, highest, _, _ = cv2.minMaxLoc(values)
    if highest <= lowest:
        return lowest, lowest
    scale = bins / (highest - lowest)
    # The conversion rounds, so bin k holds what lies within half a bin of lowest + k / scale.
    places = cv2.addWeighted(values, scale, values, 0.0, -lowest * scale, dtype=cv2.CV_16U)
    below = np.bincount(np.asarray(places).ravel()).cumsum()
    low, high = (_order_statistic(below, percent / 100.0 * (values.size - 1)) for percent in percents)
    return max(lowest + low / scale, lowest), min(lowest + high / scale, highest)


def _order_statistic(below: NDArray[np.intp], rank: float) -> float:
    """The value of a rank from 0, in bins from the middle of the first, given the cumulated counts.

    Between two whole ranks their values are interpolated, as they may lie many bins apart in a thin tail. Values
    of one bin are taken to be spread evenly over it.
    """
    places = []
    for whole in (math.floor(rank), math.ceil(rank)):
        index = int(below.searchsorted(whole, side="right"))
        before = int(below[index - 1]) if index else 0
        places.append(index - 0.5 + (whole - before + 0.5) / (int(below[index]) - before))
    return places[0] + (rank - math.floor(rank)) * (places[1] - places[0])
