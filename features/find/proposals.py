"""Many thresholds instead of one: every connected region of the skin map at every level.

One threshold finds a hand only where its skin is redder than what touches it by the right amount. The
outer contours at all levels are the nodes of the component tree that MSER walks (Matas, Chum, Urban and
Pajdla, "Robust wide-baseline stereo from maximally stable extremal regions", 2002); somewhere along
the tree the hand stands alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.forearms import cut_forearm, fill_contour
from lightgesture.features.geometry import keep_distinct, pairwise_iou
from lightgesture.features.types import Box, Contour, Image

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
        starts, ends = self.starts.tolist(), (self.starts + self.lengths).tolist()
        return tuple(self.points[start:end] for start, end in zip(starts, ends, strict=True))

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
    sides = []
    for begin, length in ((boxes[:, 0], boxes[:, 2]), (boxes[:, 1], boxes[:, 3])):
        end = begin + length
        side = np.minimum(end[:, None], end)
        side -= np.maximum(begin[:, None], begin)
        sides.append(np.maximum(side, 0, out=side))
    both = sides[0] * sides[1]
    areas = boxes[:, 2] * boxes[:, 3]
    # both / union > SAME_HUNDREDTHS / 100 in whole numbers.
    same = (100 + SAME_HUNDREDTHS) * both > SAME_HUNDREDTHS * (areas[:, None] + areas)
    return np.array(keep_distinct(same, range(len(boxes)), most), np.intp)


@dataclass(frozen=True, slots=True)
class RegionLoops:
    """What passes over the levels of the skin map, over boxes and over the pixels of regions.

    whole: (skin, levels) -> `whole_regions`. distinct: see `Distinct`. forearms: regions -> `without_forearms`.
    overlaps: boxes -> float64 (n, n), IoU of every two. colours: (picture, regions) -> float64 (n, 3), mean blue, green
        and red inside each outline, 0 to 255.
    """

    whole: Callable[[Image, int], Proposals]
    distinct: Distinct
    forearms: Callable[[Proposals], Proposals]
    overlaps: Callable[[NDArray[np.int32]], NDArray[np.float64]]
    colours: Callable[[Image, Proposals], NDArray[np.float64]]


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


def without_forearms(regions: Proposals, loops: RegionLoops | None = None) -> Proposals:
    """Those of the regions whose forearm can be cut off, without it. loops: None for `PLAIN`."""
    return (loops or PLAIN).forearms(regions)


def plain_forearms(regions: Proposals) -> Proposals:
    """`RegionLoops.forearms` by OpenCV."""
    hands = [cut_forearm(regions.contour(number), regions.box(number)) for number in range(len(regions))]
    cut = [number for number, hand in enumerate(hands) if hand is not None]
    left = [hand for hand in hands if hand is not None]
    return Proposals.of([cv2.boundingRect(hand) for hand in left], left, regions.levels[cut], True)  # type: ignore[misc]


def _plain_overlaps(boxes: NDArray[np.int32]) -> NDArray[np.float64]:
    return pairwise_iou(boxes, boxes)


def _plain_colours(picture: Image, regions: Proposals) -> NDArray[np.float64]:
    means = np.empty((len(regions), 3))
    for number in range(len(regions)):
        x, y, width, height = box = regions.box(number)
        mask = fill_contour(regions.contour(number), box)
        means[number] = cv2.mean(picture[y : y + height, x : x + width], mask)[:3]
    return means


PLAIN: Final = RegionLoops(plain_whole, plain_distinct, plain_forearms, _plain_overlaps, _plain_colours)


def propose(colour: ColourMap, levels: int = LEVELS) -> Proposals:
    """Regions of the skin map that may be hands, and all of them without their forearms where one was found."""
    whole = whole_regions(colour.skin, levels)
    hands = without_forearms(whole)
    every = whole.joined(hands)
    return every.taken(plain_distinct(every.boxes[:MOST_LOOKED_AT], MOST))
