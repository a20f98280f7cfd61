"""A forearm is cut off at the wrist.

The palm is the largest circle inside the outline. What leaves it downwards beyond the circle is the forearm, straight
or slanted, and gives the arm's direction; the wrist crosses it about one radius from the palm's centre. Fingers stay
out of this because a raised hand has them above its palm.
"""

import math
from typing import Final

import cv2
import numpy as np

from lightgesture.features.types import Box, Contour, Image

Point = tuple[float, float]

WRIST_DISTANCE: Final = 1.2
"""Of the wrist from the palm's centre along the arm, palm radii."""
ARM_TOP: Final = 0.6
"""Palm radii below the palm's centre; what lies higher does not count for the arm's direction."""
ARM_RING: Final = 1.3
"""Radius of the circle that counts as palm, palm radii; the arm is what lies outside."""
LEAST_REMAINDER: Final = 0.06
"""Share of the region's area that the arm must have, else nothing is cut."""
LEAST_HEIGHT: Final = 5
"""Of what remains, pixels of the working picture."""


def fill_contour(contour: Contour, box: Box, border: int = 0) -> Image:
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


def arm_direction(mask: Image, centre: tuple[int, int], radius: float) -> Point | None:
    """Unit vector (x, y) from the palm's centre along the forearm; None where there is none.

    Enlarged and mirrored: with the mask. It looks downwards alone, so it does not follow a turn by more than about 60
    degrees.
    """
    top = int(centre[1] + ARM_TOP * radius)
    if top >= len(mask):
        return None
    arm = mask[top:].copy()
    cv2.circle(arm, (centre[0], centre[1] - top), round(ARM_RING * radius), 0, cv2.FILLED)
    moments = cv2.moments(arm, binaryImage=True)
    sums = moments["m00"], moments["m10"], moments["m01"]
    return direction_from(sums, top, cv2.countNonZero(mask), centre)


def direction_from(
    sums: tuple[float, float, float], top: float, pixels: int, centre: tuple[int, int]
) -> Point | None:
    """`arm_direction` of what lies below the row `top` outside the palm: its area and the sums of its columns and of
    its rows from there. pixels: of the whole region."""
    area, columns, rows = sums
    if area < max(LEAST_REMAINDER * pixels, 1.0):
        return None
    across, down = columns / area - centre[0], rows / area - centre[1] + top
    length = math.hypot(across, down)
    # Rests on both sides of a palm may balance each other: then no arm leaves it.
    return (across / length, down / length) if length > 0.0 else None


def cut_forearm(contour: Contour, box: Box) -> Contour | None:
    """The outline without what lies beyond the wrist, int32 (k, 2); None where the region ends there already."""
    mask = fill_contour(contour, box, border=1)
    centre, radius = palm_circle(mask)
    direction = arm_direction(mask, centre, radius)
    if direction is None or not erase_forearm(mask, cv2.countNonZero(mask), centre, radius, direction):
        return None
    # Of the outline in the picture's pixels: the mask begins a pixel before the box.
    origin = box[0] - 1, box[1] - 1
    parts = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE, offset=origin)[0]
    largest = max(parts, key=cv2.contourArea, default=None)
    if largest is None or cv2.boundingRect(largest)[3] < LEAST_HEIGHT:
        return None
    return np.asarray(largest, np.int32).reshape(-1, 2)


def erase_forearm(mask: Image, pixels: int, centre: tuple[int, int], radius: float, direction: Point) -> bool:
    """Set to 0 what lies beyond the wrist; whether that was enough to be a forearm. pixels: of the mask."""
    wrist = WRIST_DISTANCE * radius
    _erase_beyond(mask, (centre[0] + wrist * direction[0], centre[1] + wrist * direction[1]), direction)
    return pixels - cv2.countNonZero(mask) >= LEAST_REMAINDER * pixels


def _erase_beyond(mask: Image, point: Point, direction: Point) -> None:
    """Set to 0 what lies past the line through `point` across `direction`."""
    (x, y), (along_x, along_y) = point, direction
    far = float(sum(mask.shape))
    across_x, across_y = far * along_y, far * along_x
    corners = (
        (round(x + across_x), round(y - across_y)),
        (round(x - across_x), round(y + across_y)),
        (round(x + far * (-along_y + along_x)), round(y + far * (along_x + along_y))),
        (round(x + far * (along_y + along_x)), round(y + far * (-along_x + along_y))),
    )
    cv2.fillConvexPoly(mask, np.array(corners, np.int32), 0)
