"""Loops over outlines and the pixels inside them, to be compiled: areas, and where arms leave palms (`forearms.py`).

The masks of a frame's regions stand one below the other in one picture, so that OpenCV is asked once for the distances.
"""

from typing import Any, Final

import numpy as np

from lightgesture.features.find.cells import SHAPE_NUMBERS
from lightgesture.features.find.forearms import ARM_RING, ARM_TOP

# Numba has no types that a type checker knows.
Array = Any

HELPERS: Final = ("twice_beside", "fill", "sum_arm")
"""What the loops call."""


def twice_beside(sides: Array, count: int, sign: int, chain: Array) -> Array:
    """Twice the area between an axis and the convex line on the far side of `sides`, an x for each of `count` rows.

    sign: 1 for the right side, -1 for the left one. chain: room for the rows that the line bends at.
    """
    kept = 0
    for row in range(count):
        while kept > 1:
            first, middle = chain[kept - 2], chain[kept - 1]
            bend = (sides[middle] - sides[first]) * (row - first) - (sides[row] - sides[first]) * (
                middle - first
            )
            if sign * bend > 0:
                break
            kept -= 1
        chain[kept] = row
        kept += 1
    total: int = 0
    for index in range(1, kept):
        first, row = chain[index - 1], chain[index]
        total += (sides[first] + sides[row]) * (row - first)
    return total


def shapes(
    points: Array, starts: Array, lengths: Array, boxes: Array, cut: Array, across: int, down: int
) -> Array:
    """See `cells.CellLoops`, with the fields of the regions one by one."""
    tallest: Array = 1
    for index in range(len(boxes)):
        tallest = max(tallest, boxes[index, 3])
    low, high, chain = np.empty(tallest, np.int64), np.empty(tallest, np.int64), np.empty(tallest, np.int64)
    found = np.empty((len(boxes), SHAPE_NUMBERS), np.float32)
    shorter = min(across, down)
    for index in range(len(boxes)):
        left, top, width, rows = boxes[index, 0], boxes[index, 1], boxes[index, 2], boxes[index, 3]
        for row in range(rows):
            low[row], high[row] = left + width, left
        first, end = starts[index], starts[index] + lengths[index]
        x, y = np.int64(points[end - 1, 0]), np.int64(points[end - 1, 1])
        twice: Array = 0
        for place in range(first, end):
            next_x, next_y = np.int64(points[place, 0]), np.int64(points[place, 1])
            twice += x * next_y - next_x * y
            x, y = next_x, next_y
            low[y - top], high[y - top] = min(low[y - top], x), max(high[y - top], x)
        area = abs(twice) * 0.5
        hull = (twice_beside(high, rows, 1, chain) - twice_beside(low, rows, -1, chain)) * 0.5
        found[index, 0] = (left + width / 2) / across
        found[index, 1] = (top + rows / 2) / down
        found[index, 2] = width / shorter
        found[index, 3] = rows / shorter
        found[index, 4] = width / rows
        found[index, 5] = area / (width * rows)
        found[index, 6] = area / max(hull, 1.0)
        found[index, 7] = lengths[index] / np.sqrt(max(area, 1.0))
        found[index, 8] = 1.0 if cut[index] else 0.0
    return found


def fill(mask: Array, points: Array, left: int, top: int) -> int:
    """Set a mask of zeros to 255 on an outline, int32 (k, 2), and inside it; how many pixels these are.

    left, top: of the mask in the outline's picture.
    """
    x, y = points[-1, 0] - left, points[-1, 1] - top
    for place in range(len(points)):
        next_x, next_y = points[place, 0] - left, points[place, 1] - top
        # Where the outline leaves a row upwards or enters it from below, inside and outside change places.
        if next_y > y:
            mask[y, x] ^= 2
        elif next_y < y:
            mask[next_y, next_x] ^= 2
        mask[next_y, next_x] |= 1
        x, y = next_x, next_y
    count = 0
    for row in range(mask.shape[0]):
        inside = 0
        for column in range(mask.shape[1]):
            inside ^= mask[row, column] & 2
            is_in = inside | (mask[row, column] & 1)
            mask[row, column] = 255 if is_in else 0
            count += 1 if is_in else 0
    return count


def sum_arm(mask: Array, top: int, x: int, y: int, disc: Array) -> tuple[int, int, int]:
    """How many pixels of a mask from the row `top` on lie outside a disc round (x, y), and the sums of their columns
    and of their rows below `top`. disc: its half widths in the rows from the middle on, -1 beyond it."""
    area, across, down = 0, 0, 0
    for row in range(top, mask.shape[0]):
        half = disc[min(abs(row - y), len(disc) - 1)]
        count, columns = 0, 0
        for column in range(mask.shape[1]):
            is_arm = mask[row, column] != 0 and (column < x - half or column > x + half)
            count += 1 if is_arm else 0
            columns += column if is_arm else 0
        area += count
        across += columns
        down += count * (row - top)
    return area, across, down


def masks(points: Array, starts: Array, lengths: Array, boxes: Array) -> tuple[Array, Array]:
    """uint8 (h, w): masks of regions, with an empty border round each box, one below the other, and int64 (n + 1, 2):
    the row in which each begins, and its pixels.

    points, starts, lengths, boxes: of `Proposals`.
    """
    found = np.zeros((len(boxes) + 1, 2), np.int64)
    widest: Array = 0
    for index in range(len(boxes)):
        found[index + 1, 0] = found[index, 0] + boxes[index, 3] + 2
        widest = max(widest, boxes[index, 2] + 2)
    whole = np.zeros((found[-1, 0], widest), np.uint8)
    for index in range(len(boxes)):
        mask = whole[found[index, 0] : found[index + 1, 0], : boxes[index, 2] + 2]
        outline = points[starts[index] : starts[index] + lengths[index]]
        found[index, 1] = fill(mask, outline, boxes[index, 0] - 1, boxes[index, 1] - 1)
    return whole, found


def arms(whole: Array, rows: Array, boxes: Array, distances: Array, discs: Array) -> Array:
    """float64 (n, 7): of each mask the palm's centre x and y and its radius, the row from which on an arm counts, -1
    without any, and what `sum_arm` gives.

    whole, rows: of `masks`. boxes: of `Proposals`. distances: float32 (h, w), of each pixel to the rim. discs: int32
    (r, m), see `sum_arm`, of each radius.
    """
    found = np.zeros((len(rows) - 1, 7), np.float64)
    for index in range(len(found)):
        width = boxes[index, 2] + 2
        mask = whole[rows[index, 0] : rows[index + 1, 0], :width]
        distance = distances[rows[index, 0] : rows[index + 1, 0], :width]
        x, y, best = 0, 0, np.float32(-1.0)
        for row in range(distance.shape[0]):
            for column in range(distance.shape[1]):
                if distance[row, column] > best:
                    x, y, best = column, row, distance[row, column]
        radius = np.float64(best)
        found[index, 0], found[index, 1], found[index, 2], found[index, 3] = x, y, radius, -1.0
        top: Array = np.int64(y + ARM_TOP * radius)
        if top < mask.shape[0]:
            found[index, 3] = top
            disc = discs[np.int64(np.rint(ARM_RING * radius))]
            found[index, 4], found[index, 5], found[index, 6] = sum_arm(mask, top, x, y, disc)
    return found


def colours(picture: Array, whole: Array, rows: Array, boxes: Array) -> Array:
    """float64 (n, 3): see `proposals.RegionLoops`. whole, rows: of `masks`."""
    found = np.empty((len(boxes), 3), np.float64)
    for index in range(len(boxes)):
        left, top = boxes[index, 0], boxes[index, 1]
        first: Array = 0
        second: Array = 0
        third: Array = 0
        for y in range(boxes[index, 3]):
            row = whole[rows[index, 0] + y + 1]
            for x in range(boxes[index, 2]):
                if row[x + 1] != 0:
                    first += picture[top + y, left + x, 0]
                    second += picture[top + y, left + x, 1]
                    third += picture[top + y, left + x, 2]
        share = 1.0 / rows[index, 1]
        found[index, 0], found[index, 1], found[index, 2] = first * share, second * share, third * share
    return found


def overlaps(boxes: Array) -> Array:
    """float64 (n, n): see `proposals.RegionLoops`."""
    count = len(boxes)
    found = np.empty((count, count), np.float64)
    for one in range(count):
        x, y, width, height = boxes[one, 0], boxes[one, 1], boxes[one, 2], boxes[one, 3]
        for other in range(one + 1):
            across = min(x + width, boxes[other, 0] + boxes[other, 2]) - max(x, boxes[other, 0])
            down = min(y + height, boxes[other, 1] + boxes[other, 3]) - max(y, boxes[other, 1])
            both = max(across, 0) * max(down, 0)
            union = width * height + boxes[other, 2] * boxes[other, 3] - both
            found[one, other] = both / max(np.float64(union), 1e-9)
            found[other, one] = found[one, other]
    return found


def sampled(points: Array, starts: Array, lengths: Array, count: int) -> tuple[Array, Array]:
    """See `bank.BankLoops`."""
    found = np.empty((len(starts), 2 * count), np.float32)
    highest = np.zeros(len(starts), np.int64)
    for index in range(len(starts)):
        total_x: Array = 0
        total_y: Array = 0
        top = points[starts[index], 1]
        for place in range(count):
            point = starts[index] + lengths[index] * place // count
            total_x += points[point, 0]
            total_y += points[point, 1]
            if points[point, 1] < top:
                top, highest[index] = points[point, 1], place
            found[index, place], found[index, count + place] = points[point, 0], points[point, 1]
        middle_x = np.float32(total_x) / np.float32(count)
        middle_y = np.float32(total_y) / np.float32(count)
        for place in range(count):
            found[index, place] -= middle_x
            found[index, count + place] -= middle_y
    return found, highest


def turned(coefficients: Array, start: Array, shifts: Array) -> Array:
    """See `bank.BankLoops`."""
    count, half = len(coefficients), coefficients.shape[1] // 2
    found = np.empty((count, 2 * half), np.float32)
    for index in range(count):
        for place in range(half):
            real, imaginary = coefficients[index, place], coefficients[index, half + place]
            cosine, sine = shifts[0, start[index], place], shifts[1, start[index], place]
            found[index, place] = real * cosine - imaginary * sine
            found[index, half + place] = real * sine + imaginary * cosine
    return found
