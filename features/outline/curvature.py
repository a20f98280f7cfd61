"""Curvature points: the fingertips and the valleys between fingers, where an outline turns sharply.

k-curvature, as in Segen and Kumar, "Gesture VR: Vision-Based 3D Hand Interface for Spatial Interaction", ACM
Multimedia 1998: at each point of the outline, the angle between the arms that lead a fixed way back and forth along it;
a sharp angle that is the sharpest round about is a peak where the outline bulges and a valley where it dents.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.outline.resample import Contour, resample

Float = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class CurvatureSettings:
    """Which points count.

    points: into which the outline is divided, 64 to 512; sets the precision, 1 / points of the outline's length.
    arm: way along the outline from a point to the ends of its arms, share of the length, 0.02 to 0.1. About the
        length of a fingertip: shorter arms see the steps of pixels, longer ones reach over the next valley.
    fingertip, valley: sharpest angles in degrees up to which a point counts, 30 to 150.
    apart: least way between two points of a kind along the outline, share of its length.
    """

    points: int = 128
    arm: float = 0.03
    fingertip: float = 110.0
    valley: float = 110.0
    apart: float = 0.03


@dataclass(frozen=True, slots=True, eq=False)
class CurvaturePoints:
    """Sharp turns of an outline, in its order; coordinates in its pixels, angles in degrees.

    fingertips: float64 (k, 2), fingertip_angles: (k,). valleys: float64 (m, 2), valley_angles: (m,).
    """

    fingertips: Float
    fingertip_angles: Float
    valleys: Float
    valley_angles: Float


def curvature_points(contour: Contour, settings: CurvatureSettings | None = None) -> CurvaturePoints:
    """Fingertips and valleys of a closed outline, int32 (n, 2).

    Turned, enlarged, mirrored: the points go with the outline and the angles stay, up to the rounding of pixels
    and to one part in `points` of the outline's length. The corners of a wrist that was cut count as fingertips too
    where they are sharp enough.
    """
    settings = settings or CurvatureSettings()
    walk = resample(contour, settings.points)
    reach = max(1, round(settings.arm * settings.points))
    back, forth = np.roll(walk, reach) - walk, np.roll(walk, -reach) - walk
    turn = np.imag(np.conj(forth) * back) * _direction(walk)
    angles = np.degrees(np.abs(np.angle(np.conj(forth) * back)))
    # A point without an outline round it has arms of no length, and no angle.
    angles[(back == 0.0) | (forth == 0.0)] = 180.0
    bulges, dents = np.where(turn > 0.0, angles, 180.0), np.where(turn < 0.0, angles, 180.0)
    window = max(1, round(settings.apart * settings.points))
    tips = _sharpest(bulges, settings.fingertip, window)
    valleys = _sharpest(dents, settings.valley, window)
    points = np.stack([walk.real, walk.imag], axis=1)
    return CurvaturePoints(points[tips], bulges[tips], points[valleys], dents[valleys])


def _direction(walk: NDArray[np.complex128]) -> float:
    """1 or -1: which way round the outline runs, by its signed area."""
    return 1.0 if float(np.imag(np.conj(walk) * np.roll(walk, -1)).sum()) >= 0.0 else -1.0


def _sharpest(angles: Float, limit: float, window: int) -> NDArray[np.intp]:
    """Indices of angles below `limit` that are the least within `window` steps either way, in order.

    Of equal ones the first counts.
    """
    ring = np.concatenate([angles[-window:], angles, angles[:window]])
    least = np.lib.stride_tricks.sliding_window_view(ring, window).min(axis=1)
    before, after = least[: len(angles)], least[window + 1 :]
    return np.flatnonzero((angles < before) & (angles <= after) & (angles < limit))
