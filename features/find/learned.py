"""The learned choice: the locator says where hands are, the refiner looks again, trees weigh both."""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.choice import Refined, describe_places
from lightgesture.features.find.locator import Locator
from lightgesture.features.find.pairs import Candidate, score_pairs
from lightgesture.features.find.peaks import Peaks, PeakSettings, find_peaks, logistic
from lightgesture.features.find.refiner import Refiner
from lightgesture.features.find.selector_file import LearnedParts
from lightgesture.features.find.settings import LEARNED, SelectorSettings
from lightgesture.features.find.trees import evaluate
from lightgesture.features.geometry import best_distinct, pairwise_iou, scale_box
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.standardise import Float, channel_tables
from lightgesture.features.types import Box, Candidates, HandRegion

INNER = 0.5
"""Side of the middle of a box, over the box's, whose mean colour stands for the hand's."""
TIGHTER = 0.08
"""By how much of its sides the other extent of a region is smaller: a hand reads more clearly in one or the other."""
HAND_IOU = 0.8
"""Mean IoU of refined boxes with the hands that they are of."""
NO_OUTLINE = np.zeros((0, 2), np.int32)


class Places:
    """Both nets over a frame: places that may be hands, before anything is decided."""

    def __init__(
        self, locator: IntegerNetwork, refiner: IntegerNetwork, settings: PeakSettings | None = None
    ) -> None:
        self._locator, self._refiner = Locator(locator), Refiner(refiner)
        self._settings = settings or PeakSettings()

    def find(self, colour: ColourMap) -> tuple[Peaks, Refined]:
        """Peaks of the locator and what the refiner says of each."""
        tables = channel_tables(colour.picture)
        peaks = find_peaks(self._locator.process(colour.picture, tables), self._settings)
        return peaks, self._refiner.process(colour.detail, colour.detail_scale, peaks.boxes, tables)

    def look_at(self, colour: ColourMap, boxes: Float) -> Refined:
        """What the refiner says of boxes in working pixels, without a search."""
        tables = channel_tables(colour.picture)
        return self._refiner.process(colour.detail, colour.detail_scale, boxes, tables)


class LearnedSelector:
    """Colour map -> candidates with scores, by locator and refiner."""

    def __init__(
        self, parts: LearnedParts, settings: SelectorSettings = LEARNED, peaks: PeakSettings | None = None
    ) -> None:
        self._nets = Places(parts.locator, parts.refiner, peaks)
        self._places, self._pairs, self._settings = parts.places, parts.pairs, settings

    def process(self, colour: ColourMap) -> Candidates:
        """Search the whole frame."""
        peaks, refined = self._nets.find(colour)
        size = colour.picture.shape[1], colour.picture.shape[0]
        scores = evaluate(self._places, describe_places(peaks, refined, size))
        items = candidates_of(colour, peaks, refined, scores, self._settings)
        together = score_pairs(self._pairs, items, size, peaks.face, self._settings.apart_iou)
        face = None if peaks.face is None else scaled_point(peaks.face, colour.scale)
        return Candidates(
            tuple(region(colour, item.box, item.score) for item in items), together, colour.source_size, face
        )

    def follow(self, colour: ColourMap, boxes: Sequence[Box]) -> Candidates:
        """Look only at predicted boxes, source pixels: far quicker than a search, and blind for what is elsewhere.

        The refiner alone decides, so a score is what its refined boxes of this logit overlap a hand by on average; that
        of a pair is the lower one.
        """
        scale = np.tile(np.array(colour.scale, np.float32), 2)
        predicted = np.asarray(np.array(boxes, np.float32).reshape(-1, 4) / scale, np.float32)
        refined = self._nets.look_at(colour, predicted)
        scores = np.float32(HAND_IOU) * logistic(refined.hand)
        kept = best_distinct(refined.boxes, scores, self._settings)
        own = refined.boxes[kept]
        apart = pairwise_iou(own, own) <= self._settings.apart_iou
        together = np.where(apart, np.minimum.outer(scores[kept], scores[kept]), 0.0).astype(np.float32)
        regions = tuple(region(colour, refined.boxes[index], float(scores[index])) for index in kept)
        return Candidates(regions, together, colour.source_size)


def candidates_of(
    colour: ColourMap, peaks: Peaks, refined: Refined, scores: Float, settings: SelectorSettings
) -> list[Candidate]:
    """The distinct places, best first, with what their pairs need."""
    return [
        Candidate(
            refined.boxes[index],
            float(scores[index]),
            float(peaks.heat[index]),
            mean_colour(colour, refined.boxes[index]),
        )
        for index in best_distinct(refined.boxes, scores, settings)
    ]


def scaled_point(point: tuple[float, float], scale: tuple[float, float]) -> tuple[float, float]:
    """A point of the working picture in source pixels."""
    return point[0] * scale[0], point[1] * scale[1]


def mean_colour(colour: ColourMap, box: Float) -> Float:
    """float32 (3,): mean blue, green and red in the middle of a box, 0 to 1; zeros outside the picture."""
    height, width = colour.picture.shape[:2]
    x, y = box[:2] + box[2:] * (1.0 - INNER) / 2
    left, top = max(int(x), 0), max(int(y), 0)
    right = min(int(x + INNER * box[2]) + 1, width)
    bottom = min(int(y + INNER * box[3]) + 1, height)
    if right <= left or bottom <= top:
        return np.zeros(3, np.float32)
    means = cv2.mean(colour.picture[top:bottom, left:right])[:3]
    return np.array(means, np.float32) / np.float32(255.0)


def region(colour: ColourMap, box: Float, score: float) -> HandRegion:
    """A box of the working picture as a region in source pixels, without outline."""
    left, top, width, height = (float(value) for value in box)
    inner = (
        left + TIGHTER * width / 2,
        top + TIGHTER * height / 2,
        (1.0 - TIGHTER) * width,
        (1.0 - TIGHTER) * height,
    )
    boxes = [scale_box(one, colour.scale, colour.source_size) for one in ((left, top, width, height), inner)]
    return HandRegion(boxes[0], NO_OUTLINE, None, float(np.clip(score, 0.0, 1.0)), (boxes[1],))
