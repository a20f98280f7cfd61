"""Loops over the levels of the skin map, to be compiled: what `proposals.plain_whole` finds, outline by outline.

Every level is looked at run by run (`runs.py`); an outline is followed only where it is asked for.
"""

from typing import Any, Final

import numpy as np

from lightgesture.features.compiled.runs import find_edges, join_gaps, join_runs, root_of

# Numba has no types that a type checker knows.
Array = Any

HELPERS: Final = ("root_of", "find_edges", "join_gaps", "join_runs", "follow", "mark_passed", "keep_regions")
"""What the loops call."""
ACROSS: Final = np.array((1, 1, 0, -1, -1, -1, 0, 1) * 2, np.int64)
DOWN: Final = np.array((0, -1, -1, -1, 0, 1, 1, 1) * 2, np.int64)
"""Steps to the neighbours from the right counter-clockwise, twice, so that a search need not begin again."""
UNSEEN: Final = 255
"""Pixel of a mask that no outline has passed yet."""


def follow(pixels: Array, start_x: int, start_y: int, level: int, points: Array, place: int) -> int:
    """Write the outline of the region whose first pixel is given from `place` on; the place after it, -1 where
    `points`, int32 (m, 2), is too short. It begins there, goes down the left side and is in pixels inside the rim."""
    # Nothing stands above the first pixel or left of it: clockwise from there, what comes first ends the outline.
    towards = 8
    while towards > 4 and pixels[start_y + DOWN[towards], start_x + ACROSS[towards]] < level:
        towards -= 1
    last_x, last_y = start_x + ACROSS[towards], start_y + DOWN[towards]
    is_alone = towards == 4
    x, y = start_x, start_y
    towards &= 7
    while True:
        if place >= len(points):
            return -1
        points[place, 0], points[place, 1] = x - 1, y - 1
        place += 1
        if is_alone:
            return place
        towards += 1
        while pixels[y + DOWN[towards], x + ACROSS[towards]] < level:
            towards += 1
        next_x, next_y = x + ACROSS[towards], y + DOWN[towards]
        if next_x == start_x and next_y == start_y and x == last_x and y == last_y:
            return place
        x, y, towards = next_x, next_y, (towards + 4) & 7


def mark_passed(mask: Array, points: Array, begin: int, end: int) -> Array:
    """Mark in a mask what an outline passes; twice the area that it encloses."""
    twice: Array = 0
    x, y = points[end - 1, 0], points[end - 1, 1]
    for place in range(begin, end):
        next_x, next_y = points[place, 0], points[place, 1]
        mask[next_y + 1, next_x + 1] = 1
        twice += x * next_y - next_x * y
        x, y = next_x, next_y
    return abs(twice)


def keep_regions(
    pixels: Array,
    level: int,
    parents: Array,
    gap_parents: Array,
    regions: Array,
    limits: Array,
    shortest: int,
    scratch: Array,
    found: Array,
    count: int,
    outlines: int,
) -> tuple[int, int]:
    """Put the regions of a level that lie in no other's hole and have a hand's size behind the first `count` of
    `found`; how many there are then, and how many outlines were met.

    parents: of the level's labels. The rest: see `nodes`.
    """
    # From below, as OpenCV tells them.
    for label in range(len(parents) - 1, -1, -1):
        if parents[label] != label or root_of(gap_parents, regions[label, 5]) != 0:
            continue
        outlines += 1
        x, y = regions[label, 0], regions[label, 1]
        wide, tall = regions[label, 2] - x, regions[label, 3] - y
        short, long = min(wide, tall), max(wide, tall)
        if count == len(found) or short < limits[0] or long > limits[1] or long > limits[2] * short:
            continue
        # There and back along the longer side is enough, mostly.
        if 2 * long - 2 < shortest and follow(pixels, regions[label, 4], y, level, scratch, 0) < shortest:
            continue
        found[count, 0], found[count, 1], found[count, 2], found[count, 3] = x - 1, y - 1, wide, tall
        found[count, 4], found[count, 5], found[count, 6] = regions[label, 4], y, level
        count += 1
    return count, outlines


def nodes(
    pixels: Array, words: Array, levels: int, limits: Array, most: int, most_outlines: int, shortest: int
) -> Array:
    """int32 (n, 7): the regions of `proposals.plain_whole` before those that nearly agree are dropped: box, first pixel
    inside the rim, level.

    pixels: uint8 (h + 2, w'), how many thresholds each pixel reaches, at most 127, in a rim of zeros. words: the same,
    uint64 (h + 2, w' / 8). limits: float64 (3,), shortest and longest side and largest aspect of a box.
    """
    height, width = pixels.shape
    edges = np.empty((2, width + 2), np.int32)
    labels, gaps = np.empty((2, width // 2 + 2), np.int32), np.empty((2, width // 2 + 2), np.int32)
    room = height * (width // 2 + 1) + 1
    parents, gap_parents, regions = (
        np.empty(room, np.int32),
        np.empty(room, np.int32),
        np.empty((room, 6), np.int32),
    )
    # Of an outline that is followed only to be counted: it passes a pixel once for each of its four sides at most.
    scratch = np.empty((4 * (shortest // 2 + 1) ** 2, 2), np.int32)
    found = np.empty((most, 7), np.int32)
    highest = np.zeros(height, np.int64)
    for y in range(height):
        for x in range(width):
            highest[y] = max(highest[y], pixels[y, x])
    count, outlines, level = 0, 0, levels
    while level > 1 and count < most and outlines < most_outlines:
        level -= 1
        gap_parents[0], gaps[0, 0] = 0, 0
        runs, label_count, gap_count = 0, 0, 1
        for y in range(1, height):
            now, old, runs_above = y & 1, 1 - (y & 1), runs
            if highest[y] < level and runs_above == 0:
                gaps[now, 0] = 0
                continue
            runs = find_edges(words[y], level, edges[now])
            gap_count = join_gaps(
                edges[now], runs, gaps[now], edges[old], runs_above, gaps[old], gap_parents, gap_count
            )
            label_count = join_runs(
                y,
                edges[now],
                runs,
                labels[now],
                gaps[now],
                edges[old],
                runs_above,
                labels[old],
                parents,
                regions,
                label_count,
            )
        count, outlines = keep_regions(
            pixels,
            level,
            parents[:label_count],
            gap_parents,
            regions,
            limits,
            shortest,
            scratch,
            found,
            count,
            outlines,
        )
    return found[:count].copy()


def outlines(pixels: Array, chosen: Array) -> tuple[Array, Array]:
    """int32 (m, 2), outlines of regions one after the other, and int64 (n + 1,), where each begins.

    pixels: see `nodes`. chosen: rows of what it gives.
    """
    points = np.empty((4096, 2), np.int32)
    starts = np.zeros(len(chosen) + 1, np.int64)
    for index in range(len(chosen)):
        x, y, level = chosen[index, 4], chosen[index, 5], chosen[index, 6]
        place = follow(pixels, x, y, level, points, starts[index])
        while place < 0:
            more = np.empty((2 * len(points), 2), np.int32)
            for point in range(starts[index]):
                more[point, 0], more[point, 1] = points[point, 0], points[point, 1]
            points = more
            place = follow(pixels, x, y, level, points, starts[index])
        starts[index + 1] = place
    return points[: starts[-1]], starts


def largest_parts(whole: Array, rows: Array, boxes: Array, wanted: Array, lowest: int) -> tuple[Array, Array]:
    """The largest part of each wanted mask: int32 (m, 2), outlines one after the other, and int32 (k, 7): where each
    begins, how many points it has, of which mask it is, its box.

    whole, rows: masks without holes one below the other, see `outlines.masks`; what is passed is marked in them.
    boxes: int32 (n, 4), of each within its border. wanted: bool (n,). lowest: a part must be as high.
    """
    # An outline passes a pixel once for each of its four sides at most.
    points = np.empty((4 * whole.size + 1, 2), np.int32)
    found = np.empty((len(boxes), 7), np.int32)
    count, begin = 0, 0
    for index in range(len(boxes)):
        if not wanted[index]:
            continue
        mask = whole[rows[index, 0] : rows[index + 1, 0]]
        best, end = -1, begin
        for y in range(1, mask.shape[0] - 1):
            for x in range(1, boxes[index, 2] + 1):
                # A run that begins in a pixel that no outline has passed is a part's first.
                if mask[y, x] != UNSEEN or mask[y, x - 1] != 0:
                    continue
                place = follow(mask, x, y, 1, points, end)
                twice = mark_passed(mask, points, end, place)
                # From below the first of the largest: from above the last.
                if twice >= best:
                    best = twice
                    for step in range(place - end):
                        points[begin + step, 0], points[begin + step, 1] = (
                            points[end + step, 0],
                            points[end + step, 1],
                        )
                    end = begin + place - end
        if best >= 0:
            shift_x, shift_y = boxes[index, 0], boxes[index, 1]
            left, top, right, bottom = points[begin, 0], points[begin, 1], points[begin, 0], points[begin, 1]
            for place in range(begin, end):
                left, right = min(left, points[place, 0]), max(right, points[place, 0])
                bottom = max(bottom, points[place, 1])
                points[place, 0] += shift_x
                points[place, 1] += shift_y
            if bottom - top + 1 >= lowest:
                found[count, 0], found[count, 1], found[count, 2] = begin, end - begin, index
                found[count, 3], found[count, 4] = left + shift_x, top + shift_y
                found[count, 5], found[count, 6] = right - left + 1, bottom - top + 1
                begin = end
                count += 1
    return points[:begin].copy(), found[:count].copy()
