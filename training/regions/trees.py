"""Fit the selector's trees from pictures with boxes. Needs scikit-learn; never imported on the decode path."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap, ColourStage
from lightgesture.features.find.bank import Bank
from lightgesture.features.find.classical import describe_regions, scored_candidates
from lightgesture.features.find.pairs import COLUMNS, pair_numbers
from lightgesture.features.find.proposals import Proposals, propose
from lightgesture.features.find.settings import CLASSICAL
from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.types import Box, Image

Float = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class TreeSettings:
    """How a set of trees is fitted (scikit-learn's HistGradientBoostingRegressor on squared error).

    trees: how many. leaves, depth: of one tree. least_rows: in a leaf. rate: learning rate. smoothing: L2 on
    the leaves. hand_weight: weight of a row whose IoU is over 0.3 beside 1, since hands are rare.
    """

    trees: int
    leaves: int
    depth: int
    least_rows: int
    rate: float = 0.12
    smoothing: float = 1.0
    hand_weight: float = 3.0


REGION_TREES = TreeSettings(trees=200, leaves=48, depth=8, least_rows=40)
PAIR_TREES = TreeSettings(trees=120, leaves=24, depth=6, least_rows=30, rate=0.1)
MIDDLING_IOU = 0.1
KEPT_SHARE = 0.4
"""Of the regions whose IoU is below MIDDLING_IOU, the share that is trained on: they are many and alike."""


@dataclass(frozen=True, slots=True, eq=False)
class BoxedPicture:
    """image: uint8 (h, w, 3), BGR. boxes: outlines of all hands in it, source pixels; may be empty. faces: boxes of
    faces that are known. all_faces: those are all. sources: whose pictures went in."""

    image: Image
    boxes: tuple[Box, ...]
    faces: tuple[Box, ...] = ()
    all_faces: bool = False
    sources: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True, eq=False)
class _Described:
    colour: ColourMap
    proposals: Proposals
    numbers: Float
    overlaps: Float


def _describe_picture(stage: ColourStage, picture: BoxedPicture, bank: Bank) -> _Described | None:
    colour = stage.process(picture.image)
    proposals = propose(colour)
    if not len(proposals):
        return None
    scale = np.array([*colour.scale, *colour.scale])
    overlaps = np.zeros(len(proposals), np.float32)
    if picture.boxes:
        boxes = np.array(picture.boxes, np.float64)
        overlaps = pairwise_iou(proposals.boxes * scale, boxes).max(axis=1).astype(np.float32)
    return _Described(colour, proposals, describe_regions(colour, proposals, bank), overlaps)


def fit_trees(rows: Float, targets: Float, settings: TreeSettings, seed: int) -> Trees:
    from sklearn.ensemble import HistGradientBoostingRegressor

    if not len(rows):
        raise ValueError("no region was proposed in any picture; train the nets for more steps")
    model = HistGradientBoostingRegressor(
        max_iter=settings.trees,
        learning_rate=settings.rate,
        max_leaf_nodes=settings.leaves,
        max_depth=settings.depth,
        min_samples_leaf=settings.least_rows,
        l2_regularization=settings.smoothing,
        early_stopping=False,  # pyright: ignore[reportArgumentType]
        random_state=seed,
    )
    weights = np.where(targets > 0.3, settings.hand_weight, 1.0)
    model.fit(rows, targets, sample_weight=weights)
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


def fit_regions(
    pictures: Iterable[BoxedPicture], bank: Bank, seed: int, settings: TreeSettings = REGION_TREES
) -> Trees:
    """Trees that predict the IoU of a proposal with the best hand box."""
    stage, rng = ColourStage(), np.random.default_rng(seed)
    rows, targets = [], []
    for picture in pictures:
        described = _describe_picture(stage, picture, bank)
        if described is None:
            continue
        kept = (described.overlaps > MIDDLING_IOU) | (rng.random(len(described.overlaps)) < KEPT_SHARE)
        rows.append(described.numbers[kept])
        targets.append(described.overlaps[kept])
    return fit_trees(np.concatenate(rows), np.concatenate(targets), settings, seed)


def fit_pairs(
    pictures: Iterable[BoxedPicture],
    regions: Trees,
    bank: Bank,
    seed: int,
    settings: TreeSettings = PAIR_TREES,
) -> Trees:
    """Trees that predict the lower IoU of the two regions of a pair. `pictures` must be others than those that
    `regions` were fitted on, whose scores would be too good; every hand in them must have its box."""
    stage = ColourStage()
    rows, targets = [np.zeros((0, COLUMNS), np.float32)], [np.zeros(0, np.float32)]
    for picture in pictures:
        described = _describe_picture(stage, picture, bank)
        if described is None:
            continue
        scores = evaluate(regions, described.numbers)
        kept, items = scored_candidates(described.colour, described.proposals, scores, CLASSICAL)
        height, width = described.colour.skin.shape
        pairs, numbers = pair_numbers(items, (width, height), None, CLASSICAL.apart_iou)
        if pairs:
            own = described.overlaps[kept]
            rows.append(numbers)
            targets.append(np.array([min(own[i], own[j]) for i, j in pairs], np.float32))
    return fit_trees(np.concatenate(rows), np.concatenate(targets), settings, seed)
