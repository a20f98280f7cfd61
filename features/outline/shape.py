"""Numbers of one outline: how large, how full, how long and how dented it is.

The numbers that contour-based readers of hand gestures choose by (as Islam, Ho and Sattar, "Dynamic Reconfiguration of
Mission Parameters in Underwater Human-Robot Collaboration", ICRA 2018, do), each with its own source.
An outline is int32 (n, 2), closed, in pixels, x to the right and y down. What turning, enlarging by s and
mirroring do to a number stands with it; on pixels all of that holds up to rounding.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

Contour = NDArray[np.int32]
Float = NDArray[np.float64]

DEPTH_UNIT = 256.0
"""OpenCV gives the depth of a convexity defect as an integer, in this share of a pixel."""


@dataclass(frozen=True, slots=True, eq=False)
class ConvexityDefects:
    """Dents of an outline, in its order: k points each, int32 (k, 2), and their depth.

    start, end: where the outline leaves its hull and meets it again. deepest: its farthest point from the hull in
    between: the valley between two fingers. depth: float64 (k,), that distance in pixels.
    """

    start: Contour
    end: Contour
    deepest: Contour
    depth: Float

    def __len__(self) -> int:
        return len(self.depth)


def area(contour: Contour) -> float:
    """Area inside the outline, pixels². Turned, mirrored: the same. Enlarged: times s²."""
    return float(cv2.contourArea(_as_curve(contour)))


def perimeter(contour: Contour) -> float:
    """Length of the outline, pixels. Turned, mirrored: the same. Enlarged: times s.

    Along pixel steps a slanted line is up to 8 % longer than it looks.
    """
    return float(cv2.arcLength(_as_curve(contour), True))


def convex_hull(contour: Contour) -> Contour:
    """Corners of the smallest convex outline round it, int32 (k, 2). Turned, enlarged, mirrored: with the outline."""
    return np.asarray(cv2.convexHull(_as_curve(contour)), np.int32).reshape(-1, 2)


def hull_centre(contour: Contour) -> Float:
    """Centroid of the area inside the hull, float64 (2,), x and y. Turned, enlarged, mirrored: with the outline.

    Of a line or a point, the mean of the hull's corners.
    """
    hull = convex_hull(contour)
    moments = cv2.moments(_as_curve(hull))
    if moments["m00"] == 0.0:
        return np.asarray(hull.mean(axis=0), np.float64)
    return np.array([moments["m10"], moments["m01"]]) / moments["m00"]


def solidity(contour: Contour) -> float:
    """Area over the hull's area, 0 to 1; 1 without area. Turned, enlarged, mirrored: the same.

    A fist is near 1, a spread hand near 0.6.
    """
    hull_area = area(convex_hull(contour))
    return min(area(contour) / hull_area, 1.0) if hull_area > 0.0 else 1.0


def extent(contour: Contour) -> float:
    """Area over that of the upright box round it, 0 to 1. Enlarged, mirrored: the same. Turned: another."""
    _, _, width, height = cv2.boundingRect(_as_curve(contour))
    return area(contour) / (width * height)


def aspect(contour: Contour) -> float:
    """Width over height of the upright box. Enlarged, mirrored: the same. Turned by 90 degrees: one over it."""
    _, _, width, height = cv2.boundingRect(_as_curve(contour))
    return width / height


def circularity(contour: Contour) -> float:
    """4 pi area / perimeter², 1 for a disc and less for all else; 0 for a point. Turned, enlarged, mirrored: the same.

    Cox, "A method of assigning numerical and percentage values to the degree of roundness of sand grains", 1927.
    """
    length = perimeter(contour)
    return 4.0 * np.pi * area(contour) / length**2 if length > 0.0 else 0.0


def convexity_defects(contour: Contour, least_depth: float = 0.0) -> ConvexityDefects:
    """Dents at least `least_depth` pixels deep. Turned, mirrored: the points go with the outline, depths stay
    (a mirror image swaps start and end). Enlarged: depths times s.

    Homma and Takenaka, "An image processing method for feature extraction of space-occupying lesions", 1985.
    """
    found = _defects(contour)
    found = found[found[:, 3] >= least_depth * DEPTH_UNIT]
    start, end, deepest = (contour[found[:, column]] for column in range(3))
    return ConvexityDefects(start, end, deepest, found[:, 3] / DEPTH_UNIT)


def defect_depths(contour: Contour) -> Float:
    """Depths of all dents in pixels, float64 (k,): those of `convexity_defects`, in half its time."""
    return np.asarray(_defects(contour)[:, 3] / DEPTH_UNIT, np.float64)


def _defects(contour: Contour) -> NDArray[np.int64]:
    """Indices of start, end and deepest point, and depth in 1/256 pixel: int64 (k, 4)."""
    none = np.zeros((0, 4), np.int64)
    if len(contour) < 4:
        return none
    hull = np.asarray(cv2.convexHull(_as_curve(contour), returnPoints=False)).reshape(-1)
    # OpenCV refuses a hull whose indices are not monotonous, which rounding makes of outlines that touch themselves.
    hull = np.sort(hull)[::-1].astype(np.int32)
    if len(hull) < 3:
        return none
    defects = cv2.convexityDefects(_as_curve(contour), hull.reshape(-1, 1))
    return none if defects is None else np.asarray(defects, np.int64).reshape(-1, 4)


def _as_curve(contour: Contour) -> Contour:
    """The shape that every version of OpenCV takes: (n, 1, 2)."""
    return contour.reshape(-1, 1, 2)
