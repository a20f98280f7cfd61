"""The vehicle's camera as a MAVLink component of its own, number 100: takes pictures at times and tells of each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from lightgesture.synth.pool.body import Motion
from lightgesture.synth.pool.mission import to_degrees

NUMBER: Final = 100
"""MAV_COMP_ID_CAMERA."""


@dataclass(frozen=True, slots=True)
class Taken:
    """One picture: when (seconds), at what depth and heading."""

    time_s: float
    depth_m: float
    heading_deg: float


class CameraComponent:
    """Understands IMAGE_START_CAPTURE, IMAGE_STOP_CAPTURE and the video commands; `taken` are its pictures."""

    def __init__(self, dialect: Any, packer: Any) -> None:
        self._dialect, self.packer = dialect, packer
        self.taken: list[Taken] = []
        self.is_filming = False
        self._left = 0
        self._interval_s = 0.0
        self._next_s = math.inf

    def command(self, command: int, params: tuple[float, ...], now_s: float) -> int:
        """Do a command; MAVLink's number of the result."""
        dialect = self._dialect
        if command == dialect.MAV_CMD_IMAGE_START_CAPTURE:
            count, interval_s = int(params[2]), params[1]
            if (
                count < 0
                or interval_s < 0
                or not math.isfinite(interval_s)
                or (count != 1 and interval_s == 0)
            ):
                return int(dialect.MAV_RESULT_DENIED)
            self.start(count, interval_s, now_s)
        elif command == dialect.MAV_CMD_IMAGE_STOP_CAPTURE:
            self._next_s = math.inf
        elif command in (dialect.MAV_CMD_VIDEO_START_CAPTURE, dialect.MAV_CMD_VIDEO_STOP_CAPTURE):
            self.is_filming = command == dialect.MAV_CMD_VIDEO_START_CAPTURE
        elif command == dialect.MAV_CMD_REQUEST_CAMERA_INFORMATION or (
            command == dialect.MAV_CMD_REQUEST_MESSAGE
            and int(params[0]) == dialect.MAVLINK_MSG_ID_CAMERA_INFORMATION
        ):
            self._tell_information(now_s)
        else:
            return int(dialect.MAV_RESULT_UNSUPPORTED)
        return int(dialect.MAV_RESULT_ACCEPTED)

    def start(self, count: int, interval_s: float, now_s: float) -> None:
        """Take `count` pictures (0: until stopped), the first one now."""
        self._left, self._interval_s, self._next_s = count, interval_s, now_s

    def tick(self, now_s: float, motion: Motion) -> None:
        """Take the picture that is due."""
        if now_s < self._next_s:
            return
        self.taken.append(Taken(now_s, motion.depth_m, motion.heading_deg))
        self._left -= 1
        self._next_s = math.inf if self._left == 0 else self._next_s + self._interval_s
        latitude, longitude = to_degrees(motion.position[0], motion.position[1])
        height_mm = round(-1000 * motion.depth_m)
        self.packer.camera_image_captured_send(
            int(1000 * now_s), 0, 1, round(1e7 * latitude), round(1e7 * longitude), height_mm, height_mm,
            [1.0, 0.0, 0.0, 0.0], len(self.taken) - 1, 1, b"",
        )  # fmt: skip

    def heartbeat(self) -> None:
        """A sign of life."""
        dialect = self._dialect
        kind, none = dialect.MAV_TYPE_CAMERA, dialect.MAV_AUTOPILOT_INVALID
        self.packer.heartbeat_send(kind, none, 0, 0, dialect.MAV_STATE_ACTIVE)

    def _tell_information(self, now_s: float) -> None:
        flags = self._dialect.CAMERA_CAP_FLAGS_CAPTURE_IMAGE | self._dialect.CAMERA_CAP_FLAGS_CAPTURE_VIDEO
        vendor, model = b"lightgesture".ljust(32, b"\0"), b"pool".ljust(32, b"\0")
        self.packer.camera_information_send(
            int(1000 * now_s), vendor, model, 1, 2.8, 6.0, 4.5, 640, 480, 0, flags, 0, b""
        )
