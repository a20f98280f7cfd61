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

from lightgesture.features.motion.shapes import Curve


@dataclass(frozen=True, slots=True, kw_only=True)
class MatchSettings:
    """What is taken for the same shape."""

    points: int = 40
    """Of both curves, evenly along the way."""
    progress: float = 1.2
    """How far apart, in spreads of the shape, its beginning and its end are by the third coordinate. Less: a point may
    find its partner anywhere on the line; more: only where it should be by the way that is done."""
    most_turn_deg: float = 20.0
    """Most that a shape may be turned, 0 to 90: beyond 45 a way to the side is one up."""
    rounds: int = 12
    """Most rounds of closest points."""
    most_distance: float = 0.26
    """Root mean square distance of partners from which on it is another shape, in spreads of the shape. Less: tidier
    motions; more: what was not meant may be read."""
    least_lead: float = 0.05
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
    """Shapes ready to be compared with. shapes: name -> the ways in which it may be drawn."""

    def __init__(self, shapes: Mapping[str, Sequence[Curve]], settings: MatchSettings | None = None) -> None:
        self.settings = settings or MatchSettings()
        self.names = tuple(shapes)
        self._shapes = [
            (name, _standard(curve, self.settings.points))
            for name, curves in shapes.items()
            for curve in curves
        ]

    def match(self, curve: Curve) -> Match:
        """The nearest shape to a line, float64 (n, 2), n from 2, which goes somewhere."""
        drawn = _standard(curve, self.settings.points)
        nearest: dict[str, float] = {}
        for name, shape in self._shapes:
            distance = closest_points(drawn, shape, self.settings)
            nearest[name] = min(distance, nearest.get(name, np.inf))
        first, *rest = sorted(nearest, key=lambda name: nearest[name])
        return Match(first, nearest[first], nearest[rest[0]] if rest else np.inf)


def closest_points(drawn: Curve, shape: Curve, settings: MatchSettings) -> float:
    """Root mean square distance of partners, both ways, after `drawn` was turned, moved and scaled to fit `shape`.

    Both curves as `resampled`, about their middle and of unit spread, (n, 2).
    """
    progress = np.linspace(0.0, settings.progress, len(shape))
    apart = (progress[:, None] - progress[None, :]) ** 2
    moved, before = drawn, np.inf
    for _ in range(settings.rounds):
        squares = ((moved[:, None] - shape[None, :]) ** 2).sum(axis=2) + apart
        there, back = squares.argmin(axis=1), squares.argmin(axis=0)
        distance = float(np.sqrt(0.5 * (squares.min(axis=1).mean() + squares.min(axis=0).mean())))
        if before - distance < 1e-4:
            break
        before = distance
        source = np.concatenate([drawn, drawn[back]])
        moved = _fitted(drawn, source, np.concatenate([shape[there], shape]), settings.most_turn_deg)
    return min(distance, before)


def _fitted(curve: Curve, source: Curve, target: Curve, most_turn_deg: float) -> Curve:
    """The curve moved as brings the points `source` nearest to `target`: a similarity with a bounded turn."""
    from_middle, to_middle = source.mean(axis=0), target.mean(axis=0)
    a, b = source - from_middle, target - to_middle
    # As complex numbers a similarity is one factor: its angle is the turn, its size the scale.
    factor = complex((a * b).sum(), (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) / max(
        float((a * a).sum()), 1e-9
    )
    limit = np.radians(most_turn_deg)
    turn = float(np.clip(np.angle(factor), -limit, limit))
    scale = float(np.clip(abs(factor), 0.5, 2.0))
    rotation = scale * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    return np.asarray((curve - from_middle) @ rotation.T + to_middle)


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
