"""What the loops over the levels of the skin map call, to be compiled: runs of a row, joined with those above.

A row is looked at eight pixels at a time. Its runs are joined with those of the row above by eight neighbours, and what
lies between them by four, so that what stands in another region's hole is known: Suzuki and Abe, "Topological
structural analysis of digitized binary images by border following", Computer Vision, Graphics, and Image Processing
30(1), 1985.
"""

from typing import Any, Final

import numpy as np

# Numba has no types that a type checker knows.
Array = Any

HELPERS: Final = ("root_of", "joined", "find_edges", "join_gaps", "join_runs")
"""What calls one another here."""
ONES: Final = np.uint64(0x0101010101010101)
HIGH_BITS: Final = np.uint64(0x8080808080808080)
PLACES: Final = np.uint64(0x0001020304050607)
"""Times a byte's lowest bit this has the byte's place in the topmost byte."""
ZERO, ONE, SEVEN, EIGHT, TOP = (np.uint64(number) for number in (0, 1, 7, 8, 56))


def root_of(parents: Array, label: int) -> int:
    """The label that stands for all those joined with one."""
    while parents[label] != label:
        parents[label] = parents[parents[label]]
        label = parents[label]
    return label


def joined(parents: Array, one: int, other: int) -> int:
    """The label that stands for all those joined with either, now one: the older."""
    first, second = root_of(parents, one), root_of(parents, other)
    parents[max(first, second)] = min(first, second)
    return min(first, second)


def find_edges(row: Array, level: int, edges: Array) -> int:
    """Write where the runs of a row that reach a level begin and end, in turn; the number of runs.

    row: uint64, eight pixels each, the first in the lowest byte.
    """
    # A byte's highest bit is set where its pixel, below 128, reaches the level.
    offset = np.uint64(128 - level) * ONES
    count = 0
    last = ZERO
    for place in range(len(row)):
        mask = (row[place] + offset) & HIGH_BITS
        change = mask ^ ((mask << EIGHT) | last)
        last = mask >> TOP
        while change != ZERO:
            lowest = change & (~change + ONE)
            edges[count] = 8 * place + np.int64(((lowest >> SEVEN) * PLACES) >> TOP)
            count += 1
            change ^= lowest
    return count // 2


def join_gaps(
    edges: Array,
    runs: int,
    gaps: Array,
    above: Array,
    above_runs: int,
    gaps_above: Array,
    parents: Array,
    count: int,
) -> int:
    """Label what lies between the runs of a row, 0 where it touches the rim; how many labels there are then.

    edges, gaps: of this row. above, gaps_above: of the row above. parents, count: of the labels so far.
    """
    other = 0
    for gap in range(runs + 1):
        left = edges[2 * gap - 1] if gap else 0
        label = 0 if gap == 0 or gap == runs else -1
        while other < above_runs and above[2 * other] <= left:
            other += 1
        beside = other
        while beside <= above_runs and (beside == 0 or gap == runs or above[2 * beside - 1] < edges[2 * gap]):
            label = gaps_above[beside] if label < 0 else joined(parents, label, gaps_above[beside])
            beside += 1
        if label < 0:
            label = count
            parents[label] = label
            count += 1
        gaps[gap] = label
    return count


def join_runs(
    y: int,
    edges: Array,
    runs: int,
    labels: Array,
    gaps: Array,
    above: Array,
    above_runs: int,
    labels_above: Array,
    parents: Array,
    regions: Array,
    count: int,
) -> int:
    """Label the runs of a row y; how many labels there are then.

    regions: int32 (n, 6), of each label x, y and their ends, the first pixel's x, the gap before it.
    """
    other = 0
    for run in range(runs):
        left, right = edges[2 * run], edges[2 * run + 1]
        while other < above_runs and above[2 * other + 1] < left:
            other += 1
        label = -1
        beside = other
        while beside < above_runs and above[2 * beside] <= right:
            one = root_of(parents, labels_above[beside])
            if label >= 0 and one != label:
                older, younger = min(label, one), max(label, one)
                regions[older, 0] = min(regions[older, 0], regions[younger, 0])
                regions[older, 2] = max(regions[older, 2], regions[younger, 2])
                parents[younger] = older
                one = older
            label = one
            beside += 1
        if label < 0:
            label = count
            count += 1
            parents[label] = label
            regions[label, 0], regions[label, 1], regions[label, 2] = left, y, right
            regions[label, 4], regions[label, 5] = left, gaps[run]
        regions[label, 0] = min(regions[label, 0], left)
        regions[label, 2] = max(regions[label, 2], right)
        regions[label, 3] = y + 1
        labels[run] = label
    return count
