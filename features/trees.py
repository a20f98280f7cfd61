"""Boosted regression trees at run time: arrays in a data file, evaluated without the training library."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Trees:
    """A sum of regression trees, all in arrays of shape (trees, nodes), node 0 the root.

    feature: int16, the column that a node compares; -1 at a leaf. threshold: float32, a row goes left
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
        if self.feature.size and (self.feature.min() < -1 or self.feature.max() >= columns):
            raise ValueError("a tree asks for a column that there is not")
        if not (
            np.isfinite(self.threshold).all() and np.isfinite(self.value).all() and np.isfinite(self.base)
        ):
            raise ValueError("a tree holds values that are not finite")
        if not 0 <= self.depth <= 64:
            raise ValueError("the depth of the trees must be 0 to 64")


def evaluate(trees: Trees, rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """Sum of the leaves that each row (n, columns) reaches: float32 (n,). All trees walk in step."""
    count = len(trees.feature)
    tree = np.arange(count)[None, :]
    row = np.arange(len(rows))[:, None]
    node = np.zeros((len(rows), count), np.int64)
    for _ in range(trees.depth):
        column = trees.feature[tree, node]
        goes_left = rows[row, column] <= trees.threshold[tree, node]
        node = np.where(goes_left, trees.left[tree, node], trees.right[tree, node])
    return np.asarray(trees.base + trees.value[tree, node].sum(axis=1), np.float32)
