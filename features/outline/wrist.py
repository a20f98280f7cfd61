"""The palm circle and the wrist: where the hand ends and the forearm begins.

The palm is the largest circle inside the outline. What leaves it downwards beyond the circle is the forearm, straight
or slanted, and gives the arm's direction; the wrist crosses it about one radius from the palm's centre. Fingers stay
out of this because a raised hand has them above its palm.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image

Point = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class WristSettings:
    """Where the forearm is cut; lengths in palm radii.

    wrist_distance: of the wrist from the palm's centre along the arm, 0.8 to 1.6.
    arm_top: below the palm's centre; what lies higher does not count for the arm's direction. 0 to 1.
    arm_ring: radius of the circle that counts as palm; the arm is what lies outside, 1 to 1.6.
    least_remainder: share of the region's area that the arm must have, else nothing is cut.
    least_height: of what remains, pixels of the working picture.
    """

    wrist_distance: float = 1.2
    arm_top: float = 0.6
    arm_ring: float = 1.3
    least_remainder: float = 0.06
    least_height: int = 5


def fill_contour(contour: NDArray[np.int32], box: Box, border: int = 0) -> Image:
    """uint8 (height + 2 border, width + 2 border): 255 inside the outline, `box` placed in the middle."""
    x, y, width, height = box
    mask = np.zeros((height + 2 * border, width + 2 * border), np.uint8)
    cv2.drawContours(mask, [contour.reshape(-1, 1, 2)], -1, 255, cv2.FILLED, offset=(border - x, border - y))
    return mask


def palm_circle(mask: Image) -> tuple[tuple[int, int], float]:
    """Centre (x, y) and radius in pixels of the largest circle inside a mask with an empty border.

    Turned, enlarged, mirrored: with the mask, to a pixel; of several largest circles the first from the top counts.
    """
    distance = cv2.distanceTransform(mask, cv2.DIST_L2, 3)
    _, radius, _, centre = cv2.minMaxLoc(distance)
    return (centre[0], centre[1]), radius


def arm_direction(
    mask: Image, centre: tuple[int, int], radius: float, settings: WristSettings
) -> Point | None:
    """Unit vector (x, y) from the palm's centre along the forearm, float64 (2,); None where there is none.

    Enlarged and mirrored: with the mask. It looks downwards alone, so it does not follow a turn by more than about 60
    degrees.
    """
    top = int(centre[1] + settings.arm_top * radius)
    if top >= len(mask):
        return None
    arm = mask[top:].copy()
    cv2.circle(arm, (centre[0], centre[1] - top), round(settings.arm_ring * radius), 0, cv2.FILLED)
    moments = cv2.moments(arm, binaryImage=True)
    if moments["m00"] < max(settings.least_remainder * cv2.countNonZero(mask), 1.0):
        return None
    towards = np.array([moments["m10"], moments["m01"]]) / moments["m00"] - np.array(centre) + (0, top)
    length = float(np.hypot(*towards))
    # Rests on both sides of a palm may balance each other: then no arm leaves it.
    return np.asarray(towards / length, np.float64) if length > 0.0 else None


def cut_forearm(contour: NDArray[np.int32], box: Box, settings: WristSettings) -> NDArray[np.int32] | None:
    """The outline without what lies beyond the wrist, int32 (k, 2); None where the region ends there already."""
    mask = fill_contour(contour, box, border=1)
    centre, radius = palm_circle(mask)
    direction = arm_direction(mask, centre, radius, settings)
    if direction is None:
        return None
    whole = cv2.countNonZero(mask)
    _erase_beyond(mask, np.array(centre) + settings.wrist_distance * radius * direction, direction)
    parts = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    if not parts or whole - cv2.countNonZero(mask) < settings.least_remainder * whole:
        return None
    largest = max(parts, key=cv2.contourArea)
    if cv2.boundingRect(largest)[3] < settings.least_height:
        return None
    return np.asarray(largest.reshape(-1, 2) + np.array([box[0] - 1, box[1] - 1]), np.int32)


def _erase_beyond(mask: Image, point: Point, direction: Point) -> None:
    """Set to 0 what lies past the line through `point` across `direction`."""
    far = float(sum(mask.shape))
    across = np.array([-direction[1], direction[0]]) * far
    onwards = direction * far
    corners = np.rint([point - across, point + across, point + across + onwards, point - across + onwards])
    cv2.fillConvexPoly(mask, corners.astype(np.int32), 0)
