"""Standardised colours: what the networks see instead of the camera's picture.

The square root lifts the dark end, where a back-lit hand differs from the wall by two grey levels; taking each channel
to mean 0 and deviation 1 is gray-world and contrast normalisation in one, so that cast, veil and exposure
drop out. Everything is a function of one channel's value, hence a table of 256 entries a channel for what is large.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import Quantisation
from lightgesture.features.types import Image

Float = NDArray[np.float32]

_SQUARES = np.arange(256, dtype=np.float64) / 255.0
_ROOTS = np.sqrt(_SQUARES)
_SINGLE_ROOTS = _ROOTS.astype(np.float32)


@dataclass(frozen=True, slots=True)
class StandardSettings:
    """evenness: added to a channel's deviation of square roots (0 to 1), so that noise of a flat picture stays small.
    largest: standardised values are clipped to plus and minus this many deviations.
    """

    evenness: float = 0.02
    largest: float = 3.0


def channel_tables(picture: Image, settings: StandardSettings | None = None) -> Float:
    """float32 (1, 256, 3): the standardised value of each value of blue, green and red of this picture."""
    settings = settings or StandardSettings()
    tables = np.empty((1, 256, 3), np.float32)
    pixels = picture.shape[0] * picture.shape[1]
    for channel in range(3):
        shares = cv2.calcHist([picture], [channel], None, [256], [0, 256]).ravel() / pixels
        tables[0, :, channel] = _table(shares, settings)
    return tables


def patch_levels(
    patches: NDArray[np.uint8], quantisation: Quantisation, settings: StandardSettings | None = None
) -> NDArray[np.int8]:
    """int8 (n, h, w, 3): the integers that stand for small pictures, uint8 (n, h, w, 3), standardised one by one.

    Pictures of a patch's size are summed and scaled themselves: a histogram and tables of 256 entries take longer than
    1,024 pixels do. Against `channel_tables` and `quantise` an integer is one off where rounding is near a tie.
    """
    settings = settings or StandardSettings()
    count, height, width = patches.shape[:3]
    values = cv2.LUT(patches.reshape(count * height, width, 3), _SINGLE_ROOTS).reshape(patches.shape)
    for patch, roots in zip(patches, values, strict=True):
        cv2.transform(roots, _to_levels(cv2.mean(roots), cv2.mean(patch), quantisation, settings), roots)
    reach = round(settings.largest / quantisation.scale)
    if quantisation.zero - reach > -128 or quantisation.zero + reach < 127:
        np.clip(values, quantisation.zero - reach, quantisation.zero + reach, out=values)
    # One pass that rounds as NumPy does and saturates, where NumPy takes four.
    rounded = cv2.add(values.reshape(count * height, -1), 0.0, dtype=cv2.CV_8S)  # type: ignore[call-overload]
    return np.asarray(rounded, np.int8).reshape(patches.shape)


def _to_levels(
    roots: Sequence[float], values: Sequence[float], quantisation: Quantisation, settings: StandardSettings
) -> Float:
    """float32 (3, 4) that takes square roots to levels, given the means of the three channels' square roots and values.

    The value over 255 is the square of its root, so both means give the deviation.
    """
    matrix = np.zeros((3, 4), np.float32)
    for channel in range(3):
        mean = roots[channel]
        deviation = max(values[channel] / 255.0 - mean * mean, 0.0) ** 0.5 + settings.evenness
        factor = 1.0 / (quantisation.scale * deviation)
        matrix[channel, channel] = factor
        matrix[channel, 3] = quantisation.zero - mean * factor
    return matrix


def luma_table(picture: Image, settings: StandardSettings | None = None) -> tuple[Image, Float]:
    """The luma of a picture, uint8 (h, w), and the standardised value of each of its values, float32 (1, 256)."""
    settings = settings or StandardSettings()
    luma = np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8)
    counts = np.bincount(luma.ravel(), minlength=256)
    return luma, _table(counts / luma.size, settings)[None]


def _table(shares: NDArray[np.floating], settings: StandardSettings) -> Float:
    """float32 (256,): square roots taken to mean 0 and deviation 1, given the share of each value."""
    mean = float(shares @ _ROOTS)
    deviation = max(float(shares @ _SQUARES) - mean * mean, 0.0) ** 0.5
    values = (_ROOTS - mean) / (deviation + settings.evenness)
    return np.asarray(np.clip(values, -settings.largest, settings.largest), np.float32)
