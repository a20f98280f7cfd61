"""The learned choice: the locator says where hands are, the refiner looks again, trees weigh both."""

import math
from collections.abc import Sequence
from itertools import combinations
from operator import itemgetter
from typing import Final

import cv2
import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.candidates import (
    APART_IOU,
    DISTINCT_IOU,
    LEAST_SCORE,
    Rows,
    best_distinct,
    candidate_rows,
    describe_places,
    score_pairs,
)
from lightgesture.features.find.locator import INPUT as LOCATOR_INPUT
from lightgesture.features.find.locator import Locator, Peaks, find_peaks
from lightgesture.features.find.refiner import INPUT as REFINER_INPUT
from lightgesture.features.find.refiner import Rectangle, Refined, Refiner
from lightgesture.features.find.selector_file import LearnedParts
from lightgesture.features.find.settings import LEARNED, SelectorSettings
from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.find.verifier import Verifier
from lightgesture.features.geometry import box_iou, pairwise_iou, whole_box
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.types import Box, Candidates, Float, HandRegion, Image

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
        # As trained here both see colours by the same integers, which are then made once.
        self._is_alike = locator.quantisation[LOCATOR_INPUT] == refiner.quantisation[REFINER_INPUT]

    def find(self, colour: ColourMap) -> tuple[Peaks, Refined]:
        """Peaks of the locator and what the refiner says of each."""
        tables = self._locator.table(colour.picture)
        peaks = find_peaks(self._locator.process(colour, tables))
        if not self._is_alike:
            tables = self.refiner.table(colour.picture)
        return peaks, self.refiner.process(colour, peaks.boxes, tables)


class PlaceScorer:
    """How likely places are hands, by all that is known of them."""

    def __init__(self, places: Trees, verifier: IntegerNetwork | None) -> None:
        """verifier: None for a file of before, whose trees have the last word."""
        self._places = places
        self._verifier = None if verifier is None else Verifier(verifier)

    def process(self, colour: ColourMap, peaks: Peaks, refined: Refined) -> Float:
        """Predicted IoU of each refined box with a hand, float32 (n,), about 0 to 1."""
        size = colour.picture.shape[1], colour.picture.shape[0]
        scores = evaluate(self._places, describe_places(peaks, refined, size))
        return scores if self._verifier is None else self._verifier.process(colour, refined.boxes, scores)


class LearnedSelector:
    """Colour map -> candidates with scores, by locator and refiner."""

    settings: SelectorSettings = LEARNED

    def __init__(self, parts: LearnedParts) -> None:
        self._nets = Places(parts.locator, parts.refiner)
        self._scorer = PlaceScorer(parts.places, parts.verifier)
        self._pairs = parts.pairs

    def process(self, colour: ColourMap) -> Candidates:
        """Search the whole frame."""
        peaks, refined = self._nets.find(colour)
        size = colour.picture.shape[1], colour.picture.shape[0]
        scores = self._scorer.process(colour, peaks, refined)
        kept, items = scored_places(colour, peaks, refined, scores)
        together = score_pairs(self._pairs, items, size, peaks.face)
        found = regions_at(colour, refined.boxes[kept], scores[kept])
        face = peaks.face
        if face is not None:
            face = face[0] * colour.scale[0], face[1] * colour.scale[1]
        return Candidates(found, together, colour.source_size, face)

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates:
        """Look only at boxes of a frame, one or more, source pixels: far quicker than a search, and blind for the rest.

        The refiner alone decides, so a score is what its refined boxes of this logit overlap a hand by on average; that
        of a pair is the lower one. Few boxes: the calls on arrays would take longer than the numbers.
        """
        size = image.shape[1], image.shape[0]
        found, hand = self._nets.refiner.look(image, boxes)
        scored = sorted(
            (
                (score := HAND_IOU * _chance(logit), region_at(box, size, score))
                for box, logit in zip(found, hand, strict=True)
            ),
            key=itemgetter(0),
            reverse=True,
        )
        kept: list[tuple[float, HandRegion]] = []
        for score, region in scored:
            if score >= LEAST_SCORE and all(
                box_iou(region.box, other.box) < DISTINCT_IOU for _, other in kept
            ):
                kept.append((score, region))
        together = np.zeros((len(kept), len(kept)), np.float32)
        for (first, (_, one)), (second, (score, other)) in combinations(enumerate(kept), 2):
            if box_iou(one.box, other.box) <= APART_IOU:
                together[first, second] = together[second, first] = score
        return Candidates(tuple(region for _, region in kept), together, size)


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

    scores: float32 (n,).
    """
    across, down = colour.scale
    found = []
    for (x, y, width, height), score in zip(boxes.tolist(), scores.tolist(), strict=True):
        place = x * across, y * down, width * across, height * down
        found.append(region_at(place, colour.source_size, min(max(score, 0.0), 1.0)))
    return tuple(found)


def region_at(place: Rectangle, size: tuple[int, int], confidence: float = 0.0) -> HandRegion:
    """A place in a frame of `size` (width, height) as a region; its other extent is a little tighter."""
    x, y, width, height = place
    in_x, in_y = TIGHTER * width / 2, TIGHTER * height / 2
    inner = x + in_x, y + in_y, width - 2 * in_x, height - 2 * in_y
    return HandRegion(whole_box(place, size), NO_OUTLINE, None, confidence, (whole_box(inner, size),))


def _chance(logit: float) -> float:
    """1 / (1 + exp(-logit)), of any logit that eight bits can stand for."""
    return 1.0 / (1.0 + math.exp(-logit))
