"""Which region belongs to which track: gates by Mahalanobis distance, then the best assignment. Pure functions.

The distance of a region is that of the nearest of its extents: with and without the forearm it is the same hand.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

from lightgesture.features.track.motion import BoxState, Measured, measure
from lightgesture.features.types import HandRegion


class Innovation(NamedTuple):
    """Where a region is expected: predicted centre x, centre y, width and height, pixels, and the inverses of the
    variances of what is measured there, 1 / pixels²."""

    x: float
    y: float
    width: float
    height: float
    inverse_x: float
    inverse_y: float
    inverse_width: float
    inverse_height: float


class Match(NamedTuple):
    """A region inside a track's gate. squared: squared Mahalanobis distance of its nearest extent; measured: that
    extent."""

    squared: float
    measured: Measured


def expect(state: BoxState, centre_variance: float, size_variance: float) -> Innovation:
    """The innovation of a predicted state for measurements of these variances, pixels² (> 0)."""
    x, y, width, height = state
    return Innovation(
        x.position,
        y.position,
        width.position,
        height.position,
        1.0 / (x.p00 + centre_variance),
        1.0 / (y.p00 + centre_variance),
        1.0 / (width.p00 + size_variance),
        1.0 / (height.p00 + size_variance),
    )


def squared_distance(innovation: Innovation, measured: Measured) -> float:
    """Squared Mahalanobis distance over centre and size. The coordinates are independent: it is the sum of theirs."""
    x, y, width, height, inverse_x, inverse_y, inverse_width, inverse_height = innovation
    dx, dy = measured[0] - x, measured[1] - y
    dw, dh = measured[2] - width, measured[3] - height
    return dx * dx * inverse_x + dy * dy * inverse_y + dw * dw * inverse_width + dh * dh * inverse_height


def nearest_extent(innovation: Innovation, region: HandRegion, gate: float) -> Match | None:
    """The extent of a region that is nearest to what is expected, None if none is inside the gate.

    Beyond three times the gate's radius from the region's box the alternatives are not tried: they overlap it.
    """
    best = measure(region.box)
    least = squared_distance(innovation, best)
    if least > 9.0 * gate:
        return None
    for box in region.alternatives:
        measured = measure(box)
        squared = squared_distance(innovation, measured)
        if squared < least:
            best, least = measured, squared
    return Match(least, best) if least <= gate else None


def gated(innovation: Innovation, regions: Mapping[int, HandRegion], gate: float) -> dict[int, Match]:
    """The regions with an extent inside the gate (a squared distance), by their number."""
    matches = {}
    for index, region in regions.items():
        match = nearest_extent(innovation, region, gate)
        if match is not None:
            matches[index] = match
    return matches


def assign(
    values: Sequence[Mapping[int, float]], together: Callable[[int, int], float], most: int = 6
) -> dict[int, int]:
    """Track -> region of the greatest total value, each region once; a track may stay without.

    values: for each of at most two tracks the value of each region that it may take; below 0 none is better.
    together: what two regions are worth beyond their own values. most: best regions of each track that are tried,
    which bounds the time.
    """
    first, second = (*values, {}, {})[:2]
    best: tuple[int | None, int | None] = None, None
    best_total = 0.0
    for one in (None, *_best_first(first, most)):
        own = 0.0 if one is None else first[one]
        for other in (None, *_best_first(second, most)):
            if other is None:
                total = own
            elif other == one:
                continue
            else:
                total = own + second[other] + (0.0 if one is None else together(one, other))
            if total > best_total:
                best, best_total = (one, other), total
    return {track: index for track, index in enumerate(best) if index is not None}


def _best_first(values: Mapping[int, float], most: int) -> list[int]:
    return sorted(values, key=lambda index: (-values[index], index))[:most]


def assign_nearest(distances: Iterable[tuple[float, int, int]]) -> dict[int, int]:
    """Track -> region, the nearest two first. distances: (squared distance, track, region) of what may be matched."""
    assigned: dict[int, int] = {}
    used: set[int] = set()
    for _, track, index in sorted(distances):
        if track not in assigned and index not in used:
            assigned[track] = index
            used.add(index)
    return assigned
