"""Choosing the hands among the proposals: a score for each region, a score for each pair, refusal.

Single regions are scored by what they look like; two of them by whether they look like the hands of one
person. A pair that agrees is believed at a lower score than a region alone: a red box on a table looks
like a hand, but seldom has a partner of its size at its height.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.cells import describe
from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.geometry import mirror_box, pairwise_iou, scale_box
from lightgesture.features.pairs import COLUMNS, Candidate, candidate, describe_pair
from lightgesture.features.proposals import Proposals, propose
from lightgesture.features.selector_file import Selector, load_selector
from lightgesture.features.trees import evaluate
from lightgesture.features.types import Box, Candidates, HandRegion, Image, Side


@dataclass(frozen=True, slots=True)
class SelectorSettings:
    """When a region counts as a hand. Scores are predicted overlaps (IoU) with a hand, 0 to 1.

    candidates: regions kept for pairing, 2 to 12; the time for pairs grows with the square.
    distinct_iou: candidates overlap at most this much.
    alternatives: most other extents kept with a candidate, 0 to 4; each is one more patch to read.
    alternative_iou: least overlap of another extent with the candidate.
    apart_iou: the two hands of a pair overlap at most this much.
    pair_score: least score of a pair. Lower finds more hands and more that are none.
    single_score: least score of a region without a partner.
    alone_confidence: factor on the confidence of a single hand, whose side is a guess.
    """

    candidates: int = 8
    distinct_iou: float = 0.3
    alternatives: int = 3
    alternative_iou: float = 0.35
    apart_iou: float = 0.1
    pair_score: float = 0.2
    single_score: float = 0.5
    alone_confidence: float = 0.8


def _best(proposals: Proposals, scores: NDArray[np.float32], settings: SelectorSettings) -> list[int]:
    """Proposals of the highest scores that do not overlap a better one."""
    overlap = pairwise_iou(proposals.boxes, proposals.boxes)
    kept: list[int] = []
    for index in np.argsort(-scores, kind="stable"):
        if all(overlap[index, other] < settings.distinct_iou for other in kept):
            kept.append(int(index))
            if len(kept) == settings.candidates:
                break
    return kept


def pair_numbers(
    candidates: Sequence[Candidate], size: tuple[int, int], apart_iou: float
) -> tuple[list[tuple[int, int]], NDArray[np.float32]]:
    """All pairs of candidates that lie apart, and their numbers, float32 (pairs, 15)."""
    boxes = np.array([item.box for item in candidates]).reshape(-1, 4)
    overlap = pairwise_iou(boxes, boxes)
    count = len(candidates)
    pairs = [(i, j) for i in range(count) for j in range(i + 1, count) if overlap[i, j] <= apart_iou]
    rows = [describe_pair(candidates[i], candidates[j], size) for i, j in pairs]
    return pairs, np.array(rows, np.float32).reshape(len(pairs), COLUMNS)


def scored_candidates(
    colour: ColourMap, proposals: Proposals, scores: NDArray[np.float32], settings: SelectorSettings
) -> tuple[list[int], list[Candidate]]:
    """Numbers of the proposals that go on to pairing, and what their pairs need."""
    kept = _best(proposals, scores, settings)
    return kept, [candidate(colour, proposals, index, float(scores[index])) for index in kept]


def _alternatives(
    proposals: Proposals, scores: NDArray[np.float32], kept: Sequence[int], settings: SelectorSettings
) -> list[list[int]]:
    """For each kept proposal the best of the others that overlap it most among the kept."""
    overlap = pairwise_iou(proposals.boxes, proposals.boxes[kept])
    nearest = overlap.argmax(axis=1)
    order = np.argsort(-scores, kind="stable")
    near_enough = overlap.max(axis=1) >= settings.alternative_iou
    return [
        [int(i) for i in order if near_enough[i] and nearest[i] == place and i != index][
            : settings.alternatives
        ]
        for place, index in enumerate(kept)
    ]


def _region(
    colour: ColourMap, proposals: Proposals, index: int, score: float, extents: Sequence[int]
) -> HandRegion:
    """A proposal in source pixels."""

    def box_of(number: int) -> Box:
        x, y, width, height = (int(value) for value in proposals.boxes[number])
        return scale_box((x, y, width, height), colour.scale, colour.source_size)

    contour = np.rint((proposals.contours[index] + 0.5) * np.array(colour.scale)).astype(np.int32)
    confidence = float(np.clip(score, 0.0, 1.0))
    return HandRegion(box_of(index), contour, None, confidence, tuple(box_of(number) for number in extents))


class RegionStage:
    """Colour map -> candidates with scores."""

    def __init__(self, selector: Selector | None = None, settings: SelectorSettings | None = None) -> None:
        self._selector = selector or load_selector()
        self.settings = settings or SelectorSettings()

    def process(self, colour: ColourMap) -> Candidates:
        """Score the regions of one frame. A frame without contrast gives no candidates."""
        proposals = propose(colour)
        if not len(proposals):
            return Candidates((), np.zeros((0, 0), np.float32), colour.source_size)
        scores = evaluate(self._selector.regions, describe(colour, proposals))
        kept, items = scored_candidates(colour, proposals, scores, self.settings)
        height, width = colour.skin.shape
        pairs, rows = pair_numbers(items, (width, height), self.settings.apart_iou)
        together = np.zeros((len(kept), len(kept)), np.float32)
        if pairs:
            first, second = np.array(pairs).T
            together[first, second] = evaluate(self._selector.pairs, rows).clip(0.0, 1.0)
            together = np.maximum(together, together.T)
        others = _alternatives(proposals, scores, kept, self.settings)
        regions = tuple(
            _region(colour, proposals, index, float(scores[index]), extents)
            for index, extents in zip(kept, others, strict=True)
        )
        return Candidates(regions, together, colour.source_size)


def best_pair(pairs: NDArray[np.float32]) -> tuple[tuple[int, int], float] | None:
    """The two candidates that go together best, and how well; None without any."""
    if pairs.size == 0 or pairs.max() <= 0.0:
        return None
    first, second = np.unravel_index(int(pairs.argmax()), pairs.shape)
    return (int(first), int(second)), float(pairs[first, second])


def side_in_picture(box: Box, width: int) -> Side:
    """The side of a hand by its half of an unmirrored picture, `width` pixels wide."""
    return "right" if box[0] + box[2] / 2 < width / 2 else "left"


def choose(candidates: Candidates, settings: SelectorSettings) -> list[HandRegion]:
    """The hands of a single picture, by the diver's right first: a pair, one hand, or none."""
    found = best_pair(candidates.pairs)
    if found is not None and found[1] >= settings.pair_score:
        two = sorted(
            (candidates.regions[i] for i in found[0]), key=lambda region: region.box[0] + region.box[2] / 2
        )
        sides: tuple[Side, Side] = ("right", "left")
        return [
            replace(region, side=side, confidence=max(region.confidence, found[1]))
            for region, side in zip(two, sides, strict=True)
        ]
    if candidates.regions and candidates.regions[0].confidence >= settings.single_score:
        one = candidates.regions[0]
        side = side_in_picture(one.box, candidates.source_size[0])
        return [replace(one, side=side, confidence=one.confidence * settings.alone_confidence)]
    return []


def find_hands(image: Image, *, mirrored: bool = False) -> list[HandRegion]:
    """The hands of one picture, without memory.

    image: uint8 (height, width, 3), BGR. mirrored: the picture is a selfie camera's; it is searched
    as it would look unmirrored, so the sides are the diver's own, and the boxes are reported in the
    given pixels. Raises SelectorError where the bundled data file is damaged.
    """
    stage = RegionStage()
    upright = np.ascontiguousarray(image[:, ::-1]) if mirrored else image
    hands = choose(stage.process(ColourStage().process(upright)), stage.settings)
    return [mirror_region(hand, image.shape[1]) for hand in hands] if mirrored else hands


def mirror_region(region: HandRegion, width: int) -> HandRegion:
    """The region in the picture flipped left to right; its side stays."""
    contour = region.contour * np.array([-1, 1]) + np.array([width - 1, 0])
    return replace(
        region,
        box=mirror_box(region.box, width),
        contour=contour.astype(np.int32),
        alternatives=tuple(mirror_box(box, width) for box in region.alternatives),
    )
