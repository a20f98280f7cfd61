"""Loops over pixels, cells, boxes and trees, to be compiled: what `PLAIN` of each stage computes, byte for byte.

As Python they run too, some hundred times as slow; `loops.py` has numba compile them. All numbers are whole
up to the last division, so that the order in which they are added changes nothing.
"""

from typing import Any

import numpy as np

from lightgesture.features.find.cells import (
    CELLS,
    CONTEXT_TENTHS,
    DIRECTIONS,
    GRADIENT_FLOOR,
    LUMA_FLOOR,
    PART,
)
from lightgesture.features.find.proposals import SAME_HUNDREDTHS

# Numba has no types that a type checker knows.
Array = Any

HELPERS = ("slopes",)
"""What the loops call."""
COUNT = CELLS * CELLS
NONE, QUARTER, STRONGEST = np.float32(0.0), np.float32(0.25), np.float32(255.0)
NEAR, FAR = np.float32(12.0), np.float32(29.0)
STEP_UNIT = 10 * CELLS
FIRST_STEP = 5 * CELLS - CELLS * CONTEXT_TENTHS // 2


def slopes(luma: Array, y: int, smooth: Array, slope: Array) -> None:
    """Write what a row of Sobel's derivatives is made of, float32 (w + 2,): the rows round y by 1-2-1 and the last less
    the first, with a pixel more at either end."""
    height, width = luma.shape
    # At the rim the pixel on the other side counts twice, as in OpenCV.
    above = luma[abs(y - 1) if height > 1 else 0]
    here = luma[y]
    below = luma[y + 1 if y + 1 < height else max(height - 2, 0)]
    for x in range(width):
        first, last = np.float32(above[x]), np.float32(below[x])
        smooth[x + 1] = first + np.float32(2.0) * np.float32(here[x]) + last
        slope[x + 1] = last - first
    inner, outer = min(2, width), max(width - 1, 1)
    smooth[0], smooth[width + 1] = smooth[inner], smooth[outer]
    slope[0], slope[width + 1] = slope[inner], slope[outer]


def sums(luma: Array, skin: Array, found: Array) -> None:
    """See `cells.CellLoops`."""
    height, width = luma.shape
    found[:, 0, :] = 0
    columns = np.zeros((2 + DIRECTIONS, width), np.int32)
    smooth, slope = np.empty(width + 2, np.float32), np.empty(width + 2, np.float32)
    # Single precision holds all these whole numbers; each of these loops is one of vectors.
    for y in range(height):
        slopes(luma, y, smooth, slope)
        for x in range(width):
            columns[0, x] += luma[y, x]
            columns[1, x] += skin[y, x]
        for x in range(width):
            along_x = smooth[x + 2] - smooth[x]
            along_y = slope[x] + np.float32(2.0) * slope[x + 1] + slope[x + 2]
            strength = np.sqrt(along_x * along_x + along_y * along_y) * QUARTER
            magnitude = np.int32(strength if strength < STRONGEST else STRONGEST)
            wide, tall = abs(along_x), abs(along_y)
            is_wide, is_tall = FAR * tall < NEAR * wide, FAR * wide < NEAR * tall
            is_rising = (along_x < NONE) == (along_y < NONE)
            is_slanted = not (is_wide or is_tall)
            columns[2, x] += magnitude if is_wide else np.int32(0)
            columns[3, x] += magnitude if is_slanted and is_rising else np.int32(0)
            columns[4, x] += magnitude if is_tall else np.int32(0)
            columns[5, x] += magnitude if is_slanted and not is_rising else np.int32(0)
        for plane in range(2 + DIRECTIONS):
            total: Array = 0
            found[plane, y + 1, 0] = 0
            for x in range(width):
                total += columns[plane, x]
                found[plane, y + 1, x + 1] = total


def cells(summed: Array, boxes: Array) -> Array:
    """See `cells.CellLoops`."""
    planes, height, width = summed.shape
    found = np.empty((len(boxes), (3 + DIRECTIONS) * COUNT), np.float32)
    means = np.empty((3 + DIRECTIONS, COUNT), np.int64)
    columns, rows = np.empty(CELLS + 1, np.int64), np.empty(CELLS + 1, np.int64)
    for index in range(len(boxes)):
        for k in range(CELLS + 1):
            step = k * CONTEXT_TENTHS + FIRST_STEP
            column = (STEP_UNIT * boxes[index, 0] + boxes[index, 2] * step + STEP_UNIT // 2) // STEP_UNIT
            row = (STEP_UNIT * boxes[index, 1] + boxes[index, 3] * step + STEP_UNIT // 2) // STEP_UNIT
            columns[k] = min(max(column, 0), width - 1)
            rows[k] = min(max(row, 0), height - 1)
        for i in range(CELLS):
            for j in range(CELLS):
                x0, x1, y0, y1 = columns[j], columns[j + 1], rows[i], rows[i + 1]
                area = (x1 - x0) * (y1 - y0)
                half, divisor = area // 2, max(area, 1)
                cell = i * CELLS + j
                strength = 0
                for plane in range(planes):
                    total = np.int64(summed[plane, y1, x1]) - summed[plane, y1, x0]
                    total += np.int64(summed[plane, y0, x0]) - summed[plane, y0, x1]
                    mean = (total * PART + half) // divisor
                    if plane < 2:
                        means[plane, cell] = mean
                    else:
                        means[plane + 1, cell] = mean
                        strength += total
                means[2, cell] = (strength * PART + half) // divisor
        total, squares, strengths = 0, 0, 0
        for cell in range(COUNT):
            total += means[0, cell]
            squares += means[0, cell] * means[0, cell]
            strengths += means[2, cell]
        spread = np.sqrt(np.float64(COUNT * squares - total * total)) + COUNT * LUMA_FLOOR
        gradient = np.float64(strengths + COUNT * GRADIENT_FLOOR)
        for cell in range(COUNT):
            found[index, cell] = (COUNT * means[0, cell] - total) / spread
            found[index, COUNT + cell] = means[1, cell] / np.float64(255 * PART)
            for plane in range(2, 3 + DIRECTIONS):
                found[index, plane * COUNT + cell] = (COUNT * means[plane, cell]) / gradient
    return found


def distinct(boxes: Array, most: int) -> Array:
    """See `proposals.Distinct`."""
    kept = np.empty(min(most, len(boxes)), np.int64)
    count = 0
    for index in range(len(boxes)):
        if count == most:
            break
        x, y, width, height = boxes[index, 0], boxes[index, 1], boxes[index, 2], boxes[index, 3]
        is_new = True
        for place in range(count):
            other = boxes[kept[place]]
            across = min(x + width, other[0] + other[2]) - max(x, other[0])
            down = min(y + height, other[1] + other[3]) - max(y, other[1])
            both = max(across, 0) * max(down, 0)
            areas = width * height + other[2] * other[3]
            if (100 + SAME_HUNDREDTHS) * both > SAME_HUNDREDTHS * areas:
                is_new = False
                break
        if is_new:
            kept[count] = index
            count += 1
    return kept[:count].copy()


def walk(
    roots: Array, feature: Array, threshold: Array, first: Array, leaf: Array, depth: int, rows: Array
) -> Array:
    """See `trees.Walk`, with the fields of the trees one by one, of unsigned numbers where they name places."""
    count = len(rows)
    found = np.zeros(count + 3, np.int64)
    for tree in range(len(roots)):
        # Four rows at once, the last perhaps again, as none of their steps waits for another's.
        for row in range(0, count, 4):
            one, other = rows[row], rows[min(row + 1, count - 1)]
            third, fourth = rows[min(row + 2, count - 1)], rows[min(row + 3, count - 1)]
            a = np.uint64(roots[tree])
            b, c, d = a, a, a
            for _ in range(depth):
                a = first[a] + np.uint32(one[feature[a]] > threshold[a])
                b = first[b] + np.uint32(other[feature[b]] > threshold[b])
                c = first[c] + np.uint32(third[feature[c]] > threshold[c])
                d = first[d] + np.uint32(fourth[feature[d]] > threshold[d])
            found[row] += leaf[a]
            found[row + 1] += leaf[b]
            found[row + 2] += leaf[c]
            found[row + 3] += leaf[d]
    return found[:count].copy()
