"""A program of the vehicle's own that follows the diver: a MAVLink component that leads the autopilot in GUIDED.

It stands for what a real vehicle brings, and so takes the diver's place from the simulation and not from pictures.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

from lightgesture.synth.pool.autopilot import Autopilot, Mode
from lightgesture.synth.pool.body import Motion

NUMBER: Final = 192
"""MAV_COMP_ID_ONBOARD_COMPUTER2."""
DISTANCE_M: Final = 1.3
"""Kept from the diver, metres."""

Place = tuple[float, float, float]
"""North, east, down, metres."""


class Follower:
    """Begins by MAV_CMD_USER_1, whose first parameter is the time in seconds (0: until the mode changes)."""

    def __init__(self, dialect: Any, packer: Any, pilot: Autopilot) -> None:
        self._dialect, self.packer, self._pilot = dialect, packer, pilot
        self.diver: Callable[[], Place] | None = None
        self._until_s: float | None = None

    @property
    def is_following(self) -> bool:
        """Whether it leads the vehicle."""
        return self._until_s is not None

    def command(self, command: int, params: tuple[float, ...], now_s: float) -> int:
        """Do a command; MAVLink's number of the result."""
        if command != self._dialect.MAV_CMD_USER_1:
            return int(self._dialect.MAV_RESULT_UNSUPPORTED)
        if self._pilot.mode is not Mode.GUIDED or self.diver is None:
            return int(self._dialect.MAV_RESULT_DENIED)
        self._until_s = now_s + params[0] if params[0] > 0.0 else math.inf
        return int(self._dialect.MAV_RESULT_ACCEPTED)

    def tick(self, now_s: float, motion: Motion) -> None:
        """Lead the autopilot to before the diver, facing the diver."""
        if self._until_s is None or self.diver is None:
            return
        if self._pilot.mode is not Mode.GUIDED or now_s >= self._until_s:
            self._until_s = None
            return
        north, east, down = self.diver()
        away = north - motion.position[0], east - motion.position[1]
        distance_m = max(math.hypot(*away), 1e-3)
        share = (distance_m - DISTANCE_M) / distance_m
        targets = self._pilot.targets
        targets.place = (motion.position[0] + share * away[0], motion.position[1] + share * away[1])
        targets.depth_m, targets.heading = down, math.atan2(away[1], away[0])
