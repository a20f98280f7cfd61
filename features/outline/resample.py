"""An outline of any length as a given number of points, evenly spaced along it."""

import numpy as np
from numpy.typing import NDArray

Contour = NDArray[np.int32]


def resample(contour: Contour, count: int) -> NDArray[np.complex128]:
    """`count` points along a closed outline, int32 (n, 2), n of at least 1: complex128 (count,), x + iy in pixels.

    The first point stays the first; steps are equal arcs, so that neither the pixel grid nor the number of corners
    counts. Turned, enlarged, mirrored: with the outline, up to the rounding of pixels.
    """
    walk = np.empty(len(contour) + 1, np.complex128)
    walk.real[:-1], walk.imag[:-1] = contour[:, 0], contour[:, 1]
    walk[-1] = walk[0]
    along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(walk)))])
    wanted = along[-1] * (np.arange(count) / count)
    return np.asarray(np.interp(wanted, along, walk), np.complex128)
