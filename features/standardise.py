"""Standardised colours: what the networks see instead of the camera's picture.

The square root lifts the dark end, where a back-lit hand differs from the wall by two grey levels; taking each channel
to mean 0 and deviation 1 is gray-world and contrast normalisation in one, so that cast, veil and exposure
drop out. Everything is a function of one channel's value, hence a table of 256 entries a channel for what is large.
"""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import Quantisation
from lightgesture.features.types import Float, Image

EVENNESS: Final = 0.02
"""Added to a channel's deviation of square roots (0 to 1), so that the noise of a flat picture stays small."""
LARGEST: Final = 3.0
"""Standardised values are clipped to plus and minus this many deviations."""

_SQUARES = np.arange(256, dtype=np.float64) / 255.0
_ROOTS = np.sqrt(_SQUARES)
_SINGLE_ROOTS = _ROOTS.astype(np.float32)


def square_roots(picture: NDArray[np.uint8]) -> Float:
    """Of values over 255: uint8 (h, w) or (h, w, channels) -> float32, the same shape."""
    return np.asarray(cv2.LUT(picture, _SINGLE_ROOTS), np.float32)


def scales_of(
    picture: NDArray[np.uint8], roots: Float, quantisation: Quantisation
) -> list[tuple[float, float]]:
    """Factor and offset, a channel each, from a square root to the integer that stands for its standardised value.

    picture: uint8 (h, w) or (h, w, channels), up to 4; roots: its `square_roots`.
    """
    scales = []
    channels = 1 if roots.ndim == 2 else roots.shape[2]
    for mean, square in zip(cv2.mean(roots)[:channels], cv2.mean(picture)[:channels], strict=True):
        # The value over 255 is the square of its root, so both means give the deviation.
        deviation = max(square / 255.0 - mean * mean, 0.0) ** 0.5 + EVENNESS
        factor = 1.0 / (quantisation.scale * deviation)
        scales.append((factor, quantisation.zero - mean * factor))
    return scales


def as_levels(
    roots: Float, quantisation: Quantisation, factor: float = 1.0, offset: float = 0.0
) -> NDArray[np.int8]:
    """Integers nearest to factor × roots + offset, clipped to LARGEST deviations: float32 -> int8, the same shape.

    roots: (h, w) or (h, w, channels), up to 4.
    """
    # One pass that rounds as NumPy does and saturates, where NumPy takes four.
    levels = np.asarray(cv2.addWeighted(roots, factor, roots, 0.0, offset, dtype=cv2.CV_8S), np.int8)
    reach = round(LARGEST / quantisation.scale)
    lowest, highest = quantisation.zero - reach, quantisation.zero + reach
    if lowest > -128:
        np.maximum(levels, np.int8(lowest), out=levels)
    if highest < 127:
        np.minimum(levels, np.int8(highest), out=levels)
    return levels


def level_tables(picture: Image, quantisation: Quantisation) -> NDArray[np.int8]:
    """int8 (1, 256, 3): the integer for each value of blue, green and red of a picture; those of `channel_tables`, but
    for one where rounding is near a tie."""
    scales = scales_of(picture, square_roots(picture), quantisation)
    channels = [as_levels(_SINGLE_ROOTS, quantisation, factor, offset) for factor, offset in scales]
    return np.asarray(cv2.merge(channels), np.int8).reshape(1, 256, 3)


def channel_tables(picture: Image) -> Float:
    """float32 (1, 256, 3): the standardised value of each value of blue, green and red of this picture."""
    counts = np.empty((3, 256), np.float32)
    for channel, count in enumerate(counts):
        count[:] = cv2.calcHist([picture], [channel], None, [256], [0, 256]).ravel()
    tables = _tables(counts / (picture.shape[0] * picture.shape[1]))
    return np.ascontiguousarray(tables.T)[None]


def luma_tables(pictures: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], Float]:
    """Of BGR pictures, uint8 (n, h, w, 3): their luma, uint8 (n, h, w), and the standardised value of each value of
    each one's luma, float32 (n, 256)."""
    count, height, width = pictures.shape[:3]
    luma = cv2.cvtColor(pictures.reshape(count * height, width, 3), cv2.COLOR_BGR2GRAY)
    luma = np.asarray(luma, np.uint8).reshape(count, height * width)
    places = luma + np.arange(0, 256 * count, 256)[:, None]
    counts = np.bincount(places.ravel(), minlength=256 * count).reshape(count, 256)
    return luma.reshape(count, height, width), _tables(counts / (height * width))


def _tables(shares: NDArray[np.floating]) -> Float:
    """float32 (n, 256): square roots taken to mean 0 and deviation 1, given the share of each value, (n, 256)."""
    means = np.array([float(share @ _ROOTS) for share in shares])[:, None]
    squares = np.array([float(share @ _SQUARES) for share in shares])[:, None]
    deviations = np.sqrt(np.maximum(squares - means * means, 0.0))
    tables = (_ROOTS - means) / (deviations + EVENNESS)
    return np.asarray(np.minimum(np.maximum(tables, -LARGEST), LARGEST), np.float32)


def patch_levels(patches: NDArray[np.uint8], quantisation: Quantisation) -> NDArray[np.int8]:
    """int8 (n, h, w, 3): the integers that stand for small pictures, uint8 (n, h, w, 3), standardised one by one.

    Pictures of a patch's size are summed and scaled themselves: a histogram and tables of 256 entries take longer than
    1,024 pixels do. Against `channel_tables` and `quantise` an integer is one off where rounding is near a tie.
    """
    count, height, width = patches.shape[:3]
    values = square_roots(patches.reshape(count * height, width, 3)).reshape(patches.shape)
    scales = np.zeros((3, 4), np.float32)
    for patch, roots in zip(patches, values, strict=True):
        for channel, (factor, offset) in enumerate(scales_of(patch, roots, quantisation)):
            scales[channel, channel], scales[channel, 3] = factor, offset
        cv2.transform(roots, scales, roots)
    return as_levels(values.reshape(count * height, width, 3), quantisation).reshape(patches.shape)
