"""Fit the trees that decide how far locator and refiner are believed. Needs scikit-learn."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.choice import COLUMNS, Refined, describe_places
from lightgesture.features.find.learned import Places, candidates_of
from lightgesture.features.find.pairs import COLUMNS as PAIR_COLUMNS
from lightgesture.features.find.pairs import pair_numbers
from lightgesture.features.find.peaks import Peaks
from lightgesture.features.find.settings import LEARNED
from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.geometry import pairwise_iou
from lightgesture.training.regions.trees import BoxedPicture, TreeSettings, fit_trees

Float = NDArray[np.float32]

PLACE_TREES = TreeSettings(trees=80, leaves=12, depth=4, least_rows=40, rate=0.08, hand_weight=1.0)
PLACE_PAIR_TREES = TreeSettings(trees=80, leaves=12, depth=4, least_rows=40, rate=0.08, hand_weight=1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """A picture with what the nets say of it. overlaps: float32 (n,), IoU of each refined box with the best hand."""

    colour: ColourMap
    boxes: NDArray[np.float64]
    peaks: Peaks
    refined: Refined

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the working picture."""
        return self.colour.picture.shape[1], self.colour.picture.shape[0]

    def overlaps(self, boxes: Float) -> Float:
        """float32 (n,): IoU of boxes (working pixels) with the best hand each."""
        if not len(self.boxes) or not len(boxes):
            return np.zeros(len(boxes), np.float32)
        scale = np.array([*self.colour.scale, *self.colour.scale])
        return np.asarray(pairwise_iou(boxes * scale, self.boxes).max(axis=1), np.float32)


def look(pictures: Iterable[BoxedPicture], nets: Places) -> Iterable[Seen]:
    """Let nets that were not trained on these pictures search them."""
    stage = ColourStage()
    for picture in pictures:
        colour = stage.process(picture.image)
        boxes = np.array(picture.boxes, np.float64).reshape(-1, 4)
        yield Seen(colour, boxes, *nets.find(colour))


def fit_places(seen: Iterable[Seen], seed: int) -> Trees:
    """Trees that predict the IoU of a refined box with the best hand box."""
    rows = [np.zeros((0, COLUMNS), np.float32)]
    targets = [np.zeros(0, np.float32)]
    for one in seen:
        rows.append(describe_places(one.peaks, one.refined, one.size))
        targets.append(one.overlaps(one.refined.boxes))
    return fit_trees(np.concatenate(rows), np.concatenate(targets), PLACE_TREES, seed)


def fit_place_pairs(seen: Iterable[Seen], places: Trees, seed: int) -> Trees:
    """Trees that predict the lower IoU of a pair. `seen` must be other pictures than those of `places`, and every hand
    in them must have its box."""
    rows = [np.zeros((0, PAIR_COLUMNS), np.float32)]
    targets = [np.zeros(0, np.float32)]
    for one in seen:
        scores = evaluate(places, describe_places(one.peaks, one.refined, one.size))
        items = candidates_of(one.colour, one.peaks, one.refined, scores, LEARNED)
        pairs, numbers = pair_numbers(items, one.size, one.peaks.face, LEARNED.apart_iou)
        if pairs:
            own = one.overlaps(np.array([item.box for item in items]))
            rows.append(numbers)
            targets.append(np.array([min(own[i], own[j]) for i, j in pairs], np.float32))
    return fit_trees(np.concatenate(rows), np.concatenate(targets), PLACE_PAIR_TREES, seed)
