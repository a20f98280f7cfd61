"""Arrows between two states, and the search for the one that covers least of what is drawn already."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float]
Rect = tuple[float, float, float, float]
"""x, y, width, height."""
Path = tuple[Point, ...]

BOWS: Final = (0.0, 40.0, -40.0, 70.0, -70.0, 110.0, -110.0, 160.0, -160.0, 220.0, -220.0)
"""How far an arrow may bend to the side, pixels."""

PLACES: Final = (0.5, 0.4, 0.6, 0.3, 0.7, 0.22, 0.78)
"""Shares of an arrow's length at which its label may stand."""


# What is covered costs so much.

LABEL_ON_LABEL: Final = 100.0
"""A label over another one or over a state."""
POINT_IN_LABEL: Final = 20.0
"""A point of an arrow, of which there are about 20, in a label or a state."""
LABEL_ON_POINT: Final = 5.0
"""A point of another arrow under a label."""
OUTSIDE: Final = 200.0
"""A point, or a label, that leaves the picture."""
PIXEL: Final = 0.01
"""Of length."""


class Ground:
    """What is drawn already.

    rects: labels and texts. states: the middles of circles of this radius. arrows: their points.
    """

    def __init__(
        self, rects: Sequence[Rect], states: Sequence[Point], radius: float, arrows: Sequence[Path]
    ) -> None:
        self._radius = radius
        self._rects = np.array(rects).reshape(-1, 4)
        self._states = np.array(states).reshape(-1, 2)
        self._points = np.array([point for arrow in arrows for point in arrow]).reshape(-1, 2)

    def best_arrow(self, start: Point, end: Point, label: tuple[float, float]) -> tuple[Path, Point]:
        """The arrow from state to state, and the middle of its label of this width and height, that cover least."""
        near = self._near(start, end, label)
        options = (
            (cost + near._under_label(middle, label), path, middle)
            for path in _bows(start, end, self._radius)
            for cost in [near._under_arrow(path)]
            for middle in (path[round(share * (len(path) - 1))] for share in PLACES)
        )
        _, path, middle = min(options, key=lambda option: option[0])
        return path, middle

    def _near(self, start: Point, end: Point, label: tuple[float, float]) -> "Ground":
        """Only what an arrow between two points could meet."""
        reach = max(BOWS) + max(label)
        low = np.minimum(start, end) - reach
        high = np.maximum(start, end) + reach
        part = Ground((), (), self._radius, ())
        is_near = (self._rects[:, :2] < high) & (self._rects[:, :2] + self._rects[:, 2:] > low)
        part._rects = self._rects[is_near.all(axis=1)]
        part._states = self._states[((self._states > low) & (self._states < high)).all(axis=1)]
        part._points = self._points[((self._points > low) & (self._points < high)).all(axis=1)]
        return part

    def _under_arrow(self, path: Path) -> float:
        points = np.array(path)
        through = int(_within(points[:, None], self._rects).sum())
        apart = np.hypot(*np.moveaxis(points[:, None] - self._states, -1, 0))
        through += int((apart < self._radius - 1).sum())
        outside = int((points < 0).any(axis=1).sum())
        length = sum(math.dist(one, other) for one, other in pairwise(path))
        return POINT_IN_LABEL * through + OUTSIDE * outside + PIXEL * length

    def _under_label(self, middle: Point, size: tuple[float, float]) -> float:
        corner, sides = np.array(middle) - np.array(size) / 2, np.array(size)
        rects = self._rects
        covered = int(
            ((rects[:, :2] < corner + sides) & (corner < rects[:, :2] + rects[:, 2:])).all(axis=1).sum()
        )
        near = np.abs(self._states - middle) < sides / 2 + self._radius
        covered += int(near.all(axis=1).sum())
        arrows = int(_within(self._points, np.array([*corner, *sides])).sum())
        return LABEL_ON_LABEL * covered + LABEL_ON_POINT * arrows + OUTSIDE * bool((corner < 0).any())


def _bows(start: Point, end: Point, radius: float) -> Iterator[Path]:
    """Arrows from state to state, the straight one first."""
    across, down = end[0] - start[0], end[1] - start[1]
    length = math.hypot(across, down)
    normal = (down / length, -across / length)
    for bow in BOWS:
        top = (start[0] + across / 2 + normal[0] * bow * 2, start[1] + down / 2 + normal[1] * bow * 2)
        curve = quadratic([start, top, end])
        yield tuple(point for point in curve if min(math.dist(point, start), math.dist(point, end)) >= radius)


def _within(points: NDArray[np.float64], rects: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether points (..., 2) lie in rectangles (..., 4), broadcast."""
    offset = points - rects[..., :2]
    return np.asarray(((offset > 0) & (offset < rects[..., 2:])).all(axis=-1))


def on_circle(middle: Point, radius: float, degrees: float) -> Point:
    """A point of a circle, clockwise from the right."""
    angle = math.radians(degrees)
    return middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle)


def quadratic(points: Sequence[Point]) -> list[Point]:
    """25 points of a Bézier curve of three."""
    (a, b), (c, d), (e, f) = points
    parts = [part / 24 for part in range(25)]
    return [
        (
            (1 - t) ** 2 * a + 2 * t * (1 - t) * c + t * t * e,
            (1 - t) ** 2 * b + 2 * t * (1 - t) * d + t * t * f,
        )
        for t in parts
    ]


def cubic(points: Sequence[Point]) -> list[Point]:
    """25 points of a Bézier curve of four."""
    first, second = points[:3], points[1:]
    return [
        ((1 - t) * one[0] + t * other[0], (1 - t) * one[1] + t * other[1])
        for t, one, other in zip(
            [part / 24 for part in range(25)], quadratic(first), quadratic(second), strict=True
        )
    ]
