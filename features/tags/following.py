"""A tag that is no longer found, followed from where it was last seen, and believed only if its cells bear it out.

The corners of its cells are followed by the optical flow of Lucas and Kanade in pyramids (Bouguet, 2000), and the
homography that most of them agree on moves the corners of the tag. So a finger on its edge, a bubble before it or a
blurred frame does not end it: a detector needs its whole outline, its cells do not.
"""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float

WINDOW_PX: Final = 15
"""Width of the window of the flow. More: quicker cards are followed, less exactly."""

LEVELS: Final = 2
"""Levels of the pyramid above the picture: a tag may go about 4 windows from frame to frame."""

LEAST_POINTS: Final = 12
"""Fewest corners of cells that must agree, of 49 in a tag of 36h11."""

INLIER_PX: Final = 2.0
"""How far a corner may be from where the others put it."""


def follow_corners(
    before: NDArray[np.uint8], after: NDArray[np.uint8], corners: Float, cells: int
) -> Float | None:
    """Where the corners (4, 2) of a tag of `cells` × `cells` cells in the grey picture `before` are in `after`.

    None: too few of the corners of its cells could be followed.
    """
    edge = np.float32(cells)
    square = np.array([[0, 0], [edge, 0], [edge, edge], [0, edge]], np.float32)
    steps = np.arange(1, cells, dtype=np.float32)
    grid = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 1, 2)
    points = cv2.perspectiveTransform(grid, cv2.getPerspectiveTransform(square, corners))
    moved, found, _ = cv2.calcOpticalFlowPyrLK(
        before, after, points, np.empty_like(points), winSize=(WINDOW_PX, WINDOW_PX), maxLevel=LEVELS
    )
    is_found = found.ravel() > 0
    if is_found.sum() < LEAST_POINTS:
        return None
    homography, agreeing = cv2.findHomography(points[is_found], moved[is_found], cv2.RANSAC, INLIER_PX)
    if homography is None or int(agreeing.sum()) < LEAST_POINTS:
        return None
    target = cv2.perspectiveTransform(corners.reshape(-1, 1, 2), homography).reshape(4, 2)
    is_sound = cv2.isContourConvex(target) and np.isfinite(target).all()
    return np.asarray(target, np.float32) if is_sound else None
