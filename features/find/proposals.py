"""Many thresholds instead of one: every connected region of the skin map at every level.

One threshold finds a hand only where its skin is redder than what touches it by the right amount. The
outer contours at all levels are the nodes of the component tree that MSER walks (Matas, Chum, Urban and
Pajdla, "Robust wide-baseline stereo from maximally stable extremal regions", 2002); somewhere along
the tree the hand stands alone.

A forearm is cut off at the wrist. The palm is the largest circle inside the outline. What leaves it downwards beyond
the circle is the forearm, straight or slanted, and gives the arm's direction; the wrist crosses it about one radius
from the palm's centre. Fingers stay out of this because a raised hand has them above its palm.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.geometry import keep_distinct, pairwise_iou
from lightgesture.features.types import Box, Contour, Image

Point = NDArray[np.float64]

LEVELS: Final = 32
"""Thresholds over the skin map; 32 is the knee, 8 lose hands in the dark."""
SMALLEST_SIDE: Final = 0.045
"""Of the region's box, as a share of the working picture's shorter side; what is smaller cannot be read."""
LARGEST_SIDE: Final = 0.85
"""As `SMALLEST_SIDE`; what is larger is furniture or a wall."""
SHORTEST_CONTOUR: Final = 16
"""Pixels of outline in the working picture."""
LARGEST_ASPECT: Final = 3.5
"""Longer over shorter side of the box."""
SAME_IOU: Final = 0.88
"""Boxes that overlap more than this are one proposal."""
MOST: Final = 160
"""Regions kept for the later stages, so that a picture of specks costs a bounded time."""
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


@dataclass(frozen=True, slots=True, eq=False)
class Proposals:
    """Regions of one frame in pixels of the working picture.

    boxes: int32 (n, 4). contours: n arrays int32 (k, 2). levels: uint8 (n,), the threshold at which
    each stands alone. cut: bool (n,), True where a forearm was cut off.
    """

    boxes: NDArray[np.int32]
    contours: tuple[Contour, ...]
    levels: NDArray[np.uint8]
    cut: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.contours)


def _contours_at(skin: Image, threshold: int) -> list[Contour]:
    """Outer contours of the pixels at or above `threshold` whose boxes may hold a hand."""
    mask = cv2.threshold(skin, threshold - 1, 255, cv2.THRESH_BINARY)[1]
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    shorter = min(skin.shape)
    low, high = SMALLEST_SIDE * shorter, LARGEST_SIDE * shorter
    found = []
    for contour in contours:
        if len(contour) < SHORTEST_CONTOUR:
            continue
        short, long = sorted(cv2.boundingRect(contour)[2:])
        if low <= short and long <= high and long <= LARGEST_ASPECT * short:
            found.append(contour.reshape(-1, 2).astype(np.int32, copy=False))
    return found


def _distinct(contours: list[Contour], levels: list[int], cut: list[bool]) -> Proposals:
    """The first of each group of regions whose boxes nearly agree, as many as are wanted."""
    boxes = np.array([cv2.boundingRect(contour) for contour in contours], np.int32).reshape(-1, 4)
    same = pairwise_iou(boxes, boxes) > SAME_IOU
    kept = keep_distinct(same, range(len(contours)), MOST)
    return Proposals(
        boxes=boxes[kept],
        contours=tuple(contours[index] for index in kept),
        levels=np.array(levels, np.uint8)[kept],
        cut=np.array(cut, bool)[kept],
    )


def propose(colour: ColourMap, levels: int = LEVELS) -> Proposals:
    """Regions of the skin map that may be hands, without their forearms where one was found.

    levels: thresholds over the skin map, 2 to 256; of 2 one alone cuts, in the middle of the range.
    """
    found: list[Contour] = []
    thresholds: list[int] = []
    for level in range(levels - 1, 0, -1):
        threshold = level * 256 // levels
        found += _contours_at(colour.skin, threshold)
        thresholds += [threshold] * (len(found) - len(thresholds))
        # The reddest regions come first, so specks at the low levels are what a flood loses.
        if len(found) >= 4 * MOST:
            break
    whole = _distinct(found, thresholds, [False] * len(found))
    contours, thresholds = list(whole.contours), whole.levels.tolist()
    for contour, (x, y, width, height), threshold in zip(
        whole.contours, whole.boxes.tolist(), whole.levels.tolist(), strict=True
    ):
        hand = cut_forearm(contour, (x, y, width, height))
        if hand is not None:
            contours.append(hand)
            thresholds.append(threshold)
    return _distinct(contours, thresholds, [index >= len(whole) for index in range(len(contours))])


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
    """Unit vector (x, y) from the palm's centre along the forearm, float64 (2,); None where there is none.

    Enlarged and mirrored: with the mask. It looks downwards alone, so it does not follow a turn by more than about 60
    degrees.
    """
    top = int(centre[1] + ARM_TOP * radius)
    if top >= len(mask):
        return None
    arm = mask[top:].copy()
    cv2.circle(arm, (centre[0], centre[1] - top), round(ARM_RING * radius), 0, cv2.FILLED)
    moments = cv2.moments(arm, binaryImage=True)
    if moments["m00"] < max(LEAST_REMAINDER * cv2.countNonZero(mask), 1.0):
        return None
    towards = np.array([moments["m10"], moments["m01"]]) / moments["m00"] - np.array(centre) + (0, top)
    length = float(np.hypot(*towards))
    # Rests on both sides of a palm may balance each other: then no arm leaves it.
    return np.asarray(towards / length, np.float64) if length > 0.0 else None


def cut_forearm(contour: Contour, box: Box) -> Contour | None:
    """The outline without what lies beyond the wrist, int32 (k, 2); None where the region ends there already."""
    mask = fill_contour(contour, box, border=1)
    centre, radius = palm_circle(mask)
    direction = arm_direction(mask, centre, radius)
    if direction is None:
        return None
    whole = cv2.countNonZero(mask)
    _erase_beyond(mask, np.array(centre) + WRIST_DISTANCE * radius * direction, direction)
    parts = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    if not parts or whole - cv2.countNonZero(mask) < LEAST_REMAINDER * whole:
        return None
    largest = max(parts, key=cv2.contourArea)
    if cv2.boundingRect(largest)[3] < LEAST_HEIGHT:
        return None
    return np.asarray(largest.reshape(-1, 2) + np.array([box[0] - 1, box[1] - 1]), np.int32)


def _erase_beyond(mask: Image, point: Point, direction: Point) -> None:
    """Set to 0 what lies past the line through `point` across `direction`."""
    far = float(sum(mask.shape))
    across = np.array([-direction[1], direction[0]]) * far
    onwards = direction * far
    corners = np.rint([point - across, point + across, point + across + onwards, point - across + onwards])
    cv2.fillConvexPoly(mask, corners.astype(np.int32), 0)
