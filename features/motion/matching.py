"""A drawn line against a data base of shapes, by iterative closest point.

Besl and McKay, "A method for registration of 3-D shapes", IEEE TPAMI 14(2), 1992: each point of the one curve is given
the nearest of the other, the transformation that brings the two nearest is found in closed form (Umeyama, IEEE TPAMI
13(4), 1991), and both are done again until nothing changes. Xu, Dudek and Sattar (ICRA 2008) match the motions of
fiducial markers so. A third coordinate, how much of the way is done, makes a circle that is gone round the other way
far from this one (invariant features, Sharp, Lee and Wehe, IEEE TPAMI 24(1), 2002), and no transformation changes it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.motion.shapes import Curve


@dataclass(frozen=True, slots=True, kw_only=True)
class MatchSettings:
    """What is taken for the same shape."""

    points: int = 32
    """Of both curves, evenly along the way."""
    progress: float = 2.0
    """How far apart, in spreads of the shape, its beginning and its end are by the third coordinate. Less: a point may
    find its partner anywhere on the line; more: only where it should be by the way that is done."""
    most_turn_deg: float = 20.0
    """Most that a shape may be turned, 0 to 90: beyond 45 a way to the side is one up."""
    rounds: int = 12
    """Most rounds of closest points."""
    most_distance: float = 0.28
    """Root mean square distance of partners from which on it is another shape, in spreads of the shape. Less: tidier
    motions; more: what was not meant may be read."""
    least_lead: float = 0.03
    """By how much the next shape must be farther, in spreads. Less: more is read, and more is taken for another."""


@dataclass(frozen=True, slots=True)
class Match:
    """The nearest shape. distance: to it; next_distance: to the nearest of another name, in spreads of the shape."""

    name: str
    distance: float
    next_distance: float

    def is_sure(self, settings: MatchSettings) -> bool:
        """Whether it is near enough, and no other is as near."""
        is_near = self.distance <= settings.most_distance
        return is_near and self.next_distance - self.distance >= settings.least_lead


class ShapeBase:
    """Shapes ready to be compared with. shapes: name -> the ways in which it may be drawn, one at least."""

    def __init__(self, shapes: Mapping[str, Sequence[Curve]], settings: MatchSettings | None = None) -> None:
        self.settings = settings or MatchSettings()
        self.names = tuple(shapes)
        self._owners = [name for name, curves in shapes.items() for _ in curves]
        count = self.settings.points
        self._shapes = np.array([_standard(curve, count) for curves in shapes.values() for curve in curves])

    def match(self, curve: Curve) -> Match:
        """The nearest shape to a line, float64 (n, 2), n from 2, which goes somewhere."""
        distances = closest_points(_standard(curve, self.settings.points), self._shapes, self.settings)
        nearest: dict[str, float] = {}
        for name, distance in zip(self._owners, distances.tolist(), strict=True):
            nearest[name] = min(distance, nearest.get(name, np.inf))
        first, *rest = sorted(nearest, key=lambda name: nearest[name])
        return Match(first, nearest[first], nearest[rest[0]] if rest else np.inf)


def closest_points(drawn: Curve, shapes: NDArray[np.float64], settings: MatchSettings) -> NDArray[np.float64]:
    """Root mean square distance of partners, both ways, after `drawn` was turned, moved and scaled to fit each shape.

    drawn (n, 2), shapes (k, n, 2): as `resampled`, about their middle and of unit spread. Gives (k,).
    """
    progress = np.linspace(0.0, settings.progress, len(drawn))
    apart = (progress[:, None] - progress[None, :]) ** 2
    moved = np.broadcast_to(drawn, shapes.shape)
    best = np.full(len(shapes), np.inf)
    rows = np.arange(len(shapes))[:, None]
    for _ in range(settings.rounds):
        squares = ((moved[:, :, None] - shapes[:, None, :]) ** 2).sum(axis=3) + apart
        there, back = squares.argmin(axis=2), squares.argmin(axis=1)
        mean = 0.5 * (squares.min(axis=2).mean(axis=1) + squares.min(axis=1).mean(axis=1))
        before, best = best, np.minimum(best, np.sqrt(mean))
        if (before - best < 1e-3).all():
            break
        source = np.concatenate([np.broadcast_to(drawn, shapes.shape), drawn[back]], axis=1)
        target = np.concatenate([shapes[rows, there], shapes], axis=1)
        moved = _fitted(drawn, source, target, settings.most_turn_deg)
    return best


def _fitted(
    curve: Curve, source: NDArray[np.float64], target: NDArray[np.float64], most_turn_deg: float
) -> NDArray[np.float64]:
    """The curve moved, (k, n, 2), as brings the points `source` (k, m, 2) nearest to `target`: similarities with a
    bounded turn and a scale from a half to two."""
    from_middle, to_middle = source.mean(axis=1, keepdims=True), target.mean(axis=1, keepdims=True)
    # As complex numbers a similarity is one factor: its angle is the turn, its size the scale.
    a, b = _complex(source - from_middle), _complex(target - to_middle)
    factor = (a.conj() * b).sum(axis=1) / np.maximum((np.abs(a) ** 2).sum(axis=1), 1e-9)
    limit = np.radians(most_turn_deg)
    factor = np.clip(np.abs(factor), 0.5, 2.0) * np.exp(1j * np.clip(np.angle(factor), -limit, limit))
    moved = _complex(curve - from_middle) * factor[:, None] + _complex(to_middle)
    return np.stack([moved.real, moved.imag], axis=-1)


def _complex(points: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Points (..., 2) as complex numbers."""
    return np.asarray(points[..., 0] + 1j * points[..., 1], np.complex128)


def resampled(curve: Curve, count: int) -> Curve:
    """So many points evenly along a line (n, 2), n from 2, whatever the speed at which it was drawn."""
    steps = np.hypot(*np.diff(curve, axis=0).T)
    way = np.concatenate([[0.0], steps.cumsum()])
    places = np.linspace(0.0, way[-1], count)
    return np.column_stack([np.interp(places, way, curve[:, axis]) for axis in (0, 1)])


def _standard(curve: Curve, count: int) -> Curve:
    """Evenly spaced, about its middle and of unit spread (root mean square distance from the middle)."""
    points = resampled(curve, count)
    points = points - points.mean(axis=0)
    spread = float(np.sqrt((points**2).sum(axis=1).mean()))
    return np.asarray(points / max(spread, 1e-9))
