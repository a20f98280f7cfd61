"""A constant-velocity Kalman filter, one coordinate at a time.

State of one coordinate: (position, velocity), in pixels and pixels a second. Over a time step of dt seconds

    F = [[1, dt], [0, 1]]        Q = q [[dt^4 / 4, dt^3 / 2], [dt^3 / 2, dt^2]]

where q is the variance of a random acceleration that is constant over the step (Bar-Shalom, Li and
Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, section 6.3.2). Only the
position is measured. The two-by-two algebra is written out: it costs a microsecond and needs no library.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Coordinate:
    """position, pixels; velocity, pixels a second; p00, p01, p11: their covariance."""

    position: float
    velocity: float
    p00: float
    p01: float
    p11: float


def start(position: float, position_variance: float, velocity_variance: float) -> Coordinate:
    """A coordinate measured once, at rest as far as is known."""
    return Coordinate(position, 0.0, position_variance, 0.0, velocity_variance)


def predict(state: Coordinate, dt: float, acceleration_variance: float) -> Coordinate:
    """The state `dt` seconds later (dt >= 0); q in pixels² / s⁴."""
    half = 0.5 * dt * dt
    p01 = state.p01 + dt * state.p11
    return Coordinate(
        position=state.position + dt * state.velocity,
        velocity=state.velocity,
        p00=state.p00 + dt * (state.p01 + p01) + acceleration_variance * half * half,
        p01=p01 + acceleration_variance * half * dt,
        p11=state.p11 + acceleration_variance * dt * dt,
    )


def update(state: Coordinate, measured: float, variance: float) -> Coordinate:
    """The state after a measurement of the position with the given variance (> 0), pixels²."""
    total = state.p00 + variance
    gain, velocity_gain = state.p00 / total, state.p01 / total
    surprise = measured - state.position
    return Coordinate(
        position=state.position + gain * surprise,
        velocity=state.velocity + velocity_gain * surprise,
        p00=(1.0 - gain) * state.p00,
        p01=(1.0 - gain) * state.p01,
        p11=state.p11 - velocity_gain * state.p01,
    )


def distance(state: Coordinate, measured: float, variance: float) -> float:
    """Squared Mahalanobis distance of a measurement from the predicted position."""
    return (measured - state.position) ** 2 / (state.p00 + variance)
