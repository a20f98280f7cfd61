"""The classical choice: regions of many thresholds, scored by trees on what the picture looks like there.

No net: channels of the picture averaged over a grid, the outline's numbers and its nearness to the bank of hand
contours. Selected by `--selector classical`, and the baseline of every table.
"""

from collections.abc import Sequence
from typing import Final

import cv2
import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.find import cells
from lightgesture.features.find.bank import OTHER, Bank, bank_distances, hand_proximity
from lightgesture.features.find.candidates import Rows, best_distinct, candidate_rows, score_pairs
from lightgesture.features.find.proposals import Proposals, fill_contour, propose
from lightgesture.features.find.selector_file import BANK_NUMBERS, ClassicalParts
from lightgesture.features.find.settings import CLASSICAL, SelectorSettings
from lightgesture.features.find.trees import evaluate
from lightgesture.features.geometry import pairwise_iou, scale_boxes
from lightgesture.features.types import Box, Candidates, Float, HandRegion, Image

COLUMNS: Final = cells.COLUMNS + BANK_NUMBERS
"""Numbers of one region."""
ALTERNATIVES: Final = 3
"""Most other extents kept with a candidate; each is one more patch to read."""
ALTERNATIVE_IOU: Final = 0.35
"""Least overlap of another extent with the candidate."""


def describe_regions(colour: ColourMap, proposals: Proposals, bank: Bank) -> Float:
    """float32 (n, COLUMNS): what the picture looks like there, then how near the outline is to the bank's hands, and
    how much nearer than to other things."""
    if not len(proposals):
        return np.zeros((0, COLUMNS), np.float32)
    distances = bank_distances(proposals.contours, bank)
    hands = np.delete(distances, bank.classes.index(OTHER), axis=1).min(axis=1)
    numbers = cells.describe(colour, proposals), hands, hand_proximity(distances, bank)
    return np.column_stack(numbers).astype(np.float32)


def mean_colour(colour: ColourMap, proposals: Proposals, index: int) -> Float:
    """float32 (3,): mean blue, green and red inside the outline of a proposal, 0 to 1."""
    x, y, width, height = (int(value) for value in proposals.boxes[index])
    mask = fill_contour(proposals.contours[index], (x, y, width, height))
    means = cv2.mean(colour.picture[y : y + height, x : x + width], mask)[:3]
    return np.array(means, np.float32) / np.float32(255.0)


def scored_candidates(colour: ColourMap, proposals: Proposals, scores: Float) -> tuple[list[int], Rows]:
    """Numbers of the proposals that go on to pairing, and what their pairs need."""
    kept = best_distinct(pairwise_iou(proposals.boxes, proposals.boxes), scores)
    colours = [mean_colour(colour, proposals, index) for index in kept]
    return kept, candidate_rows(proposals.boxes[kept], scores[kept], proposals.levels[kept], colours)


def other_extents(proposals: Proposals, scores: Float, kept: Sequence[int]) -> list[list[int]]:
    """For each kept proposal the best of the others that overlap it most among the kept."""
    if not kept:
        return []
    overlap = pairwise_iou(proposals.boxes, proposals.boxes[kept])
    nearest = overlap.argmax(axis=1)
    order = np.argsort(-scores, kind="stable")
    near_enough = overlap.max(axis=1) >= ALTERNATIVE_IOU
    return [
        [int(i) for i in order if near_enough[i] and nearest[i] == place and i != index][:ALTERNATIVES]
        for place, index in enumerate(kept)
    ]


def _region(
    colour: ColourMap, proposals: Proposals, index: int, score: float, extents: Sequence[int]
) -> HandRegion:
    """A proposal in source pixels."""
    boxes = scale_boxes(proposals.boxes[[index, *extents]], colour.scale, colour.source_size)
    contour = np.rint((proposals.contours[index] + 0.5) * np.array(colour.scale)).astype(np.int32)
    return HandRegion(boxes[0], contour, None, float(np.clip(score, 0.0, 1.0)), tuple(boxes[1:]))


class ClassicalSelector:
    """Colour map -> candidates with scores, by trees on regions of the skin map."""

    settings: SelectorSettings = CLASSICAL

    def __init__(self, parts: ClassicalParts) -> None:
        self._parts = parts

    def process(self, colour: ColourMap) -> Candidates:
        """Score the regions of one frame. A frame without contrast gives no candidates."""
        proposals = propose(colour)
        if not len(proposals):
            return Candidates((), np.zeros((0, 0), np.float32), colour.source_size)
        scores = evaluate(self._parts.regions, describe_regions(colour, proposals, self._parts.bank))
        kept, items = scored_candidates(colour, proposals, scores)
        height, width = colour.picture.shape[:2]
        together = score_pairs(self._parts.pairs, items, (width, height), None)
        regions = tuple(
            _region(colour, proposals, index, float(scores[index]), extents)
            for index, extents in zip(kept, other_extents(proposals, scores, kept), strict=True)
        )
        return Candidates(regions, together, colour.source_size)

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates | None:
        """None: this choice cannot but search."""
        del image, boxes
        return None
