"""Fit the selector's trees from pictures with boxes: those that score regions, and those that weigh both nets.

Needs scikit-learn; never imported on the decode path.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find import cells
from lightgesture.features.find.bank import Bank
from lightgesture.features.find.candidates import (
    PAIR_COLUMNS,
    PLACE_COLUMNS,
    describe_places,
    pair_numbers,
)
from lightgesture.features.find.classical import COLUMNS as REGION_COLUMNS
from lightgesture.features.find.classical import (
    Loops,
    Scene,
    Scorer,
    scored_candidates,
    standing_out,
    with_bank,
)
from lightgesture.features.find.learned import Places, PlaceScorer, scored_places
from lightgesture.features.find.locator import Peaks
from lightgesture.features.find.proposals import Proposals, whole_regions, without_forearms
from lightgesture.features.find.refiner import Refined
from lightgesture.features.find.selector_file import ClassicalParts
from lightgesture.features.find.trees import FlatTrees, Trees
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.types import Float
from lightgesture.training.pictures.boxed import BoxedPicture


@dataclass(frozen=True, slots=True)
class TreeSettings:
    """How a set of trees is fitted (scikit-learn's HistGradientBoostingRegressor on squared error)."""

    trees: int
    """How many are summed."""
    leaves: int
    """Most leaves of one tree."""
    depth: int
    """Most steps from the root to a leaf."""
    least_rows: int
    """Fewest rows in a leaf."""
    rate: float
    """Learning rate, the factor on what each tree adds, 0 to 1."""
    hand_copies: int = 1
    """How often a row is learnt from whose IoU is over `HAND_IOU`, since hands are rare. Weights would do the same, and
    take many times as long to sort."""


GLANCE_TREES: Final = TreeSettings(trees=60, leaves=32, depth=6, least_rows=60, rate=0.2, hand_copies=3)
REGION_TREES: Final = TreeSettings(trees=160, leaves=48, depth=8, least_rows=40, rate=0.12, hand_copies=3)
PAIR_TREES: Final = TreeSettings(trees=120, leaves=24, depth=6, least_rows=30, rate=0.1, hand_copies=3)
PLACE_TREES: Final = TreeSettings(trees=80, leaves=12, depth=4, least_rows=40, rate=0.08)
"""Of places and of their pairs."""
SMOOTHING: Final = 1.0
"""L2 on the leaves."""
HAND_IOU: Final = 0.3
"""Overlap from which a row is one of a hand."""
MIDDLING_IOU: Final = 0.1
"""Overlap up to which a region is far from a hand."""
KEPT_SHARE: Final = 0.4
"""Of the regions whose IoU is not above `MIDDLING_IOU`, the share that is trained on: they are many and alike."""


def overlaps_with(picture: BoxedPicture, colour: ColourMap, regions: Proposals) -> Float:
    """float32 (n,): IoU of each region with the best hand."""
    if not picture.boxes or not len(regions):
        return np.zeros(len(regions), np.float32)
    scale = np.array([*colour.scale, *colour.scale])
    boxes = np.array(picture.boxes, np.float64)
    return np.asarray(pairwise_iou(regions.boxes * scale, boxes).max(axis=1), np.float32)


def fit_trees(rows: Sequence[Float], targets: Sequence[Float], settings: TreeSettings, seed: int) -> Trees:
    """Trees that predict targets, float32 (n,), from rows, float32 (n, columns), picture by picture.

    Raises ValueError without any row.
    """
    from sklearn.ensemble import HistGradientBoostingRegressor

    table, wanted = np.concatenate(rows), np.concatenate(targets)
    if not len(table):
        raise ValueError("no region was proposed in any picture; train the nets for more steps")
    model = HistGradientBoostingRegressor(
        max_iter=settings.trees,
        learning_rate=settings.rate,
        max_leaf_nodes=settings.leaves,
        max_depth=settings.depth,
        min_samples_leaf=settings.least_rows,
        l2_regularization=SMOOTHING,
        early_stopping=False,  # pyright: ignore[reportArgumentType]
        random_state=seed,
    )
    copies = np.where(wanted > HAND_IOU, settings.hand_copies, 1)
    model.fit(table.repeat(copies, axis=0), wanted.repeat(copies))
    return export_trees(model)


def export_trees(model: object) -> Trees:
    """The arrays of a fitted HistGradientBoostingRegressor. It has no public view of its nodes, so this
    reads the private one; a test compares the result with the model's own predictions."""
    nodes = [group[0].nodes for group in model._predictors]  # type: ignore[attr-defined]
    shape = len(nodes), max(len(tree) for tree in nodes)
    feature = np.zeros(shape, np.int16)
    threshold, value = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    left = np.zeros(shape, np.int16)
    right = np.zeros(shape, np.int16)
    for row, tree in enumerate(nodes):
        count = len(tree)
        leaf = tree["is_leaf"].astype(bool)
        own = np.arange(count)
        feature[row, :count] = np.where(leaf, 0, tree["feature_idx"])
        # Rows are float32: rounding the threshold down to float32 sends every one of them the same way.
        limit = np.where(leaf, 0.0, tree["num_threshold"])
        nearest = limit.astype(np.float32)
        lower = np.nextafter(nearest, np.float32(-np.inf))
        threshold[row, :count] = np.where(nearest > limit, lower, nearest)
        left[row, :count] = np.where(leaf, own, tree["left"])
        right[row, :count] = np.where(leaf, own, tree["right"])
        value[row, :count] = np.where(leaf, tree["value"], 0.0)
    depth = int(max(tree["depth"].max() for tree in nodes))
    base = float(np.ravel(model._baseline_prediction)[0])  # type: ignore[attr-defined]
    return Trees(feature, threshold, left, right, value, base, depth)


@dataclass(frozen=True, slots=True, eq=False)
class Glanced:
    """A picture as the first look sees it, and the rows of its regions."""

    picture: BoxedPicture
    colour: ColourMap
    scene: Scene
    regions: Proposals
    rows: Float

    def overlaps(self) -> Float:
        """float32 (n,): IoU of each region with the best hand, with its forearm or without it, whichever is more."""
        found = overlaps_with(self.picture, self.colour, self.regions)
        for number in range(len(self.regions)) if self.picture.boxes else ():
            hand = without_forearms(self.regions.taken(np.array([number])))
            if len(hand):
                found[number] = max(found[number], overlaps_with(self.picture, self.colour, hand)[0])
        return found


def glance(pictures: Iterable[BoxedPicture], loops: Loops) -> Iterable[Glanced]:
    """Every picture in which something is proposed."""
    stage = ColourStage()
    for picture in pictures:
        colour = stage.process(picture.image)
        scene = Scene.of(colour, loops)
        regions = whole_regions(scene.skin, loops=loops.regions)
        if len(regions):
            rows = cells.describe(scene.sums, regions, scene.size, loops.cells)
            yield Glanced(picture, colour, scene, regions, rows)


def fit_regions(
    pictures: Callable[[], Iterable[BoxedPicture]], bank: Bank, loops: Loops, seed: int
) -> tuple[Trees, Trees]:
    """The trees of the first look, then those of the second, which learn what the first does not tell apart.

    pictures: gives the same pictures each time.
    """
    rng = np.random.default_rng(seed)
    rows, targets = [np.zeros((0, cells.COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for one in glance(pictures(), loops):
        overlaps = one.overlaps()
        kept = (overlaps > MIDDLING_IOU) | (rng.random(len(overlaps)) < KEPT_SHARE)
        rows.append(one.rows[kept])
        targets.append(overlaps[kept])
    first = fit_trees(rows, targets, GLANCE_TREES, seed)
    flat = FlatTrees.of(first)
    rows, targets = [np.zeros((0, REGION_COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for one in glance(pictures(), loops):
        scores = flat.scores(one.rows, loops.walk)
        seen, numbers = standing_out(one.scene, one.regions, one.rows, scores, loops)
        rows.append(with_bank(numbers, seen, bank, loops.bank))
        targets.append(overlaps_with(one.picture, one.colour, seen))
    return first, fit_trees(rows, targets, REGION_TREES, seed)


def fit_pairs(
    pictures: Iterable[BoxedPicture], first: Trees, second: Trees, bank: Bank, loops: Loops, seed: int
) -> ClassicalParts:
    """All parts, with trees that predict the lower IoU of the two regions of a pair. `pictures` must be others than
    those that the other trees were fitted on, whose scores would be too good; every hand in them must have its box."""
    stage = ColourStage()
    scorer = Scorer(first, second, bank, loops)
    rows, targets = [np.zeros((0, PAIR_COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for picture in pictures:
        colour = stage.process(picture.image)
        scene = Scene.of(colour, loops)
        regions, scores = scorer.process(scene)
        overlap = pairwise_iou(regions.boxes, regions.boxes)
        kept, items = scored_candidates(colour, regions, scores, overlap)
        pairs, numbers = pair_numbers(items, scene.size, None)
        rows.append(numbers)
        targets.append(_lower_of_both(overlaps_with(picture, colour, regions)[kept], pairs))
    return ClassicalParts(first, second, fit_trees(rows, targets, PAIR_TREES, seed), bank)


def _lower_of_both(overlaps: Float, pairs: NDArray[np.intp]) -> Float:
    """float32 (pairs,): the lower IoU of the two regions of each pair, given that of each region."""
    return np.array([min(overlaps[one], overlaps[other]) for one, other in pairs], np.float32)


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
    rows, targets = [np.zeros((0, PLACE_COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for one in seen:
        rows.append(describe_places(one.peaks, one.refined, one.size))
        targets.append(one.overlaps(one.refined.boxes))
    return fit_trees(rows, targets, PLACE_TREES, seed)


def fit_place_pairs(seen: Iterable[Seen], scorer: PlaceScorer, seed: int) -> Trees:
    """Trees that predict the lower IoU of a pair. `seen` must be other pictures than those that the scorer learnt from,
    and every hand in them must have its box."""
    rows, targets = [np.zeros((0, PAIR_COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for one in seen:
        scores = scorer.process(one.colour, one.peaks, one.refined)
        kept, items = scored_places(one.colour, one.peaks, one.refined, scores)
        pairs, numbers = pair_numbers(items, one.size, one.peaks.face)
        rows.append(numbers)
        targets.append(_lower_of_both(one.overlaps(one.refined.boxes[kept]), pairs))
    return fit_trees(rows, targets, PLACE_TREES, seed)
