"""Hu's seven moment invariants of an outline, and their logarithms.

Hu, "Visual Pattern Recognition by Moment Invariants", IRE Transactions on Information Theory 8, 1962. They
do not change when the outline is moved, turned or enlarged; its mirror image changes the sign of the seventh.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

SMALLEST = 1e-12
"""Moments nearer to zero than this count as this: a symmetric outline has several that are rounding errors."""

HU_COUNT = 7
"""Number of invariants."""


def hu_moments(contour: NDArray[np.int32]) -> NDArray[np.float64]:
    """The invariants of the area inside a closed outline, int32 (n, 2), as float64 (7,); zeros without area."""
    moments = cv2.moments(contour.reshape(-1, 1, 2))
    if moments["m00"] == 0.0:
        return np.zeros(HU_COUNT)
    return np.asarray(cv2.HuMoments(moments), np.float64).reshape(HU_COUNT)


def log_signed(moments: NDArray[np.float64]) -> NDArray[np.float64]:
    """sign(h) (12 + log10 |h|), float64 (7,): comparable sizes, the sign of a mirror image kept.

    Small moments go to 0 from both signs, so that a sign that is only noise does not matter.
    """
    size = np.maximum(np.abs(moments), SMALLEST)
    return np.asarray(np.sign(moments) * (np.log10(size) - np.log10(SMALLEST)))
