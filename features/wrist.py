"""The palm circle and the wrist: where the hand ends and the forearm begins.

The palm is the largest circle inside the outline; the wrist lies about one radius below its centre,
where the forearm leaves it. A raised hand is upright, so the forearm leaves downwards.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image


@dataclass(frozen=True, slots=True)
class WristSettings:
    """Where the forearm is cut.

    wrist_distance: wrist below the palm's centre in palm radii, 0.8 to 1.6.
    least_remainder: share of the region's height that must lie below the cut, else nothing is cut.
    least_height: of what remains, pixels of the working picture.
    """

    wrist_distance: float = 1.1
    least_remainder: float = 0.12
    least_height: int = 5


def fill_contour(contour: NDArray[np.int32], box: Box, border: int = 0) -> Image:
    """uint8 (height + 2 border, width + 2 border): 255 inside the outline, `box` placed in the middle."""
    x, y, width, height = box
    mask = np.zeros((height + 2 * border, width + 2 * border), np.uint8)
    cv2.drawContours(mask, [contour.reshape(-1, 1, 2)], -1, 255, cv2.FILLED, offset=(border - x, border - y))
    return mask


def palm_circle(mask: Image) -> tuple[tuple[int, int], float]:
    """Centre (x, y) and radius in pixels of the largest circle inside a mask with an empty border."""
    distance = cv2.distanceTransform(mask, cv2.DIST_L2, 3)
    _, radius, _, centre = cv2.minMaxLoc(distance)
    return (centre[0], centre[1]), radius


def cut_forearm(contour: NDArray[np.int32], box: Box, settings: WristSettings) -> NDArray[np.int32] | None:
    """The outline above the wrist, int32 (k, 2); None where the region ends at the wrist already."""
    mask = fill_contour(contour, box, border=1)
    (_, centre_y), radius = palm_circle(mask)
    bottom = int(centre_y + settings.wrist_distance * radius)
    height = box[3]
    if bottom > height * (1.0 - settings.least_remainder) or bottom < settings.least_height:
        return None
    mask[bottom:] = 0
    parts = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    largest = max(parts, key=cv2.contourArea)
    return np.asarray(largest.reshape(-1, 2) + np.array([box[0] - 1, box[1] - 1]), np.int32)
