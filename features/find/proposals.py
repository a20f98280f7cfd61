"""Many thresholds instead of one: every connected region of the skin map at every level.

One threshold finds a hand only where its skin is redder than what touches it by the right amount. The
outer contours at all levels are the nodes of the component tree that MSER walks (Matas, Chum, Urban and
Pajdla, "Robust wide-baseline stereo from maximally stable extremal regions", 2002); somewhere along
the tree the hand stands alone.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.geometry import keep_distinct, pairwise_iou
from lightgesture.features.outline.wrist import WristSettings, cut_forearm
from lightgesture.features.types import Box, Image


@dataclass(frozen=True, slots=True)
class ProposalSettings:
    """Which regions are proposed.

    levels: thresholds over the skin map, 8 to 64; 32 is the knee, 8 lose hands in the dark.
    smallest_side, largest_side: of the region's box, as a share of the working picture's shorter side;
        what is smaller cannot be read, what is larger is furniture or a wall.
    shortest_contour: pixels of outline in the working picture.
    largest_aspect: longer over shorter side of the box.
    same_iou: boxes that overlap more than this are one proposal, 0.5 to 1.
    most: regions kept for the later stages, so that a picture of specks costs a bounded time.
    """

    levels: int = 32
    smallest_side: float = 0.045
    largest_side: float = 0.85
    shortest_contour: int = 16
    largest_aspect: float = 3.5
    same_iou: float = 0.88
    most: int = 160


@dataclass(frozen=True, slots=True, eq=False)
class Proposals:
    """Regions of one frame in pixels of the working picture.

    boxes: int32 (n, 4). contours: n arrays int32 (k, 2). levels: uint8 (n,), the threshold at which
    each stands alone. cut: bool (n,), True where a forearm was cut off.
    """

    boxes: NDArray[np.int32]
    contours: tuple[NDArray[np.int32], ...]
    levels: NDArray[np.uint8]
    cut: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.contours)


@dataclass(frozen=True, slots=True, eq=False)
class _Region:
    box: Box
    contour: NDArray[np.int32]
    level: int
    cut: bool


def _regions_at(skin: Image, threshold: int, settings: ProposalSettings) -> list[_Region]:
    """Outer contours of the pixels at or above `threshold` whose boxes may hold a hand."""
    mask = cv2.threshold(skin, threshold - 1, 255, cv2.THRESH_BINARY)[1]
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    shorter = min(skin.shape)
    low, high = settings.smallest_side * shorter, settings.largest_side * shorter
    regions = []
    for contour in contours:
        if len(contour) < settings.shortest_contour:
            continue
        box = cv2.boundingRect(contour)
        short, long = min(box[2], box[3]), max(box[2], box[3])
        if low <= short and long <= high and long <= settings.largest_aspect * short:
            points = contour.reshape(-1, 2).astype(np.int32, copy=False)
            regions.append(_Region((box[0], box[1], box[2], box[3]), points, threshold, cut=False))
    return regions


def _distinct(regions: list[_Region], settings: ProposalSettings) -> list[_Region]:
    """Keep the first of each group of regions whose boxes nearly agree, as many as are wanted."""
    boxes = np.array([region.box for region in regions], np.int32).reshape(-1, 4)
    same = pairwise_iou(boxes, boxes) > settings.same_iou
    return [regions[index] for index in keep_distinct(same, range(len(regions)), settings.most)]


def propose(
    colour: ColourMap,
    settings: ProposalSettings | None = None,
    wrist: WristSettings | None = None,
) -> Proposals:
    """Regions of the skin map that may be hands, without their forearms where one was found."""
    settings = settings or ProposalSettings()
    wrist = wrist or WristSettings()
    found: list[_Region] = []
    for level in range(settings.levels - 1, 0, -1):
        found += _regions_at(colour.skin, level * 256 // settings.levels, settings)
        # The reddest regions come first, so specks at the low levels are what a flood loses.
        if len(found) >= 4 * settings.most:
            break
    whole = _distinct(found, settings)
    hands = []
    for region in whole:
        contour = cut_forearm(region.contour, region.box, wrist)
        if contour is not None:
            x, y, width, height = cv2.boundingRect(contour)
            hands.append(_Region((x, y, width, height), contour, region.level, cut=True))
    regions = _distinct(whole + hands, settings)
    return Proposals(
        boxes=np.array([region.box for region in regions], np.int32).reshape(-1, 4),
        contours=tuple(region.contour for region in regions),
        levels=np.array([region.level for region in regions], np.uint8),
        cut=np.array([region.cut for region in regions], bool),
    )
