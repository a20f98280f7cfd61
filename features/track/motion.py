"""How the box of a hand moves: Kalman filters on its centre and size, in closed form or by a library.

State of one hand, in source pixels and seconds, from x = (centre x, centre y, width, height) and its velocity x':

    s = (x, x')    F = [[I, dt I], [0, I]]    Q = [[dt³/3 D, dt²/2 D], [dt²/2 D, dt D]]    z = (I 0) s + noise, R

D = diag(qc, qc, qs, qs): power spectral densities of white accelerations of centre and size. R = diag(rc, rc, rs, rs):
variances of a region's centre and size. All of them grow with the square of the hand's size, so that a hand that is
near is followed as one that is far. D, R and the start are diagonal, hence the coordinates stay independent, and a
state is kept as four filters of two numbers each (see `kalman`, equations and source).
"""

import math
from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from lightgesture.features.track import kalman
from lightgesture.features.track.kalman import Coordinate
from lightgesture.features.types import Box

Measured = tuple[float, float, float, float]
"""Centre x, centre y, width, height in source pixels."""

BoxState = tuple[Coordinate, Coordinate, Coordinate, Coordinate]
"""Filtered centre x, centre y, width and height of one hand."""

CLOSED, FILTERPY = "closed", "filterpy"
"""Names of the filters."""


class FilterError(ValueError):
    """A filter that is not there, in one line with the remedy."""


class BoxFilter(Protocol):
    """Predicts and updates the state of one hand."""

    def predict(self, state: BoxState, dt: float, centre: float, size: float) -> BoxState:
        """The state `dt` seconds later (dt >= 0); centre, size: densities, pixels² / s³."""
        ...

    def update(self, state: BoxState, measured: Measured, centre: float, size: float) -> BoxState:
        """The state after a measurement; centre, size: its variances, pixels² (> 0)."""
        ...


class ClosedFilter:
    """The equations written out for each coordinate."""

    def predict(self, state: BoxState, dt: float, centre: float, size: float) -> BoxState:
        """See BoxFilter."""
        x, y, width, height = state
        return (
            kalman.predict(x, dt, centre),
            kalman.predict(y, dt, centre),
            kalman.predict(width, dt, size),
            kalman.predict(height, dt, size),
        )

    def update(self, state: BoxState, measured: Measured, centre: float, size: float) -> BoxState:
        """See BoxFilter."""
        x, y, width, height = state
        return (
            kalman.update(x, measured[0], centre),
            kalman.update(y, measured[1], centre),
            kalman.update(width, measured[2], size),
            kalman.update(height, measured[3], size),
        )


class FilterpyFilter:
    """The equations as eight-by-eight matrices in filterpy: the reference, fifty times as slow.

    Raises FilterError where filterpy is not installed.
    """

    def __init__(self) -> None:
        try:
            # Imported here: it pulls in SciPy, 0.9 s and 67 MB that the closed form spares.
            from filterpy import kalman as reference
        except ImportError as error:
            raise FilterError(
                'the track filter "filterpy" is not installed; pip install "filterpy>=2,<3", '
                f'or choose the filter "{CLOSED}"'
            ) from error
        self._reference: Any = reference

    def predict(self, state: BoxState, dt: float, centre: float, size: float) -> BoxState:
        """See BoxFilter."""
        mean, covariance = _to_matrices(state)
        eye, zero = np.eye(4), np.zeros((4, 4))
        transition = np.block([[eye, dt * eye], [zero, eye]])
        density = np.diag([centre, centre, size, size])
        noise = np.block(
            [[dt**3 / 3.0 * density, dt**2 / 2.0 * density], [dt**2 / 2.0 * density, dt * density]]
        )
        return _to_state(*self._reference.predict(mean, covariance, F=transition, Q=noise))

    def update(self, state: BoxState, measured: Measured, centre: float, size: float) -> BoxState:
        """See BoxFilter."""
        mean, covariance = _to_matrices(state)
        observation = np.hstack([np.eye(4), np.zeros((4, 4))])
        noise = np.diag([centre, centre, size, size])
        return _to_state(
            *self._reference.update(mean, covariance, np.array(measured), R=noise, H=observation)
        )


def _to_matrices(state: BoxState) -> tuple[Any, Any]:
    """Mean float64 (8,) and covariance float64 (8, 8) of s."""
    parts = np.array(state)
    mean = np.concatenate([parts[:, 0], parts[:, 1]])
    p00, p01, p11 = (np.diag(parts[:, column]) for column in (2, 3, 4))
    return mean, np.block([[p00, p01], [p01, p11]])


def _to_state(mean: Any, covariance: Any) -> BoxState:
    return _four(
        [
            Coordinate(
                float(mean[i]),
                float(mean[i + 4]),
                float(covariance[i, i]),
                float(covariance[i, i + 4]),
                float(covariance[i + 4, i + 4]),
            )
            for i in range(4)
        ]
    )


def _four(items: Sequence[Coordinate]) -> BoxState:
    x, y, width, height = items
    return x, y, width, height


def load_filter(name: str) -> BoxFilter:
    """The filter "closed" or "filterpy". Raises FilterError for another name or a library that is missing."""
    if name == CLOSED:
        return ClosedFilter()
    if name == FILTERPY:
        return FilterpyFilter()
    raise FilterError(f'unknown track filter "{name}"; choose "{CLOSED}" or "{FILTERPY}"')


def measure(box: Box) -> Measured:
    """Centre and size of a box."""
    return box[0] + box[2] / 2, box[1] + box[3] / 2, float(box[2]), float(box[3])


def start_state(
    measured: Measured, centre_variance: float, size_variance: float, centre_speed: float, size_speed: float
) -> BoxState:
    """A hand measured once. Variances in pixels², of the unknown velocities in pixels² / s²."""
    return (
        kalman.start(measured[0], centre_variance, centre_speed),
        kalman.start(measured[1], centre_variance, centre_speed),
        kalman.start(measured[2], size_variance, size_speed),
        kalman.start(measured[3], size_variance, size_speed),
    )


def stop(state: BoxState) -> BoxState:
    """The state with velocities of zero mean, as uncertain as they were."""
    x, y, width, height = state
    return (
        x._replace(velocity=0.0),
        y._replace(velocity=0.0),
        width._replace(velocity=0.0),
        height._replace(velocity=0.0),
    )


def meets(first: BoxState, second: BoxState) -> bool:
    """Whether two hands touch: the boxes of these states overlap or share an edge."""
    return (
        abs(first[0].position - second[0].position) <= (first[2].position + second[2].position) / 2
        and abs(first[1].position - second[1].position) <= (first[3].position + second[3].position) / 2
    )


def hand_size(state: BoxState) -> float:
    """Geometric mean of width and height, at least one pixel."""
    return math.sqrt(max(state[2].position, 1.0) * max(state[3].position, 1.0))


def clip_box(x: float, y: float, width: float, height: float, picture: tuple[int, int]) -> Box:
    """The box with this centre and size inside a picture of (width, height) pixels, at least one pixel large."""
    left, top = round(x - width / 2), round(y - height / 2)
    right, bottom = round(x + width / 2), round(y + height / 2)
    left, top = min(max(left, 0), picture[0] - 1), min(max(top, 0), picture[1] - 1)
    return left, top, max(1, min(right, picture[0]) - left), max(1, min(bottom, picture[1]) - top)


def box_of(state: BoxState, picture: tuple[int, int]) -> Box:
    """The box of a state, source pixels, clipped to a picture of (width, height)."""
    x, y, width, height = state
    return clip_box(x.position, y.position, width.position, height.position, picture)
