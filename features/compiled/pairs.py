"""Loops over pairs of candidates, to be compiled: what `candidates.numbers_of` computes, number by number.

Logarithms are taken by NumPy between the two, as another library's differ in the last bit.
"""

from typing import Any, Final

import numpy as np

from lightgesture.features.find.candidates import DARKEST, FAR, PAIR_COLUMNS

# Numba has no types that a type checker knows.
Array = Any

HELPERS: Final = ()
"""What the loops call: nothing."""


def ratios(left: Array, right: Array, shorter: int) -> Array:
    """float64 (n, 8): of each pair what logarithms are taken of, sides, widths, heights, blue, green, red and the size
    of both in a picture of that shorter side; and this size in pixels.

    left, right: float64 (n, 9), see `candidates.Rows`.
    """
    found = np.empty((len(left), 8), np.float64)
    for pair in range(len(left)):
        a, b = left[pair], right[pair]
        one, other = np.sqrt(a[2] * a[3]), np.sqrt(b[2] * b[3])
        unit = np.sqrt(one * other)
        found[pair, 0], found[pair, 1], found[pair, 2] = one / other, a[2] / b[2], a[3] / b[3]
        for channel in range(3):
            found[pair, 3 + channel] = (a[6 + channel] + DARKEST) / (b[6 + channel] + DARKEST)
        found[pair, 6], found[pair, 7] = unit / shorter, unit
    return found


def pair_rows(left: Array, right: Array, units: Array, logs: Array, across: int, down: int) -> Array:
    """float32 (n, PAIR_COLUMNS): see `candidates.numbers_of`, without a face. units: of `ratios`, logs: of these."""
    found = np.empty((len(left), PAIR_COLUMNS), np.float32)
    for pair in range(len(left)):
        a, b, log, unit = left[pair], right[pair], logs[pair], units[pair, 7]
        x, y = a[0] + a[2] / 2, a[1] + a[3] / 2
        other_x, other_y = b[0] + b[2] / 2, b[1] + b[3] / 2
        found[pair, 0], found[pair, 1] = min(a[4], b[4]), max(a[4], b[4])
        found[pair, 2], found[pair, 3], found[pair, 4] = abs(log[0]), abs(log[1]), abs(log[2])
        found[pair, 5], found[pair, 6] = (other_x - x) / unit, abs((other_y - y) / unit)
        found[pair, 7] = (b[0] - a[0] - a[2]) / unit
        found[pair, 8] = abs((a[1] + a[3]) - (b[1] + b[3])) / unit
        found[pair, 9], found[pair, 10] = (x + other_x) / 2 / across, (y + other_y) / 2 / down
        found[pair, 11] = log[6]
        found[pair, 12] = abs((log[3] + log[4] + log[5]) / 3)
        found[pair, 13], found[pair, 14] = abs(log[5] - log[4]), abs(a[5] - b[5])
        found[pair, 15], found[pair, 16] = FAR, FAR
    return found
