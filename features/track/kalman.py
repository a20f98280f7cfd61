"""How the box of a hand moves: a constant-velocity Kalman filter on its centre and size. Pure functions.

State of one hand, in source pixels and seconds, from x = (centre x, centre y, width, height) and its velocity x':

    s = (x, x')    F = [[I, dt I], [0, I]]    Q = [[dt³/3 D, dt²/2 D], [dt²/2 D, dt D]]    z = (I 0) s + noise, R

D: power spectral densities of white accelerations of centre and size (Bar-Shalom, Li and Kirubarajan, "Estimation with
Applications to Tracking and Navigation", 2001, section 6.2.2). Two steps add up to one of their joint length, so that
a stream foresees the same at 10, 30 or 60 frames a second and across dropped frames; with an acceleration that is
constant over each step it would not. R: variances of a region's centre and size. D, R and the start are diagonal, hence
the coordinates stay independent: a state is four filters of two numbers, whose algebra is written out. D, R and the
start grow with the area of the hand, so that a hand that is near is followed as one that is far; "sizes" below are
the root of that area.
"""

from typing import Final, NamedTuple

from lightgesture.features.types import Box

CENTRE_NOISE: Final = 0.12
"""Standard deviation of a region's centre, sizes; measured on the selector's regions."""
SIZE_NOISE: Final = 0.25
"""Standard deviation of a region's width and height, sizes: the forearm comes and goes."""
CENTRE_DENSITY: Final = 10.0
"""Density of the centre's acceleration, sizes² / s³. Larger follows faster hands, gates less, and trusts a prediction
for a shorter time."""
SIZE_DENSITY: Final = 4.0
"""Density of the acceleration of width and height, sizes² / s³."""
CENTRE_SPEED: Final = 2.0
"""Standard deviation of the unknown velocity of a hand seen once, sizes a second."""
SIZE_SPEED: Final = 0.5
"""Standard deviation of the unknown growth of its width and height, sizes a second."""


class Coordinate(NamedTuple):
    """position, pixels; velocity, pixels a second; p00, p01, p11: their covariance, p00 and p11 >= 0."""

    position: float
    velocity: float
    p00: float
    p01: float
    p11: float


BoxState = tuple[Coordinate, Coordinate, Coordinate, Coordinate]
"""Centre x, centre y, width and height of one hand."""

Precision = tuple[float, float, float, float]
"""Inverses of the variances of a measured centre x, centre y, width and height, 1 / pixels²."""


def predict(state: Coordinate, dt: float, density: float) -> Coordinate:
    """The coordinate `dt` seconds later (dt >= 0); density: that of its acceleration, pixels² / s³ (>= 0)."""
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
    """The coordinate after a measurement of its position with the given variance (> 0), pixels²."""
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


def start_box(box: Box) -> BoxState:
    """A hand seen once in this box, at rest as far as is known."""
    x, y, width, height = box
    area = max(float(width), 1.0) * max(float(height), 1.0)
    centre, size = CENTRE_NOISE**2 * area, SIZE_NOISE**2 * area
    centre_speed, size_speed = CENTRE_SPEED**2 * area, SIZE_SPEED**2 * area
    return (
        Coordinate(x + width / 2, 0.0, centre, 0.0, centre_speed),
        Coordinate(y + height / 2, 0.0, centre, 0.0, centre_speed),
        Coordinate(float(width), 0.0, size, 0.0, size_speed),
        Coordinate(float(height), 0.0, size, 0.0, size_speed),
    )


def predict_box(state: BoxState, dt: float) -> BoxState:
    """The hand `dt` seconds later (dt >= 0)."""
    x, y, width, height = state
    area = area_of(state)
    centre, size = CENTRE_DENSITY * area, SIZE_DENSITY * area
    return (
        predict(x, dt, centre),
        predict(y, dt, centre),
        predict(width, dt, size),
        predict(height, dt, size),
    )


def update_box(state: BoxState, box: Box) -> BoxState:
    """The hand after it was seen in this box."""
    x, y, width, height = state
    area = area_of(state)
    centre, size = CENTRE_NOISE**2 * area, SIZE_NOISE**2 * area
    return (
        update(x, box[0] + box[2] / 2, centre),
        update(y, box[1] + box[3] / 2, centre),
        update(width, box[2], size),
        update(height, box[3], size),
    )


def stop(state: BoxState) -> BoxState:
    """The hand with velocities of zero mean, as uncertain as they were."""
    x, y, width, height = state
    return (
        x._replace(velocity=0.0),
        y._replace(velocity=0.0),
        width._replace(velocity=0.0),
        height._replace(velocity=0.0),
    )


def area_of(state: BoxState) -> float:
    """Width times height, pixels², each taken for at least one pixel."""
    return max(state[2].position, 1.0) * max(state[3].position, 1.0)


def precision_of(state: BoxState, leap: float = 0.0) -> Precision:
    """How precisely it is known where a predicted hand will be measured. leap: standard deviation of the centre and of
    the size by which it may have leapt besides, sizes."""
    x, y, width, height = state
    area = area_of(state)
    centre, size = (CENTRE_NOISE**2 + leap**2) * area, (SIZE_NOISE**2 + leap**2) * area
    return 1.0 / (x.p00 + centre), 1.0 / (y.p00 + centre), 1.0 / (width.p00 + size), 1.0 / (height.p00 + size)


def squared_distance(state: BoxState, precision: Precision, box: Box) -> float:
    """Squared Mahalanobis distance of a box from a predicted hand, over centre and size. The coordinates are
    independent: it is the sum of theirs."""
    x, y, width, height = state
    dx, dy = box[0] + box[2] / 2 - x.position, box[1] + box[3] / 2 - y.position
    dw, dh = box[2] - width.position, box[3] - height.position
    return dx * dx * precision[0] + dy * dy * precision[1] + dw * dw * precision[2] + dh * dh * precision[3]


def meets(first: BoxState, second: BoxState) -> bool:
    """Whether two hands touch: their boxes overlap or share an edge."""
    return (
        abs(first[0].position - second[0].position) <= (first[2].position + second[2].position) / 2
        and abs(first[1].position - second[1].position) <= (first[3].position + second[3].position) / 2
    )


def box_of(state: BoxState, picture: tuple[int, int]) -> Box:
    """The hand's box inside a picture of (width, height) pixels, at least one pixel large."""
    x, y, width, height = state[0].position, state[1].position, state[2].position, state[3].position
    left, top = round(x - width / 2), round(y - height / 2)
    right, bottom = round(x + width / 2), round(y + height / 2)
    left, top = min(max(left, 0), picture[0] - 1), min(max(top, 0), picture[1] - 1)
    return left, top, max(1, min(right, picture[0]) - left), max(1, min(bottom, picture[1]) - top)
