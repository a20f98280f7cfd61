"""Compiled loops put in the place of the plain ones: from what a stage has to flat arrays and back."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.cells import CellLoops
from lightgesture.features.find.classical import Loops
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
    plain_whole,
)
from lightgesture.features.find.trees import FlatTrees
from lightgesture.features.skin_map import SkinLoops
from lightgesture.features.types import Image

MOST_LEVELS: Final = 128
"""Levels that the compiled loops know, as one bit of a byte tells whether its pixel reaches one."""


def joined(found: Mapping[str, Callable[..., Any]]) -> Loops:
    """What the compiled loops of these names do, in the stages' own terms."""
    walk, measure = found["walk"], found["areas"]

    def walk_trees(trees: FlatTrees, rows: NDArray[np.float32]) -> NDArray[np.int64]:
        total: NDArray[np.int64] = walk(
            trees.roots, trees.feature, trees.threshold, trees.children, trees.leaf, trees.depth, rows
        )
        return total

    def areas(regions: Proposals) -> NDArray[np.float64]:
        measured: NDArray[np.float64] = measure(
            regions.points, regions.starts, regions.lengths, regions.boxes
        )
        return measured

    skin = SkinLoops(
        _of_writeable(found["red"]), _of_writeable(found["redness"]), found["counts"], found["look_up"]
    )
    in_cells = CellLoops(_of_writeable(found["sums"]), found["cells"], areas)
    whole = partial(_whole, found["nodes"], found["distinct"], found["outlines"])
    return Loops(skin, in_cells, RegionLoops(whole, found["distinct"]), walk_trees)


def _whole(
    nodes: Callable[..., Any], distinct: Distinct, outlines: Callable[..., Any], skin: Image, levels: int
) -> Proposals:
    """`RegionLoops.whole` by compiled loops."""
    if levels > MOST_LEVELS:
        return plain_whole(skin, levels)
    height, width = skin.shape
    thresholds = np.arange(levels) * 256 // levels
    reached = thresholds.searchsorted(np.arange(256), side="right") - 1
    pixels = np.zeros((height + 2, (width + 9) // 8 * 8), np.uint8)
    pixels[1:-1, 1 : width + 1] = reached.astype(np.uint8)[skin]
    shorter = min(skin.shape)
    limits = np.array([SMALLEST_SIDE * shorter, LARGEST_SIDE * shorter, LARGEST_ASPECT])
    words = pixels.view(np.uint64)
    found = nodes(pixels, words, levels, limits, MOST_LOOKED_AT, MOST_OUTLINES, SHORTEST_CONTOUR)
    boxes = np.ascontiguousarray(found[:, :4])
    kept = distinct(boxes, MOST)
    points, starts = outlines(pixels, found[kept])
    return Proposals(
        boxes[kept],
        points,
        starts[:-1],
        starts[1:] - starts[:-1],
        thresholds[found[kept, 6]].astype(np.uint8),
        np.zeros(len(kept), bool),
    )


def _of_writeable(loop: Callable[..., Any]) -> Callable[..., Any]:
    """The loop, also for pictures that a camera or a profile gives as read-only or as a view, for which nothing was
    compiled."""

    def called(*arrays: Any) -> Any:
        return loop(*(_own(one) if isinstance(one, np.ndarray) else one for one in arrays))

    return called


def _own(array: NDArray[Any]) -> NDArray[Any]:
    flags = array.flags
    return array if flags.c_contiguous and flags.writeable else array.copy()
