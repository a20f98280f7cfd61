"""What the simulated vehicle sends by itself, as MAVLink messages: heartbeats, position, attitude, sticks, texts."""

from __future__ import annotations

import math
from typing import Any, Final

from lightgesture.sinks.mavlink_texts import text_chunks
from lightgesture.synth.pool.autopilot import Autopilot
from lightgesture.synth.pool.body import Motion
from lightgesture.synth.pool.mission import to_degrees

FAST_S: Final = 0.1
"""Between two messages of position and attitude, seconds."""
SLOW_S: Final = 1.0
"""Between two heartbeats."""
SUB_VERSION: Final = 4 << 24 | 1 << 16 | 2 << 8 | 255
"""ArduSub 4.1.2, as AUTOPILOT_VERSION has it."""


class Teller:
    """Sends by `packer` (pymavlink's, of the autopilot) what is due; `dialect` is pymavlink's module."""

    def __init__(self, dialect: Any, packer: Any, pilot: Autopilot) -> None:
        self._dialect, self._packer, self._pilot = dialect, packer, pilot
        self._fast_s = self._slow_s = -math.inf
        self._texts = 0

    def tell(self, now_s: float, motion: Motion) -> bool:
        """Send what is due at a time; whether the slow messages were among it."""
        said, dialect = self._pilot.said, self._dialect
        for severity, text in said.texts:
            self.text(severity, text)
        for number in said.reached:
            self._packer.mission_item_reached_send(number)
        said.texts.clear()
        said.reached.clear()
        if now_s - self._fast_s >= FAST_S - 1e-6:
            self._fast_s = now_s
            self._tell_motion(int(1000 * now_s), motion)
        if now_s - self._slow_s < SLOW_S - 1e-6:
            return False
        self._slow_s = now_s
        self.heartbeat()
        self._packer.mission_current_send(self._pilot.item)
        health = dialect.MAV_SYS_STATUS_SENSOR_3D_GYRO | dialect.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
        self._packer.sys_status_send(health, health, health, 120, 15200, 900, 88, 0, 0, 0, 0, 0, 0)
        return True

    def heartbeat(self) -> None:
        """Tell mode and arming."""
        dialect, pilot = self._dialect, self._pilot
        flags = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
        if pilot.is_armed:
            flags |= dialect.MAV_MODE_FLAG_SAFETY_ARMED
        state = dialect.MAV_STATE_ACTIVE if pilot.is_armed else dialect.MAV_STATE_STANDBY
        kind = dialect.MAV_TYPE_SUBMARINE
        self._packer.heartbeat_send(kind, dialect.MAV_AUTOPILOT_ARDUPILOTMEGA, flags, int(pilot.mode), state)

    def text(self, severity: int, text: str) -> None:
        """Tell the pilot something."""
        chunks = text_chunks(text)
        if len(chunks) > 1:
            self._texts = self._texts % 0xFFFF + 1
        for place, chunk in enumerate(chunks):
            self._packer.statustext_send(severity, chunk, self._texts if len(chunks) > 1 else 0, place)

    def version(self) -> None:
        """Tell which firmware this stands for, and what it can do."""
        dialect = self._dialect
        can = (
            dialect.MAV_PROTOCOL_CAPABILITY_MAVLINK2
            | dialect.MAV_PROTOCOL_CAPABILITY_MISSION_INT
            | dialect.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
            | dialect.MAV_PROTOCOL_CAPABILITY_COMMAND_INT
        )
        self._packer.autopilot_version_send(can, SUB_VERSION, 0, 0, 0, bytes(8), bytes(8), bytes(8), 0, 0, 1)

    def _tell_motion(self, time_ms: int, motion: Motion) -> None:
        packer, pilot = self._packer, self._pilot
        (north, east, down), speed = motion.position, motion.velocity
        packer.attitude_send(time_ms, *motion.attitude, *motion.rates)
        ground_mps = math.hypot(speed[0], speed[1])
        heading = int(motion.heading_deg) % 360
        packer.vfr_hud_send(ground_mps, ground_mps, heading, 0, -down, -speed[2])
        if pilot.has_position:
            packer.local_position_ned_send(time_ms, north, east, down, *speed)
            latitude, longitude = to_degrees(north, east)
            place = (round(1e7 * latitude), round(1e7 * longitude), round(-1000 * down), round(-1000 * down))
            rates = [round(100 * rate) for rate in speed]
            packer.global_position_int_send(time_ms, *place, *rates, round(100 * motion.heading_deg) % 36000)
        packer.rc_channels_send(time_ms, 8, *self._channels(), *[0xFFFF] * 10, 255)

    def _channels(self) -> list[int]:
        """The sticks as ArduSub has them in channels: pitch, roll, throttle, yaw, forward, lateral, two more."""
        sticks, gain = self._pilot.sticks, self._pilot.parameters["JS_GAIN_DEFAULT"]
        shares = (0.0, 0.0, sticks.up, sticks.turn, sticks.forward, sticks.right, 0.0, 0.0)
        return [round(1500 + 400 * gain * share) for share in shares]
