"""A constant-velocity Kalman filter, one coordinate at a time.

State of one coordinate: (position, velocity), in pixels and pixels a second. Over a time step of dt seconds

    F = [[1, dt], [0, 1]]        Q = q [[dt³ / 3, dt² / 2], [dt² / 2, dt]]

where q is the power spectral density of a white acceleration, pixels² / s³ (Bar-Shalom, Li and Kirubarajan,
"Estimation with Applications to Tracking and Navigation", 2001, section 6.2.2). Two steps add up to one of their
joint length, so that a stream foresees the same at 10, 30 or 60 frames a second and across dropped frames; with an
acceleration that is constant over each step it would not. Only the position is measured. The two-by-two algebra is
written out: it costs a microsecond and needs no library.
"""

from typing import NamedTuple


class Coordinate(NamedTuple):
    """position, pixels; velocity, pixels a second; p00, p01, p11: their covariance, p00 and p11 >= 0.

    A named tuple because two hands make and drop some thirty of these a frame, and it is made three times as fast as
    a frozen dataclass.
    """

    position: float
    velocity: float
    p00: float
    p01: float
    p11: float


def start(position: float, position_variance: float, velocity_variance: float) -> Coordinate:
    """A coordinate measured once, at rest as far as is known."""
    return Coordinate(position, 0.0, position_variance, 0.0, velocity_variance)


def predict(state: Coordinate, dt: float, density: float) -> Coordinate:
    """The state `dt` seconds later (dt >= 0); density: q, pixels² / s³ (>= 0)."""
    position, velocity, p00, p01, p11 = state
    grown = p01 + dt * p11
    half = 0.5 * density * dt * dt
    return Coordinate(
        position + dt * velocity,
        velocity,
        p00 + dt * (p01 + grown) + half * dt * (2.0 / 3.0),
        grown + half,
        p11 + density * dt,
    )


def update(state: Coordinate, measured: float, variance: float) -> Coordinate:
    """The state after a measurement of the position with the given variance (> 0), pixels²."""
    position, velocity, p00, p01, p11 = state
    total = p00 + variance
    gain, velocity_gain = p00 / total, p01 / total
    surprise = measured - position
    rest = variance / total
    return Coordinate(
        position + gain * surprise,
        velocity + velocity_gain * surprise,
        rest * p00,
        rest * p01,
        p11 - velocity_gain * p01,
    )


def distance(state: Coordinate, measured: float, variance: float) -> float:
    """Squared Mahalanobis distance of a measurement from the predicted position."""
    return (measured - state.position) ** 2 / (state.p00 + variance)
