"""Boosted trees as they are written: each row walks down each tree, and the leaves are added."""

import numpy as np
import pytest

from lightgesture.features.find.trees import Trees, evaluate


def _walked(trees, row):
    total = np.float32(0.0)
    for tree in range(len(trees.feature)):
        node = 0
        for _ in range(trees.depth):
            goes_left = row[trees.feature[tree, node]] <= trees.threshold[tree, node]
            node = (trees.left if goes_left else trees.right)[tree, node]
        total += trees.value[tree, node]
    return trees.base + total


def _trees(depth, rng, count=5):
    """Full trees: node n has the children 2n + 1 and 2n + 2, a leaf itself."""
    nodes = 2 ** (depth + 1) - 1
    numbers = np.arange(nodes)
    is_leaf = 2 * numbers + 2 >= nodes
    left, right = (np.where(is_leaf, numbers, 2 * numbers + side) for side in (1, 2))
    shape = count, nodes
    return Trees(
        feature=rng.integers(0, 3, shape).astype(np.int16),
        threshold=rng.normal(size=shape).astype(np.float32),
        left=np.broadcast_to(left, shape).astype(np.int16),
        right=np.broadcast_to(right, shape).astype(np.int16),
        value=rng.normal(size=shape).astype(np.float32),
        base=0.25,
        depth=depth,
    )


@pytest.mark.parametrize("depth", [0, 1, 4])
@pytest.mark.parametrize("count", [0, 1, 9])
def test_rows_reach_the_leaves_that_a_walk_reaches(depth, count):
    rng = np.random.default_rng(depth)
    trees, rows = _trees(depth, rng), rng.normal(size=(count, 3)).astype(np.float32)
    for _ in range(2):  # the second time from what was laid out
        scores = evaluate(trees, rows)
        assert scores.dtype == np.float32
        assert scores == pytest.approx([_walked(trees, row) for row in rows], abs=1e-6)
