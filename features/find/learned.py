"""The learned choice: the locator says where hands are, the refiner looks again, trees weigh both."""

from collections.abc import Sequence
from typing import Final

import cv2
import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.candidates import (
    APART_IOU,
    Rows,
    best_distinct,
    candidate_rows,
    describe_places,
    score_pairs,
)
from lightgesture.features.find.locator import Locator, Peaks, find_peaks
from lightgesture.features.find.refiner import Refined, Refiner
from lightgesture.features.find.selector_file import LearnedParts
from lightgesture.features.find.settings import LEARNED, SelectorSettings
from lightgesture.features.find.trees import evaluate
from lightgesture.features.geometry import pairwise_iou, scale_boxes
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import logistic
from lightgesture.features.standardise import channel_tables
from lightgesture.features.types import Box, Candidates, Float, HandRegion

INNER: Final = 0.5
"""Side of the middle of a box, over the box's, whose mean colour stands for the hand's."""
TIGHTER: Final = 0.08
"""By how much of its sides the other extent of a region is smaller: a hand reads more clearly in one or the other."""
HAND_IOU: Final = 0.8
"""Mean IoU of refined boxes with the hands that they are of."""
NO_OUTLINE: Final = np.zeros((0, 2), np.int32)


class Places:
    """Both nets over a frame: places that may be hands, before anything is decided."""

    def __init__(self, locator: IntegerNetwork, refiner: IntegerNetwork) -> None:
        self._locator, self.refiner = Locator(locator), Refiner(refiner)

    def find(self, colour: ColourMap) -> tuple[Peaks, Refined]:
        """Peaks of the locator and what the refiner says of each."""
        tables = channel_tables(colour.picture)
        peaks = find_peaks(self._locator.process(colour.picture, tables))
        return peaks, self.refiner.process(colour, peaks.boxes, tables)


class LearnedSelector:
    """Colour map -> candidates with scores, by locator and refiner."""

    settings: SelectorSettings = LEARNED

    def __init__(self, parts: LearnedParts) -> None:
        self._nets = Places(parts.locator, parts.refiner)
        self._places, self._pairs = parts.places, parts.pairs

    def process(self, colour: ColourMap) -> Candidates:
        """Search the whole frame."""
        peaks, refined = self._nets.find(colour)
        size = colour.picture.shape[1], colour.picture.shape[0]
        scores = evaluate(self._places, describe_places(peaks, refined, size))
        kept, items = scored_places(colour, peaks, refined, scores)
        together = score_pairs(self._pairs, items, size, peaks.face)
        found = regions_at(colour, refined.boxes[kept], scores[kept])
        face = peaks.face
        if face is not None:
            face = face[0] * colour.scale[0], face[1] * colour.scale[1]
        return Candidates(found, together, colour.source_size, face)

    def follow(self, colour: ColourMap, boxes: Sequence[Box]) -> Candidates:
        """Look only at predicted boxes, one or more, source pixels: far quicker than a search, and blind for the rest.

        The refiner alone decides, so a score is what its refined boxes of this logit overlap a hand by on average; that
        of a pair is the lower one.
        """
        scale = np.tile(np.array(colour.scale, np.float32), 2)
        predicted = np.asarray(np.array(boxes, np.float32).reshape(-1, 4) / scale, np.float32)
        refined = self._nets.refiner.process(colour, predicted, channel_tables(colour.picture))
        scores = np.asarray(HAND_IOU * logistic(refined.hand), np.float32)
        overlap = pairwise_iou(refined.boxes, refined.boxes)
        kept = best_distinct(overlap, scores)
        apart = overlap[np.ix_(kept, kept)] <= APART_IOU
        scores = scores[kept]
        together = np.where(apart, np.minimum.outer(scores, scores), 0.0).astype(np.float32)
        return Candidates(regions_at(colour, refined.boxes[kept], scores), together, colour.source_size)


def scored_places(colour: ColourMap, peaks: Peaks, refined: Refined, scores: Float) -> tuple[list[int], Rows]:
    """Numbers of the distinct places, best first, and what their pairs need."""
    kept = best_distinct(pairwise_iou(refined.boxes, refined.boxes), scores)
    boxes = refined.boxes[kept]
    return kept, candidate_rows(
        boxes, scores[kept], peaks.heat[kept], [mean_colour(colour, box) for box in boxes]
    )


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


def regions_at(colour: ColourMap, boxes: Float, scores: Float) -> tuple[HandRegion, ...]:
    """Boxes of the working picture, float32 (n, 4), as regions in source pixels, without outlines.

    scores: float32 (n,). The other extent of each is a little tighter.
    """
    whole = boxes.astype(np.float64)
    low, sides = whole[:, :2], whole[:, 2:]
    tight = np.hstack([low + TIGHTER * sides / 2, (1.0 - TIGHTER) * sides])
    extents = scale_boxes(np.concatenate([whole, tight]), colour.scale, colour.source_size)
    confidences = scores.astype(np.float64).clip(0.0, 1.0).tolist()
    found = [
        HandRegion(box, NO_OUTLINE, None, confidence, (inner,))
        for box, inner, confidence in zip(
            extents[: len(boxes)], extents[len(boxes) :], confidences, strict=True
        )
    ]
    return tuple(found)
