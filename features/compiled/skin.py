"""Loops over the pixels of a picture, to be compiled: what `skin_map.PLAIN` computes, byte for byte.

All numbers are whole up to the last division, so that the order in which they are added changes nothing.
"""

import math
from typing import Any, Final

import numpy as np

from lightgesture.features.skin_map import (
    BINS,
    FINE,
    FLAT,
    HIGH_PERCENTILE,
    LOW_PERCENTILE,
    OFFSETS,
    POWERS,
    SHARE_BITS,
    UNIT,
    WEIGHTS,
)

# Numba has no types that a type checker knows.
Array = Any

HELPERS: Final = ("order_statistic",)
"""What the loops call."""


def red(picture: Array, share: int) -> tuple[Array, int, int]:
    """See `skin_map.SkinLoops`."""
    height, width = picture.shape[:2]
    found = np.empty((height, width), np.uint16)
    total: Array = 0
    largest: Array = 0
    for y in range(height):
        for x in range(width):
            value = np.int64(picture[y, x, 2])
            compensated = value * FINE + (((255 - value) * np.int64(picture[y, x, 1]) * share) >> SHARE_BITS)
            total += compensated
            largest = max(largest, compensated)
            found[y, x] = compensated
    return found, total, largest


def redness(picture: Array, compensated: Array, shift: int, factors: Array) -> tuple[Array, int, int]:
    """See `skin_map.SkinLoops`."""
    height, width = compensated.shape
    tables = np.empty((3, len(POWERS)), np.int32)
    for channel in range(3):
        for entry in range(256 if channel < 2 else len(POWERS)):
            scaled = min(POWERS[entry] * factors[channel], 1.0)
            tables[channel, entry] = np.int32(np.rint(scaled * WEIGHTS[channel])) + OFFSETS[channel]
    across = np.empty((height, width), np.int32)
    line = np.empty(width, np.int32)
    for y in range(height):
        for x in range(width):
            line[x] = (
                tables[0, picture[y, x, 0]]
                + tables[1, picture[y, x, 1]]
                + tables[2, compensated[y, x] >> shift]
            )
        # At the rim the blur sees the pixel on the other side twice, as OpenCV's does.
        if width == 1:
            across[y, 0] = 4 * line[0]
            continue
        across[y, 0] = 2 * line[0] + 2 * line[1]
        across[y, width - 1] = 2 * line[width - 1] + 2 * line[width - 2]
        for x in range(1, width - 1):
            across[y, x] = line[x - 1] + 2 * line[x] + line[x + 1]
    found = np.empty((height, width), np.uint16)
    lowest: Array = np.int32(2 * UNIT + 2)
    highest: Array = np.int32(0)
    for y in range(height):
        above = abs(y - 1) if height > 1 else 0
        below = y + 1 if y + 1 < height else max(height - 2, 0)
        for x in range(width):
            value = np.int32((across[above, x] + 2 * across[y, x] + across[below, x]) >> 4)
            lowest, highest = min(lowest, value), max(highest, value)
            found[y, x] = value
    return found, lowest, highest


def order_statistic(counts: Array, rank: float) -> float:
    """See `skin_map`, with the counts not cumulated."""
    first, last = 0.0, 0.0
    before, index = 0, 0
    for is_last in range(2):
        whole = math.ceil(rank) if is_last else math.floor(rank)
        while before + counts[index] <= whole:
            before += counts[index]
            index += 1
        first, last = last, index - 0.5 + (whole - before + 0.5) / counts[index]
    return first + (rank - math.floor(rank)) * (last - first)


def stretch(values: Array, lowest: int, highest: int) -> Array:
    """See `skin_map.SkinLoops`."""
    height, width = values.shape
    shift = 0
    while (highest - lowest) >> shift >= BINS:
        shift += 1
    counts = np.zeros(((highest - lowest) >> shift) + 1, np.int64)
    for y in range(height):
        for x in range(width):
            counts[(np.int64(values[y, x]) - lowest) >> shift] += 1
    low = order_statistic(counts, LOW_PERCENTILE / 100.0 * (values.size - 1))
    high = order_statistic(counts, HIGH_PERCENTILE / 100.0 * (values.size - 1))
    if (high - low) * (1 << shift) < FLAT * UNIT:
        return np.zeros((height, width), np.uint8)
    levels = np.empty(len(counts), np.uint8)
    factor = 255.0 / (high - low)
    for entry in range(len(levels)):
        levels[entry] = np.uint8(min(max((entry - low) * factor, 0.0), 255.0))
    found = np.empty((height, width), np.uint8)
    for y in range(height):
        for x in range(width):
            found[y, x] = levels[(np.int64(values[y, x]) - lowest) >> shift]
    return found
