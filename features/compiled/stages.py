"""Compiled loops put in the place of the plain ones: from what a stage has to flat arrays and back."""

import sys
from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.bank import BankLoops
from lightgesture.features.find.candidates import Point, Rows, numbers_of
from lightgesture.features.find.cells import CellLoops
from lightgesture.features.find.classical import Loops
from lightgesture.features.find.forearms import LEAST_HEIGHT, direction_from, erase_forearm
from lightgesture.features.find.proposals import (
    LARGEST_ASPECT,
    LARGEST_SIDE,
    MOST,
    MOST_LOOKED_AT,
    MOST_OUTLINES,
    SHORTEST_CONTOUR,
    SMALLEST_SIDE,
    Distinct,
    Proposals,
    RegionLoops,
    plain_forearms,
    plain_whole,
)
from lightgesture.features.find.trees import FlatTrees
from lightgesture.features.skin_map import SkinLoops
from lightgesture.features.types import Float, Image

DISCS: Final = 96
"""Radii of palms, with what is round them, that the compiled loops know, pixels."""
LARGEST_ARM: Final = 138
"""Longer side of a region whose palm has one of these radii, pixels; no working picture holds a larger square."""
MOST_LEVELS: Final = 128
"""Levels that the compiled loops know, as one bit of a byte tells whether its pixel reaches one."""


def joined(found: Mapping[str, Callable[..., Any]]) -> Loops:
    """What the compiled loops of these names do, in the stages' own terms."""
    walk, measure = found["walk"], found["shapes"]

    def walk_trees(trees: FlatTrees, rows: NDArray[np.float32]) -> NDArray[np.int64]:
        total: NDArray[np.int64] = walk(*_narrow(trees), trees.depth, rows)
        return total

    def shapes(regions: Proposals, size: tuple[int, int]) -> Float:
        points, starts, lengths = regions.points, regions.starts, regions.lengths
        measured: Float = measure(points, starts, lengths, regions.boxes, regions.cut, *size)
        return measured

    skin = SkinLoops(_of_writeable(found["red"]), _of_writeable(found["redness"]), found["stretch"])
    in_cells = CellLoops(_of_writeable(found["sums"]), found["cells"], shapes)
    whole = partial(_whole, found["nodes"], found["distinct"], found["outlines"])
    forearms = partial(_without_forearms, found["masks"], found["arms"], found["largest_parts"])
    colours = _of_writeable(partial(_mean_colours, found["masks"], found["colours"]))
    regions = RegionLoops(whole, found["distinct"], forearms, found["overlaps"], colours)
    pairs = partial(_numbers, found["ratios"], found["pair_rows"])
    return Loops(skin, in_cells, regions, walk_trees, pairs, BankLoops(found["sampled"], found["turned"]))


@lru_cache(maxsize=8)
def _narrow(trees: FlatTrees) -> tuple[NDArray[Any], ...]:
    """Roots, features, thresholds, children and leaves as the compiled loop takes them: a tree fits a near cache."""
    return (
        trees.roots.astype(np.uint32),
        trees.feature.astype(np.uint16),
        trees.threshold,
        trees.first.astype(np.uint32),
        trees.leaf,
    )


def _whole(
    nodes: Callable[..., Any], distinct: Distinct, outlines: Callable[..., Any], skin: Image, levels: int
) -> Proposals:
    """`RegionLoops.whole` by compiled loops."""
    # Eight pixels are looked at as one number, the first in its lowest byte.
    if levels > MOST_LEVELS or sys.byteorder != "little":
        return plain_whole(skin, levels)
    height, width = skin.shape
    thresholds, reached = _thresholds(levels)
    pixels = np.zeros((height + 2, (width + 9) // 8 * 8), np.uint8)
    pixels[1:-1, 1 : width + 1] = cv2.LUT(skin, reached)
    shorter = min(skin.shape)
    limits = np.array([SMALLEST_SIDE * shorter, LARGEST_SIDE * shorter, LARGEST_ASPECT])
    words = pixels.view(np.uint64)
    found = nodes(pixels, words, levels, limits, MOST_LOOKED_AT, MOST_OUTLINES, SHORTEST_CONTOUR)
    boxes = np.ascontiguousarray(found[:, :4])
    kept = distinct(boxes, MOST)
    chosen = found.take(kept, axis=0)
    points, starts = outlines(pixels, chosen)
    of_levels = thresholds.take(chosen[:, 6])
    return Proposals(
        boxes.take(kept, axis=0), points, starts[:-1], np.diff(starts), of_levels, np.zeros(len(kept), bool)
    )


@lru_cache(maxsize=4)
def _thresholds(levels: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The threshold of each level, and of each value how many of them, from the second on, it reaches."""
    thresholds = np.arange(levels) * 256 // levels
    reached = thresholds.searchsorted(np.arange(256), side="right") - 1
    return thresholds.astype(np.uint8), reached.astype(np.uint8)


def _without_forearms(
    masks: Callable[..., Any], arms: Callable[..., Any], parts: Callable[..., Any], regions: Proposals
) -> Proposals:
    """`RegionLoops.forearms` by compiled loops."""
    if not len(regions) or regions.boxes[:, 2:].max() > LARGEST_ARM:
        return plain_forearms(regions)
    whole, rows = masks(regions.points, regions.starts, regions.lengths, regions.boxes)
    found = arms(whole, rows, regions.boxes, cv2.distanceTransform(whole, cv2.DIST_L2, 3), _discs())
    widths, places = regions.boxes[:, 2].tolist(), rows.tolist()
    is_cut = np.zeros(len(regions), bool)
    for index, (x, y, radius, top, area, columns, lines) in enumerate(found.tolist()):
        (begin, pixels), (end, _), centre = places[index], places[index + 1], (int(x), int(y))
        direction = direction_from((area, columns, lines), top, pixels, centre) if top >= 0.0 else None
        if direction is not None:
            mask = whole[begin:end, : widths[index] + 2]
            is_cut[index] = erase_forearm(mask, pixels, centre, radius, direction)
    points, hands = parts(whole, rows, regions.boxes, is_cut, LEAST_HEIGHT)
    return Proposals(
        np.ascontiguousarray(hands[:, 3:]),
        points,
        hands[:, 0].astype(np.int64),
        hands[:, 1].astype(np.int64),
        regions.levels[hands[:, 2]],
        np.ones(len(hands), bool),
    )


def _mean_colours(
    masks: Callable[..., Any], colours: Callable[..., Any], picture: Image, regions: Proposals
) -> NDArray[np.float64]:
    """`RegionLoops.colours` by compiled loops."""
    whole, rows = masks(regions.points, regions.starts, regions.lengths, regions.boxes)
    means: NDArray[np.float64] = colours(picture, whole, rows, regions.boxes)
    return means


@lru_cache(maxsize=1)
def _discs() -> NDArray[np.int32]:
    """int32 (r, r + 1): half widths of OpenCV's disc of each radius in the rows from its middle on, -1 beyond it."""
    size = DISCS + 1
    found = np.empty((DISCS, size), np.int32)
    for radius in range(DISCS):
        canvas = np.zeros((size, 2 * size), np.uint8)
        cv2.circle(canvas, (size, 0), radius, 1, cv2.FILLED)
        found[radius] = (canvas.sum(axis=1, dtype=np.int32) + 1) // 2 - 1
    return found


def _numbers(
    ratios: Callable[..., Any],
    rows: Callable[..., Any],
    left: Rows,
    right: Rows,
    size: tuple[int, int],
    face: Point | None,
) -> Float:
    """`numbers_of` by compiled loops."""
    if face is not None:
        return numbers_of(left, right, size, face)
    units = ratios(left, right, min(size))
    found: Float = rows(left, right, units, np.log(units), *size)
    return found


def _of_writeable(loop: Callable[..., Any]) -> Callable[..., Any]:
    """The loop, also for pictures that a camera or a profile gives as read-only or as a view, for which nothing was
    compiled."""

    def called(*arrays: Any) -> Any:
        return loop(*(_own(one) if isinstance(one, np.ndarray) else one for one in arrays))

    return called


def _own(array: NDArray[Any]) -> NDArray[Any]:
    flags = array.flags
    return array if flags.c_contiguous and flags.writeable else array.copy()
