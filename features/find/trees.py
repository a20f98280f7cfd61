"""Boosted regression trees at run time: arrays in a data file, evaluated without the training library."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Trees:
    """A sum of regression trees, all in arrays of shape (trees, nodes), node 0 the root.

    feature: int16, the column that a node compares, any at a leaf. threshold: float32, a row goes left
    where its value is at or below. left, right: int16 node numbers (a leaf points at itself).
    value: float32, what a leaf adds. base: added once. depth: steps that reach every leaf.
    """

    feature: NDArray[np.int16]
    threshold: NDArray[np.float32]
    left: NDArray[np.int16]
    right: NDArray[np.int16]
    value: NDArray[np.float32]
    base: float
    depth: int

    def check(self, columns: int) -> None:
        """Refuse arrays that would read outside themselves or give no number. Raises ValueError."""
        shape = self.feature.shape
        if len(shape) != 2 or any(
            a.shape != shape for a in (self.threshold, self.left, self.right, self.value)
        ):
            raise ValueError("the arrays of the trees have different shapes")
        for child in (self.left, self.right):
            if child.size and (child.min() < 0 or child.max() >= shape[1]):
                raise ValueError("a tree points outside its nodes")
        if shape[0] and not shape[1]:
            raise ValueError("the trees have no nodes")
        if self._leads_twice():
            raise ValueError("a tree leads to one of its nodes twice")
        if self.feature.size and (self.feature.min() < 0 or self.feature.max() >= columns):
            raise ValueError("a tree asks for a column that there is not")
        if not (
            np.isfinite(self.threshold).all() and np.isfinite(self.value).all() and np.isfinite(self.base)
        ):
            raise ValueError("a tree holds values that are not finite")
        if not 0 <= self.depth <= 64:
            raise ValueError("the depth of the trees must be 0 to 64")

    def _leads_twice(self) -> bool:
        """Whether a walk from the root may come to a node in two ways: then it is no tree and may go round for ever."""
        first = np.arange(len(self.left))[:, None] * self.left.shape[1]
        left, right = (first + self.left).ravel(), (first + self.right).ravel()
        seen = np.zeros(left.size, bool)
        led_to = first.ravel()
        while led_to.size:
            if seen[led_to].any() or len(np.unique(led_to)) < len(led_to):
                return True
            seen[led_to] = True
            inner = led_to[(left[led_to] != led_to) | (right[led_to] != led_to)]
            led_to = np.concatenate([left[inner], right[inner]])
        return False


def evaluate(trees: Trees, rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Sum of the leaves that each row (n, columns) reaches: float32 (n,)."""
    return _laid_out(trees).scores(rows)


@dataclass(frozen=True, slots=True, eq=False)
class _LaidOut:
    """Trees whose nodes stand in a row, two entries for each, so that a step is `children[entry + goes_right]`.

    roots: intp (trees,), the entries with which the trees begin. asked: intp, bounds: float32 (trees,): what the roots
    compare. feature: intp, threshold, value: float32, children: intp, two entries a node.
    """

    roots: NDArray[np.intp]
    asked: NDArray[np.intp]
    bounds: NDArray[np.float32]
    feature: NDArray[np.intp]
    threshold: NDArray[np.float32]
    children: NDArray[np.intp]
    value: NDArray[np.float32]
    base: float
    depth: int

    def scores(self, rows: NDArray[np.float32]) -> NDArray[np.float32]:
        """What the trees say of rows, float32 (n, columns): float32 (n,).

        All rows walk down all trees in step, on flat arrays: `take` with one index is several times as fast as
        indexing by tree and node.
        """
        rows = np.ascontiguousarray(rows, np.float32)
        node: NDArray[np.intp] = np.broadcast_to(self.roots, (len(rows), len(self.roots)))
        if self.depth:
            node = self.children.take(node + (rows.take(self.asked, axis=1) > self.bounds))
        values = rows.ravel()
        first = np.arange(0, rows.size, max(rows.shape[1], 1), dtype=np.intp)[:, None]
        for _ in range(self.depth - 1):
            goes_right = values.take(self.feature.take(node) + first) > self.threshold.take(node)
            node = self.children.take(node + goes_right)
        return np.asarray(self.base + self.value.take(node).sum(axis=1), np.float32)


LEAF_UNIT: Final = 1 << 20
"""Steps of one in the leaves of `FlatTrees`."""

Walk = Callable[["FlatTrees", NDArray[np.float32]], NDArray[np.int64]]
"""(trees, rows) -> int64 (n,): sum of the leaves that each row (n, columns), float32, reaches, in steps."""


@dataclass(frozen=True, slots=True, eq=False)
class FlatTrees:
    """Trees made ready to be walked: all nodes of all trees stand in a row, the two children of one side by side.

    roots: intp (trees,), where each tree begins. feature: intp, threshold: float32, first: intp, the left child, leaf:
    int32, a node each. A leaf is its own left child and sends none to the right. What leaves add are whole steps, so
    that their sum is the same in any order.
    """

    roots: NDArray[np.intp]
    feature: NDArray[np.intp]
    threshold: NDArray[np.float32]
    first: NDArray[np.intp]
    leaf: NDArray[np.int32]
    base: float
    depth: int

    @classmethod
    def of(cls, trees: Trees) -> "FlatTrees":
        leaf = np.rint(trees.value * np.float64(LEAF_UNIT)).astype(np.int32)
        roots: list[int] = []
        old: list[tuple[int, int]] = []
        first: list[int] = []
        for tree in range(len(trees.feature)):
            begin = len(old)
            roots.append(begin)
            nodes, children = _side_by_side(trees.left[tree].tolist(), trees.right[tree].tolist())
            old += [(tree, node) for node in nodes]
            first += [begin + child for child in children]
        places = tuple(np.array(old, np.intp).reshape(-1, 2).T)
        children_of = np.array(first, np.intp)
        threshold = np.where(
            children_of == np.arange(len(first)), np.float32(np.inf), trees.threshold[places]
        )
        return cls(
            np.array(roots, np.intp),
            trees.feature[places].astype(np.intp),
            threshold.astype(np.float32),
            children_of,
            leaf[places],
            trees.base,
            trees.depth,
        )

    def scores(self, rows: NDArray[np.float32], walk: Walk | None = None) -> NDArray[np.float32]:
        """What the trees say of rows, float32 (n, columns): float32 (n,). walk: None for `plain_walk`."""
        total = (walk or plain_walk)(self, np.ascontiguousarray(rows, np.float32))
        return (self.base + total / LEAF_UNIT).astype(np.float32)


def _side_by_side(left: list[int], right: list[int]) -> tuple[list[int], list[int]]:
    """The nodes of a tree with the two children of each side by side, the root first; and of each where in that order
    its left child stands, of a leaf itself."""
    nodes, first = [0], []
    for place, node in enumerate(nodes):
        if left[node] == node and right[node] == node:
            first.append(place)
        else:
            first.append(len(nodes))
            nodes += [left[node], right[node]]
    return nodes, first


def plain_walk(trees: FlatTrees, rows: NDArray[np.float32]) -> NDArray[np.int64]:
    """A `Walk` by NumPy: all rows walk down all trees in step."""
    node = np.broadcast_to(trees.roots, (len(rows), len(trees.roots)))
    if trees.depth:
        asked, bounds = trees.feature.take(trees.roots), trees.threshold.take(trees.roots)
        node = trees.first.take(trees.roots) + (rows.take(asked, axis=1) > bounds)
    values = rows.ravel()
    row = (np.arange(len(rows)) * rows.shape[1])[:, None]
    for _ in range(trees.depth - 1):
        goes_right = values.take(row + trees.feature.take(node)) > trees.threshold.take(node)
        node = trees.first.take(node) + goes_right
    return np.asarray(trees.leaf.take(node).sum(axis=1, dtype=np.int64), np.int64)


@lru_cache(maxsize=8)
def _laid_out(trees: Trees) -> _LaidOut:
    """Laid out once for all the pictures that are looked at with the same trees."""
    count, nodes = trees.feature.shape
    roots = (np.arange(count) * nodes).astype(np.intp)
    feature, threshold = trees.feature.astype(np.intp).ravel(), trees.threshold.ravel()
    children = np.stack([trees.left + roots[:, None], trees.right + roots[:, None]], axis=-1).ravel()
    return _LaidOut(
        2 * roots,
        feature[roots],
        threshold[roots],
        np.repeat(feature, 2),
        np.repeat(threshold, 2),
        2 * children,
        np.repeat(trees.value.ravel(), 2),
        trees.base,
        trees.depth,
    )
