"""The product with one stage changed or left out at a time, for both selectors, to see what each stage buys.

Nothing is trained again for a variant: trees go on with numbers that they were not trained on, so what a stage buys
may be told too high where other trees could do without it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.finding.pipelines import Stages, selector_method, variant
from lightgesture.benchmarks.methods import Decoded, Image, Method
from lightgesture.benchmarks.scorer import Reading
from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.bank import bank_distances, hand_proximity
from lightgesture.features.find.candidates import APART_IOU, best_distinct, scored_pairs
from lightgesture.features.find.classical import Loops, Scene, Scorer, other_extents, scored_candidates
from lightgesture.features.find.learned import HAND_IOU, NO_OUTLINE, LearnedSelector, Places, regions_at
from lightgesture.features.find.proposals import LEVELS, Proposals, propose
from lightgesture.features.find.selector import SelectorName, load_selector
from lightgesture.features.find.selector_file import (
    ClassicalParts,
    LearnedParts,
    load_classical,
    load_learned,
)
from lightgesture.features.find.settings import CLASSICAL, LEARNED, SelectorSettings
from lightgesture.features.find.trees import FlatTrees
from lightgesture.features.geometry import pairwise_iou, scale_boxes
from lightgesture.features.net.runner import logistic
from lightgesture.features.skin_map import redness, stretch
from lightgesture.features.types import Box, Candidates, HandRegion
from lightgesture.hands import Finder

Float = NDArray[np.float32]
Search = Callable[[ColourMap], Candidates]
Score = Callable[[ColourMap], tuple[Proposals, Float]]
"""The regions of a frame and their scores, float32 (n,), 0 to 1."""

ONE_THRESHOLD = 2
"""Two levels are one threshold, in the middle of the range."""


class ChangedStage:
    """A region stage that searches otherwise, or believes otherwise what was found.

    search: in place of the selector's own. change: of all that is found. follows: whether predicted boxes are looked
    at in place of a search.
    """

    def __init__(
        self,
        selector: SelectorName,
        search: Search | None = None,
        change: Callable[[Candidates], Candidates] | None = None,
        follows: bool = True,
    ) -> None:
        self._own = load_selector(selector)
        self.settings = self._own.settings
        self._search, self._change, self._follows = search, change, follows

    def process(self, colour: ColourMap) -> Candidates:
        """Search one frame."""
        found = self._own.process(colour) if self._search is None else self._search(colour)
        return found if self._change is None else self._change(found)

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates | None:
        """Look at predicted boxes, where this stage does."""
        found = self._own.follow(image, boxes) if self._follows else None
        return found if found is None or self._change is None else self._change(found)


def lower_of_both(regions: Sequence[HandRegion], least: float = 0.0) -> Float:
    """float32 (n, n): each two hands go together as well as the worse of them is one, and not at all where they overlap
    or one scores less than `least`."""
    if not regions:
        return np.zeros((0, 0), np.float32)
    boxes = np.array([one.box for one in regions])
    scores = np.array([one.confidence for one in regions], np.float32)
    together = np.minimum.outer(scores, scores)
    apart = pairwise_iou(boxes, boxes) <= APART_IOU
    return np.where(apart & (together >= least), together, 0.0).astype(np.float32)


def without_pairs(settings: SelectorSettings) -> Callable[[Candidates], Candidates]:
    """Believes each hand on its own: nothing is gained by a partner."""

    def change(found: Candidates) -> Candidates:
        return replace(found, pairs=lower_of_both(found.regions, settings.single_score))

    return change


@dataclass(frozen=True, slots=True)
class ClassicalSearch:
    """The classical choice with other scores. has_trees: whether trees choose the pair."""

    parts: ClassicalParts
    score: Score
    has_trees: bool = True

    def __call__(self, colour: ColourMap) -> Candidates:
        proposals, scores = self.score(colour)
        overlap = pairwise_iou(proposals.boxes, proposals.boxes)
        kept, items = scored_candidates(colour, proposals, scores, overlap)
        found = tuple(
            _region(colour, proposals.boxes[[index, *others]], float(scores[index]))
            for index, others in zip(kept, other_extents(overlap, scores, kept), strict=True)
        )
        height, width = colour.picture.shape[:2]
        pairs = lower_of_both(found)
        if self.has_trees:
            pairs = scored_pairs(FlatTrees.of(self.parts.pairs).scores, items, (width, height), None)
        return Candidates(found, pairs, colour.source_size)


def _region(colour: ColourMap, boxes: NDArray[np.int32], score: float) -> HandRegion:
    """A region of some extents, (n, 4), working pixels, the likeliest first."""
    first, *others = scale_boxes(boxes, colour.scale, colour.source_size)
    return HandRegion(first, NO_OUTLINE, None, float(np.clip(score, 0.0, 1.0)), tuple(others))


def tree_scores(parts: ClassicalParts, levels: int = LEVELS) -> Score:
    """The product's scores, of regions at fewer levels."""
    loops = Loops()
    scorer = Scorer(parts.glance, parts.regions, parts.bank, loops)
    return lambda colour: scorer.process(Scene.of(colour, loops), levels)


def bank_scores(parts: ClassicalParts) -> Score:
    """How much nearer an outline is to the bank's hands than to other things, the paper's last step."""

    def score(colour: ColourMap) -> tuple[Proposals, Float]:
        proposals = propose(colour)
        return proposals, hand_proximity(bank_distances(proposals.contours, parts.bank), parts.bank)

    return score


def level_scores(colour: ColourMap) -> tuple[Proposals, Float]:
    """The redder the better: the threshold at which a region stands alone."""
    proposals = propose(colour)
    return proposals, np.asarray(proposals.levels / np.float32(255.0), np.float32)


class PlainColourStage(ColourStage):
    """The skin map of the picture's own colours: no red is given back, and the channels are not balanced."""

    def process(self, image: Image) -> ColourMap:
        return replace(super().process(image), skin_of=_plain_skin)


def _plain_skin(picture: Image) -> Image:
    opponent = redness(picture.astype(np.float32) / np.float32(255))
    return stretch(np.asarray(cv2.GaussianBlur(opponent, (3, 3), 0), np.float32))


@dataclass(frozen=True, slots=True)
class LearnedSearch:
    """One net's own boxes and scores, and the surest pair of them. refines: the refiner's, else the locator's."""

    nets: Places
    refines: bool

    def __call__(self, colour: ColourMap) -> Candidates:
        peaks, refined = self.nets.find(colour)
        boxes, scores = peaks.boxes, peaks.heat
        if self.refines:
            boxes, scores = refined.boxes, np.float32(HAND_IOU) * logistic(refined.hand)
        kept = best_distinct(pairwise_iou(boxes, boxes), scores)
        found = regions_at(colour, boxes[kept], scores[kept])
        return Candidates(found, lower_of_both(found), colour.source_size)


@dataclass(frozen=True, slots=True)
class Memoryless:
    """A method that reads the frames of a sequence one by one."""

    method: Method
    name: str

    def read(self, image: Image) -> list[Reading]:
        return self.method.read(image)

    def stream(self, hold: int | None) -> "Memoryless":
        del hold
        return self

    def process(self, image: Image, time_s: float) -> list[Reading]:
        del time_s
        return self.method.read(image)

    def finish(self) -> Decoded:
        return Decoded((), (), 0)


def ablations() -> list[Method]:
    """The product with either selector, each followed by its variants. Raises SelectorError."""
    return [*_learned_variants(load_learned()), *_classical_variants(load_classical())]


def _learned_variants(parts: LearnedParts) -> list[Method]:
    nets = Places(parts.locator, parts.refiner)
    whole = selector_method("learned")
    alone = ChangedStage("learned", change=without_pairs(LEARNED))
    return [
        whole,
        _with("learned: locator alone", ChangedStage("learned", LearnedSearch(nets, False), follows=False)),
        _with("learned: no trees", ChangedStage("learned", LearnedSearch(nets, True))),
        _with("learned: no verifier", LearnedSelector(replace(parts, verifier=None))),
        _with("learned: no pair choice", alone),
        _with("learned: search every frame", ChangedStage("learned", follows=False)),
        Memoryless(whole, "learned: no tracks"),
    ]


def _classical_variants(parts: ClassicalParts) -> list[Method]:
    whole = selector_method("classical")
    one = ClassicalSearch(parts, tree_scores(parts, ONE_THRESHOLD))
    bank = ClassicalSearch(parts, bank_scores(parts), has_trees=False)
    level = ClassicalSearch(parts, level_scores, has_trees=False)
    alone = ChangedStage("classical", change=without_pairs(CLASSICAL))
    plain = load_selector("classical")
    return [
        whole,
        _with("classical: one threshold", ChangedStage("classical", one)),
        variant("classical: colours as they are", Stages(colour=PlainColourStage, regions=lambda: plain)),
        _with("classical: bank alone", ChangedStage("classical", bank)),
        _with("classical: no scorer", ChangedStage("classical", level)),
        _with("classical: no pair choice", alone),
        Memoryless(whole, "classical: no tracks"),
    ]


def _with(name: str, stage: Finder) -> Method:
    return variant(name, Stages(regions=lambda: stage))
