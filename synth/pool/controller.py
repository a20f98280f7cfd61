"""What keeps the vehicle where it shall be: targets and sticks to six thrusts.

Cascades as small vehicles have them: error of place to speed, speed to force, with an integral against current and
buoyancy.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from lightgesture.synth.pool.body import Array, Motion, thruster_matrix

CONTROL_S: Final = 0.02
"""Between two looks of the controller, seconds."""

STICK_N: Final = (85.0, 60.0, 60.0)
"""Force of a full stick at gain 1, forward, right and down, newtons."""
STICK_NM: Final = 12.0
"""Torque of the same about the vertical axis, newton metres, in the mode MANUAL."""
YAW_RATE: Final = 1.2
"""Of a full stick at gain 1 in the modes that hold the heading, rad/s."""

SPEED_MPS: Final = 0.5
"""Fastest way to a place, unless a parameter says otherwise."""


@dataclass(frozen=True, slots=True)
class Gains:
    """place: speed wanted for each metre of error, 1/s. speed: force for each m/s, newtons. hold: growth of the force
    for each m/s that stays, newtons a second. turn, spin: as place and speed, of the heading, 1/s and newton metres for
    each rad/s.
    """

    place: float = 0.8
    speed: float = 90.0
    hold: float = 25.0
    turn: float = 1.8
    spin: float = 5.0


GAINS: Final = Gains()


@dataclass(slots=True)
class Targets:
    """What is held, each None where nothing is: depth (m), or a rate of sinking (m/s); heading (rad), or a rate of turn
    (rad/s); place (north, east, m). force_n: of the sticks on free axes (forward, right, N). speed_mps: fastest way.
    """

    depth_m: float | None = None
    sink_mps: float | None = None
    heading: float | None = None
    turn_rps: float | None = None
    place: tuple[float, float] | None = None
    force_n: tuple[float, float] = (0.0, 0.0)
    speed_mps: float = SPEED_MPS


def wrapped(angle: float) -> float:
    """The same angle within -pi to pi."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


class Controller:
    """Turns targets into thrusts, each -1 to 1 of `thrust_n`, every CONTROL_S seconds."""

    def __init__(self, thrust_n: float) -> None:
        self._mix = np.linalg.pinv(thruster_matrix()) / thrust_n
        self._held = np.zeros(3)  # integral of north, east, down, newtons

    def reset(self) -> None:
        """Forget what the integrals learnt of the place; what they learnt of buoyancy stays true."""
        self._held[:2] = 0.0

    def thrusts(self, motion: Motion, targets: Targets) -> Array:
        """The six commands for what is wanted now."""
        yaw = motion.attitude[2]
        north, east = self._to_place(motion, targets)
        forward = north * math.cos(yaw) + east * math.sin(yaw) + targets.force_n[0]
        right = east * math.cos(yaw) - north * math.sin(yaw) + targets.force_n[1]
        return self._mixed(forward, right, self._to_depth(motion, targets), self._to_heading(motion, targets))

    def pushed(self, forward: float, right: float, down: float, torque: float) -> Array:
        """The six commands of bare sticks: newtons and newton metres."""
        return self._mixed(forward, right, down, torque)

    def _mixed(self, forward: float, right: float, down: float, torque: float) -> Array:
        commands = np.asarray(self._mix @ np.array([forward, -right, -down, 0.0, 0.0, -torque]), np.float64)
        largest = float(np.abs(commands).max())
        return commands / largest if largest > 1.0 else commands

    def _to_place(self, motion: Motion, targets: Targets) -> tuple[float, float]:
        if targets.place is None:
            self._held[:2] = 0.0
            return 0.0, 0.0
        error = np.array([targets.place[axis] - motion.position[axis] for axis in (0, 1)])
        wanted = GAINS.place * error
        speed = float(np.linalg.norm(wanted))
        if speed > targets.speed_mps:
            wanted *= targets.speed_mps / speed
        missing = wanted - np.array(motion.velocity[:2])
        self._held[:2] = np.clip(self._held[:2] + GAINS.hold * CONTROL_S * missing, -30.0, 30.0)
        force = GAINS.speed * missing + self._held[:2]
        return float(force[0]), float(force[1])

    def _to_depth(self, motion: Motion, targets: Targets) -> float:
        if targets.sink_mps is not None:
            wanted = targets.sink_mps
        elif targets.depth_m is not None:
            limit = targets.speed_mps
            wanted = float(np.clip(GAINS.place * (targets.depth_m - motion.depth_m), -limit, limit))
        else:
            return 0.0
        missing = wanted - motion.velocity[2]
        self._held[2] = np.clip(self._held[2] + GAINS.hold * CONTROL_S * missing, -30.0, 30.0)
        return float(GAINS.speed * missing + self._held[2])

    def _to_heading(self, motion: Motion, targets: Targets) -> float:
        if targets.turn_rps is not None:
            wanted = targets.turn_rps
        elif targets.heading is not None:
            wanted = float(
                np.clip(GAINS.turn * wrapped(targets.heading - motion.attitude[2]), -YAW_RATE, YAW_RATE)
            )
        else:
            return 0.0
        return GAINS.spin * (wanted - motion.rates[2])
