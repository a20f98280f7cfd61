"""A simple autopilot with the modes, fail-safes and refusals of ArduSub: what it does, apart from how it is told.

Behaviour follows ArduPilot's documents of ArduSub (ardupilot.org/sub) and trials with its firmware: sticks count only
from the ground station's system, a mode that needs a position is refused without one, and fail-safes do not return to
the old mode.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Final

import numpy as np

from lightgesture.synth.pool.body import THRUSTERS, Array, Motion
from lightgesture.synth.pool.controller import (
    STICK_N,
    STICK_NM,
    YAW_RATE,
    Controller,
    Targets,
)
from lightgesture.synth.pool.mission import (
    DELAY,
    REACHED_M,
    SET_SPEED,
    TAKE_PICTURES,
    WAYPOINT,
    Item,
)


class Mode(IntEnum):
    """Modes by ArduSub's numbers."""

    STABILIZE = 0
    ALT_HOLD = 2
    AUTO = 3
    GUIDED = 4
    SURFACE = 9
    POSHOLD = 16
    MANUAL = 19


NEED_POSITION: Final = (Mode.AUTO, Mode.GUIDED, Mode.POSHOLD)

DEADBAND: Final = 0.05
"""Share of a stick's travel that counts as neutral."""

WARNING, CRITICAL, INFO = 4, 2, 6
"""Severities of texts, as MAVLink numbers them."""


def default_parameters() -> dict[str, float]:
    """Parameters and their values at the start, named as ArduSub's; speeds in cm/s."""
    return {
        "SYSID_THISMAV": 1.0,
        "SYSID_MYGCS": 255.0,
        "FS_GCS_ENABLE": 0.0,  # 0 off, 1 warn, 2 disarm, 3 hold the depth, 4 surface
        "FS_GCS_TIMEOUT": 5.0,
        "FS_PILOT_INPUT": 1.0,  # 0 off, 1 neutral sticks, 2 disarm
        "FS_PILOT_TIMEOUT": 3.0,
        "JS_GAIN_DEFAULT": 0.5,
        "JS_LIGHTS_STEPS": 8.0,
        "PILOT_SPEED_UP": 80.0,
        "PILOT_SPEED_DN": 80.0,
        "PILOT_ACCEL_Z": 100.0,
        "SURFACE_DEPTH": -10.0,
        "WPNAV_SPEED": 50.0,
        "WPNAV_SPEED_UP": 50.0,
        "WPNAV_SPEED_DN": 50.0,
    }


@dataclass(frozen=True, slots=True)
class Sticks:
    """Forward, right, up and clockwise, each -1 to 1, and when they came."""

    forward: float = 0.0
    right: float = 0.0
    up: float = 0.0
    turn: float = 0.0
    time_s: float = -math.inf

    @property
    def is_neutral(self) -> bool:
        return max(abs(self.forward), abs(self.right), abs(self.up), abs(self.turn)) <= DEADBAND


@dataclass(slots=True)
class Said:
    """What the autopilot tells of itself since it was last asked."""

    texts: list[tuple[int, str]] = field(default_factory=list)
    reached: list[int] = field(default_factory=list)


def _nothing(_count: int, _interval_s: float) -> None:
    """In the place of a camera."""


class Autopilot:
    """Asked every CONTROL_S seconds by `thrusts`, with what the sensors say.

    has_position: whether a position sensor is aboard and works; may be changed at any time. take_pictures: what an item
    of a mission that wants pictures calls, with their number (0: until stopped) and the seconds between.
    """

    def __init__(self, thrust_n: float, mission: list[Item] | None = None, has_position: bool = True) -> None:
        self.parameters = default_parameters()
        self.mission = mission or []
        self.has_position = has_position
        self.mode, self.is_armed = Mode.MANUAL, False
        self.item = 0
        self.sticks = Sticks()
        self.said = Said()
        self.visited: list[tuple[float, int]] = []  # items of the mission that were reached, and when
        self.take_pictures: Callable[[int, float], None] = _nothing
        self._controller = Controller(thrust_n)
        self._targets = Targets()
        self._motion: Motion | None = None
        self._station_s = -math.inf  # when the ground station was last heard
        self._is_station_lost = self._is_pilot_lost = False
        self._waiting_until_s: float | None = None

    @property
    def targets(self) -> Targets:
        """What is held now."""
        return self._targets

    # What it is told ------------------------------------------------------------------------------------------------

    def hear_station(self, now_s: float) -> None:
        """The ground station gave a sign of life."""
        self._station_s, self._is_station_lost = now_s, False

    def move_sticks(self, sticks: Sticks) -> None:
        """The pilot's sticks, which are a sign of life too."""
        self.sticks, self._is_pilot_lost = sticks, False
        self.hear_station(sticks.time_s)

    def set_mode(self, number: int) -> bool:
        """Change the mode; False where there is none of this number, or it cannot be had now."""
        try:
            mode = Mode(number)
        except ValueError:
            return False
        if (mode in NEED_POSITION and not self.has_position) or (mode is Mode.AUTO and len(self.mission) < 2):
            self.said.texts.append((WARNING, f"Mode change to {mode.name} failed"))
            return False
        self.mode = mode
        self._targets = Targets()
        self._waiting_until_s = None
        self._controller.reset()
        if mode is Mode.AUTO:
            self.item = max(self.item, 1)
        return True

    def arm(self, is_armed: bool) -> None:
        """Arm or disarm."""
        self.is_armed = is_armed

    def set_item(self, number: int) -> bool:
        """Go on with another item of the mission; False where there is none."""
        if not 0 <= number < len(self.mission):
            return False
        self.item = number
        self._waiting_until_s = None
        return True

    def look_at(self, heading: float) -> None:
        """Turn to a heading, radians, in the modes that steer themselves."""
        self._targets.heading = heading

    # What it does ---------------------------------------------------------------------------------------------------

    def thrusts(self, now_s: float, motion: Motion) -> Array:
        """The six commands now, each -1 to 1."""
        self._motion = motion
        self._check_failsafes(now_s)
        if not self.is_armed:
            return np.zeros(THRUSTERS)
        if not self.has_position and self.mode in NEED_POSITION:
            self.said.texts.append((CRITICAL, "Position lost: ALT_HOLD"))
            self.set_mode(Mode.ALT_HOLD)
        gain = self.parameters["JS_GAIN_DEFAULT"]
        if self.mode is Mode.MANUAL:
            sticks = self.sticks
            forward, right, up = (gain * push for push in STICK_N)
            return self._controller.pushed(
                sticks.forward * forward, sticks.right * right, -sticks.up * up, gain * sticks.turn * STICK_NM
            )
        self._steer_heading(motion, gain)
        match self.mode:
            case Mode.AUTO:
                self._follow_mission(now_s, motion)
            case Mode.SURFACE:
                self._targets.depth_m = -0.01 * self.parameters["SURFACE_DEPTH"]
                self._push_sideways(gain)
            case Mode.GUIDED:
                self._hold(motion)
            case _:
                self._steer_depth(motion, gain)
                self._push_sideways(gain)
                if self.mode is Mode.POSHOLD:
                    self._hold_place(motion)
        return self._controller.thrusts(motion, self._targets)

    def _check_failsafes(self, now_s: float) -> None:
        parameters = self.parameters
        pilot = parameters["FS_PILOT_INPUT"]
        late_s = now_s - self.sticks.time_s
        if pilot and not self._is_pilot_lost and parameters["FS_PILOT_TIMEOUT"] < late_s < math.inf:
            self._is_pilot_lost = True
            self.sticks = Sticks(time_s=self.sticks.time_s)
            self.said.texts.append((CRITICAL, "Lost manual control"))
            if pilot == 2:
                self.arm(False)
        action = parameters["FS_GCS_ENABLE"]
        late_s = now_s - self._station_s
        if action and not self._is_station_lost and parameters["FS_GCS_TIMEOUT"] < late_s < math.inf:
            self._is_station_lost = True
            self.said.texts.append((WARNING, f"MYGCS: {parameters['SYSID_MYGCS']:.0f}, heartbeat lost"))
            if self.is_armed and action == 2:
                self.arm(False)
            elif self.is_armed and action in (3, 4):
                self.set_mode(Mode.ALT_HOLD if action == 3 else Mode.SURFACE)

    def _steer_heading(self, motion: Motion, gain: float) -> None:
        targets, turn = self._targets, self.sticks.turn
        is_turned = abs(turn) > DEADBAND and self.mode is not Mode.AUTO
        targets.turn_rps = gain * turn * YAW_RATE if is_turned else None
        if is_turned or targets.heading is None:
            targets.heading = motion.attitude[2]

    def _steer_depth(self, motion: Motion, gain: float) -> None:
        targets, up = self._targets, self.sticks.up
        if self.mode is Mode.STABILIZE:
            targets.depth_m, targets.sink_mps = None, None
            return
        is_moved = abs(up) > DEADBAND
        speed = 0.01 * self.parameters["PILOT_SPEED_UP" if up > 0 else "PILOT_SPEED_DN"]
        targets.sink_mps = -gain * up * speed if is_moved else None
        if is_moved or targets.depth_m is None:
            targets.depth_m = max(motion.depth_m, 0.1)

    def _push_sideways(self, gain: float) -> None:
        sticks = self.sticks
        self._targets.force_n = (gain * sticks.forward * STICK_N[0], gain * sticks.right * STICK_N[1])

    def _hold_place(self, motion: Motion) -> None:
        is_moved = max(abs(self.sticks.forward), abs(self.sticks.right)) > DEADBAND
        if is_moved:
            self._targets.place = None
        elif self._targets.place is None:
            self._targets.place = (motion.position[0], motion.position[1])

    def _hold(self, motion: Motion) -> None:
        targets = self._targets
        if targets.place is None:
            targets.place = (motion.position[0], motion.position[1])
        if targets.depth_m is None:
            targets.depth_m = motion.depth_m

    def _follow_mission(self, now_s: float, motion: Motion) -> None:
        item, targets = self.mission[self.item], self._targets
        targets.speed_mps = 0.01 * self.parameters["WPNAV_SPEED"]
        is_done = False
        if item.command == WAYPOINT:
            north, east, targets.depth_m = item.place
            targets.place = (north, east)
            away_m = math.dist((north, east, targets.depth_m), motion.position)
            is_done = away_m < REACHED_M
        elif item.command == DELAY:
            self._hold(motion)
            self._waiting_until_s = self._waiting_until_s or now_s + item.params[0]
            is_done = now_s >= self._waiting_until_s
        elif item.command == SET_SPEED:
            self.parameters["WPNAV_SPEED"] = 100.0 * item.params[1]
            is_done = True
        elif item.command == TAKE_PICTURES:
            self.take_pictures(int(item.params[2]), item.params[1])
            is_done = True
        else:
            self._hold(motion)
        if is_done:
            self.said.reached.append(self.item)
            self.visited.append((now_s, self.item))
            self._waiting_until_s = None
            if self.item + 1 < len(self.mission):
                self.item += 1
            else:
                self.said.texts.append((INFO, "Mission Complete"))
                self.set_mode(Mode.POSHOLD)
