"""Many thresholds instead of one: every connected region of the skin map at every level.

One threshold finds a hand only where its skin is redder than what touches it by the right amount. The
outer contours at all levels are the nodes of the component tree that MSER walks (Matas, Chum, Urban and
Pajdla, "Robust wide-baseline stereo from maximally stable extremal regions", 2002); somewhere along
the tree the hand stands alone.

A forearm is cut off at the wrist. The palm is the largest circle inside the outline. What leaves it downwards beyond
the circle is the forearm, straight or slanted, and gives the arm's direction; the wrist crosses it about one radius
from the palm's centre. Fingers stay out of this because a raised hand has them above its palm.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.geometry import keep_distinct
from lightgesture.features.types import Box, Contour, Image

Point = tuple[float, float]

LEVELS: Final = 24
"""Thresholds over the skin map; 8 lose hands in the dark, and 32 find no more."""
SMALLEST_SIDE: Final = 0.045
"""Of the region's box, as a share of the working picture's shorter side; what is smaller cannot be read."""
LARGEST_SIDE: Final = 0.85
"""As `SMALLEST_SIDE`; what is larger is furniture or a wall."""
SHORTEST_CONTOUR: Final = 16
"""Pixels of outline in the working picture."""
LARGEST_ASPECT: Final = 3.5
"""Longer over shorter side of the box."""
SAME_HUNDREDTHS: Final = 88
"""Boxes whose IoU is more than this, in hundredths, are one proposal."""
MOST: Final = 96
"""Regions kept for the later stages, so that a picture of specks costs a bounded time."""
MOST_LOOKED_AT: Final = 192
"""Regions compared with one another for near-equal ones, of which those of the highest levels count."""
MOST_OUTLINES: Final = 1200
"""Outlines, specks included, after which no lower level is looked at: a picture of noise has thousands at each."""
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

    boxes: int32 (n, 4). points: int32 (m, 2), outlines one after the other, perhaps more than these regions'. starts,
    lengths: int64 (n,), where in `points` each outline begins and how many it has. levels: uint8 (n,), the threshold at
    which each stands alone. cut: bool (n,), True where a forearm was cut off.
    """

    boxes: NDArray[np.int32]
    points: NDArray[np.int32]
    starts: NDArray[np.int64]
    lengths: NDArray[np.int64]
    levels: NDArray[np.uint8]
    cut: NDArray[np.bool_]

    @classmethod
    def of(
        cls, boxes: Sequence[Box], contours: Sequence[Contour], levels: NDArray[np.uint8], cut: bool
    ) -> "Proposals":
        """Regions by their outlines, int32 (k, 2) or (k, 1, 2) each, all or none of them cut."""
        lengths = np.array([len(contour) for contour in contours], np.int64)
        joined = np.concatenate(contours) if contours else np.zeros(0, np.int32)
        return cls(
            np.array(boxes, np.int32).reshape(-1, 4),
            np.asarray(joined, np.int32).reshape(-1, 2),
            lengths.cumsum() - lengths,
            lengths,
            levels,
            np.full(len(contours), cut),
        )

    def __len__(self) -> int:
        return len(self.boxes)

    @property
    def contours(self) -> tuple[Contour, ...]:
        """n arrays int32 (k, 2): the outlines."""
        return tuple(self.contour(number) for number in range(len(self)))

    def contour(self, number: int) -> Contour:
        """One of the outlines, int32 (k, 2)."""
        start = int(self.starts[number])
        return self.points[start : start + int(self.lengths[number])]

    def box(self, number: int) -> Box:
        """One of the boxes."""
        x, y, width, height = self.boxes[number].tolist()
        return x, y, width, height

    def taken(self, numbers: NDArray[np.intp]) -> "Proposals":
        """Some of the regions, in that order."""
        return Proposals(
            self.boxes[numbers],
            self.points,
            self.starts[numbers],
            self.lengths[numbers],
            self.levels[numbers],
            self.cut[numbers],
        )

    def joined(self, others: "Proposals") -> "Proposals":
        """These regions, then others."""
        return Proposals(
            np.concatenate([self.boxes, others.boxes]),
            np.concatenate([self.points, others.points]),
            np.concatenate([self.starts, others.starts + len(self.points)]),
            np.concatenate([self.lengths, others.lengths]),
            np.concatenate([self.levels, others.levels]),
            np.concatenate([self.cut, others.cut]),
        )


def _contours_at(skin: Image, threshold: int) -> tuple[list[Contour], list[Box], int]:
    """Outer contours of the pixels at or above `threshold` whose boxes may hold a hand, as OpenCV gives them, int32 (k,
    1, 2), these boxes, and the number of all outlines."""
    mask = cv2.threshold(skin, threshold - 1, 255, cv2.THRESH_BINARY)[1]
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    shorter = min(skin.shape)
    low, high = SMALLEST_SIDE * shorter, LARGEST_SIDE * shorter
    found: list[Contour] = []
    boxes: list[Box] = []
    for contour in contours:
        if len(contour) < SHORTEST_CONTOUR:
            continue
        box = cv2.boundingRect(contour)
        short, long = (box[2], box[3]) if box[2] < box[3] else (box[3], box[2])
        if low <= short and long <= high and long <= LARGEST_ASPECT * short:
            found.append(contour)  # type: ignore[arg-type]
            boxes.append(box)  # type: ignore[arg-type]
    return found, boxes, len(contours)


Distinct = Callable[[NDArray[np.int32], int], NDArray[np.intp]]
"""(boxes, most) -> numbers of the first `most` boxes, int32 (n, 4), that do not nearly agree with one before."""


def plain_distinct(boxes: NDArray[np.int32], most: int) -> NDArray[np.intp]:
    """A `Distinct` by NumPy."""
    low, high = boxes[:, :2], boxes[:, :2] + boxes[:, 2:]
    sides = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)
    np.maximum(sides, 0, out=sides)
    both = sides[..., 0] * sides[..., 1]
    areas = boxes[:, 2] * boxes[:, 3]
    # both / union > SAME_HUNDREDTHS / 100 in whole numbers.
    same = (100 + SAME_HUNDREDTHS) * both > SAME_HUNDREDTHS * (areas[:, None] + areas)
    return np.array(keep_distinct(same, range(len(boxes)), most), np.intp)


@dataclass(frozen=True, slots=True)
class RegionLoops:
    """What passes over the levels of the skin map, and over boxes.

    whole: (skin, levels) -> `whole_regions`. distinct: see `Distinct`.
    """

    whole: Callable[[Image, int], Proposals]
    distinct: Distinct


def whole_regions(skin: Image, levels: int = LEVELS, loops: RegionLoops | None = None) -> Proposals:
    """Regions of the skin map, uint8 (h, w), at any level that may be hands, forearms and all.

    levels: thresholds over the skin map, 2 to 256; of 2 one alone cuts, in the middle of the range. loops: None for
    `PLAIN`; any gives the same regions.
    """
    return (loops or PLAIN).whole(skin, levels)


def plain_whole(skin: Image, levels: int, distinct: Distinct = plain_distinct) -> Proposals:
    """`RegionLoops.whole` by OpenCV."""
    found: list[Contour] = []
    boxes: list[Box] = []
    thresholds: list[int] = []
    outlines = 0
    for level in range(levels - 1, 0, -1):
        threshold = level * 256 // levels
        contours, sized, count = _contours_at(skin, threshold)
        found += contours
        boxes += sized
        thresholds += [threshold] * len(contours)
        outlines += count
        # The reddest regions come first, so specks at the low levels are what a flood loses.
        if len(found) >= MOST_LOOKED_AT or outlines >= MOST_OUTLINES:
            break
    looked_at = np.array(boxes[:MOST_LOOKED_AT], np.int32).reshape(-1, 4)
    kept = distinct(looked_at, MOST)
    of_levels = np.array(thresholds, np.uint8)[kept]
    return Proposals.of([boxes[index] for index in kept], [found[index] for index in kept], of_levels, False)


PLAIN: Final = RegionLoops(plain_whole, plain_distinct)


def without_forearms(regions: Proposals, numbers: Iterable[int]) -> Proposals:
    """Those of some regions whose forearm can be cut off, without it."""
    hands = {number: cut_forearm(regions.contour(number), regions.box(number)) for number in numbers}
    cut = {number: hand for number, hand in hands.items() if hand is not None}
    boxes = [cv2.boundingRect(hand) for hand in cut.values()]
    return Proposals.of(boxes, list(cut.values()), regions.levels[list(cut)], True)  # type: ignore[arg-type]


def propose(colour: ColourMap, levels: int = LEVELS) -> Proposals:
    """Regions of the skin map that may be hands, and all of them without their forearms where one was found."""
    whole = whole_regions(colour.skin, levels)
    hands = without_forearms(whole, range(len(whole)))
    every = whole.joined(hands)
    return every.taken(plain_distinct(every.boxes[:MOST_LOOKED_AT], MOST))


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
    area = moments["m00"]
    if area < max(LEAST_REMAINDER * cv2.countNonZero(mask), 1.0):
        return None
    across, down = moments["m10"] / area - centre[0], moments["m01"] / area - centre[1] + top
    length = math.hypot(across, down)
    # Rests on both sides of a palm may balance each other: then no arm leaves it.
    return (across / length, down / length) if length > 0.0 else None


def cut_forearm(contour: Contour, box: Box) -> Contour | None:
    """The outline without what lies beyond the wrist, int32 (k, 2); None where the region ends there already."""
    mask = fill_contour(contour, box, border=1)
    centre, radius = palm_circle(mask)
    direction = arm_direction(mask, centre, radius)
    if direction is None:
        return None
    whole = cv2.countNonZero(mask)
    wrist = WRIST_DISTANCE * radius
    _erase_beyond(mask, (centre[0] + wrist * direction[0], centre[1] + wrist * direction[1]), direction)
    if whole - cv2.countNonZero(mask) < LEAST_REMAINDER * whole:
        return None
    # Of the outline in the picture's pixels: the mask begins a pixel before the box.
    parts = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE, offset=(box[0] - 1, box[1] - 1))[
        0
    ]
    largest = max(parts, key=cv2.contourArea, default=None)
    if largest is None or cv2.boundingRect(largest)[3] < LEAST_HEIGHT:
        return None
    return np.asarray(largest, np.int32).reshape(-1, 2)


def _erase_beyond(mask: Image, point: Point, direction: Point) -> None:
    """Set to 0 what lies past the line through `point` across `direction`."""
    (x, y), (along_x, along_y) = point, direction
    far = float(sum(mask.shape))
    corners = np.array(
        [
            (round(x + far * step_x), round(y + far * step_y))
            for step_x, step_y in (
                (along_y, -along_x),
                (-along_y, along_x),
                (-along_y + along_x, along_x + along_y),
                (along_y + along_x, -along_x + along_y),
            )
        ],
        np.int32,
    )
    cv2.fillConvexPoly(mask, corners, 0)
