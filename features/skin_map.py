"""The default skin map: red compensation, gray-world, an opponent colour and a stretch, in a quarter millisecond.

`reference_skin_map` says what is computed, step by step; `skin_map` computes it in whole numbers through tables, and a
test holds the two together. Whole numbers add up to the same in any order, so that what loops over pixels may be
NumPy's and OpenCV's (`PLAIN`) or compiled (`features/compiled/`), and every picture gets the same bytes.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
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
BINS: Final = 4096
"""Most bins of the histogram from which the fast version reads the percentiles; both versions then differ by a level,
by two in pictures with a few glowing pixels."""
FINE: Final = 256
"""Steps of a level of the compensated red."""
SHARE_BITS: Final = 14
"""Of the fraction of what is given back of it."""
RED_ENTRIES: Final = 4096
"""Of the table of the red's powers."""
UNIT: Final = 32767
"""Stands for a redness of 1; the redness lies between -1 and 1, and UNIT more than that times UNIT fits 16 bits."""
DARKEST_LIGHT: Final = 1e-3
"""An estimate of the light below this counts as this, so that a black channel is not divided by zero."""

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


@dataclass(frozen=True, slots=True)
class SkinLoops:
    """The passes over the pixels of a picture, uint8 (h, w, 3), BGR.

    red: (picture, share) -> uint16 (h, w), the compensated red in steps of 1 / FINE: red + share (255 - red) green
        / 2^SHARE_BITS; its sum; its largest.
    redness: (picture, red, shift, factors) -> uint16 (h, w): what `power_table` has for a pixel's blue, green and red /
        2^shift, added up and blurred by 1-2-1 along x and y; its least and its largest.
    stretch: (values, lowest, highest) -> uint8 (h, w): see `stretch`, of a redness in units of 1 / UNIT, with the
        percentiles from a histogram of BINS bins at most.
    """

    red: Callable[[Image, int], tuple[NDArray[np.uint16], int, int]]
    redness: Callable[
        [Image, NDArray[np.uint16], int, NDArray[np.float64]], tuple[NDArray[np.uint16], int, int]
    ]
    stretch: Callable[[NDArray[np.uint16], int, int], Image]


def skin_map(picture: Image, loops: SkinLoops | None = None) -> Image:
    """Skin map of a BGR picture, uint8 (h, w, 3) -> uint8 (h, w), 0 least to 255 most skin-like.

    loops: what passes over the pixels, None for `PLAIN`; any gives the same map.
    """
    loops = loops or PLAIN
    pixels = picture.shape[0] * picture.shape[1]
    blue, green, red = (total / (255.0 * pixels) for total in cv2.sumElems(picture)[:3])
    share = RED_COMPENSATION * max(green - red, 0.0)
    compensated, total, largest = loops.red(picture, round(share * FINE / 255.0 * (1 << SHARE_BITS)))
    light = blue, green, total / (FINE * 255.0 * pixels)
    shift = max(largest.bit_length() - (RED_ENTRIES - 1).bit_length(), 0)
    # Balancing scales a channel and the power follows it, so that every table is the same one, scaled and clipped.
    mean = (light[0] + light[1] + light[2]) / 3.0
    steps = 255.0, 255.0, 255.0 * FINE / (1 << shift)
    factors = [
        (mean / max(one, DARKEST_LIGHT) / step) ** EXPONENT for one, step in zip(light, steps, strict=True)
    ]
    return loops.stretch(*loops.redness(picture, compensated, shift, np.array(factors)))


def power_table(channel: int, factor: float, entries: int) -> Float:
    """What each value of a channel adds to the redness, float32 (entries,) with whole numbers."""
    return (np.rint(np.minimum(POWERS[:entries] * factor, 1.0) * WEIGHTS[channel]) + OFFSETS[channel]).astype(
        np.float32
    )


def _plain_red(picture: Image, share: int) -> tuple[NDArray[np.uint16], int, int]:
    _, green, red = cv2.split(picture)
    given_back = np.multiply(cv2.bitwise_not(red), green, dtype=np.int32)
    given_back *= share
    given_back >>= SHARE_BITS
    given_back += np.multiply(red, FINE, dtype=np.int32)
    return given_back.astype(np.uint16), int(given_back.sum(dtype=np.int64)), int(given_back.max())


def _plain_redness(
    picture: Image, red: NDArray[np.uint16], shift: int, factors: NDArray[np.float64]
) -> tuple[NDArray[np.uint16], int, int]:
    # Single precision holds these whole numbers and the sixteenths that the blur makes of them exactly.
    blue, green, _ = cv2.split(picture)
    entries = 256, 256, RED_ENTRIES
    blues, greens, reds = (power_table(channel, factors[channel], entries[channel]) for channel in range(3))
    total = reds.take(red >> shift)
    cv2.add(total, cv2.LUT(blue, blues), dst=total)
    cv2.add(total, cv2.LUT(green, greens), dst=total)
    blurred = np.asarray(cv2.GaussianBlur(total, (3, 3), 0)).astype(np.uint16)
    lowest, highest = cv2.minMaxLoc(blurred)[:2]
    return blurred, int(lowest), int(highest)


def _plain_stretch(values: NDArray[np.uint16], lowest: int, highest: int) -> Image:
    shift = max((highest - lowest).bit_length() - (BINS - 1).bit_length(), 0)
    places = (values - np.uint16(lowest)) >> shift
    below = np.bincount(places.ravel(), minlength=((highest - lowest) >> shift) + 1).cumsum()
    low, high = (
        _order_statistic(below, percent / 100.0 * (values.size - 1))
        for percent in (LOW_PERCENTILE, HIGH_PERCENTILE)
    )
    if (high - low) * (1 << shift) < FLAT * UNIT:
        return np.zeros(values.shape, np.uint8)
    levels = (np.arange(len(below)) - low) * (255.0 / (high - low))
    return levels.clip(0.0, 255.0).astype(np.uint8).take(places)


PLAIN: Final = SkinLoops(_plain_red, _plain_redness, _plain_stretch)
POWERS: Final = np.arange(RED_ENTRIES, dtype=np.float64) ** EXPONENT
WEIGHTS: Final = (-YELLOW_WEIGHT * UNIT, (YELLOW_WEIGHT - 1.0) * UNIT, 1.0 * UNIT)
"""Of the powers of blue, green and red."""
OFFSETS: Final = (UNIT, 0, 0)
"""What is added to them, so that no redness is negative."""


def _order_statistic(below: NDArray[np.intp], rank: float) -> float:
    """The value of a rank from 0, in bins, given the cumulated counts; a bin's values stand at its middle.

    Between two whole ranks their values are interpolated, as they may lie many bins apart in a thin tail. Values
    of one bin are taken to be spread evenly over it.
    """
    places = []
    for whole in (math.floor(rank), math.ceil(rank)):
        index = int(below.searchsorted(whole, side="right"))
        before = int(below[index - 1]) if index else 0
        places.append(index - 0.5 + (whole - before + 0.5) / (int(below[index]) - before))
    return places[0] + (rank - math.floor(rank)) * (places[1] - places[0])
