"""The vehicle as others meet it: MAVLink packets in, acknowledgements and telemetry out.

What it answers to which command follows ArduSub's firmware: commands that move nothing there are UNSUPPORTED here,
cameras are a component of their own, MANUAL_CONTROL counts only from the ground station's system, an unknown parameter
is answered by silence.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

from lightgesture.synth.pool import camera_component, follower
from lightgesture.synth.pool.autopilot import Autopilot, Mode, Sticks
from lightgesture.synth.pool.body import Motion
from lightgesture.synth.pool.camera_component import CameraComponent
from lightgesture.synth.pool.follower import Follower
from lightgesture.synth.pool.mission_transfer import MissionTransfer
from lightgesture.synth.pool.telling import Teller

AUTOPILOT: Final = 1
"""MAV_COMP_ID_AUTOPILOT1."""
SET_MODE_MESSAGE: Final = 11
"""Number of the old message SET_MODE, under which its acknowledgement comes."""
STICK_TRAVEL, THROTTLE_MIDDLE = 1000, 500
"""Of MANUAL_CONTROL."""


class _Writer:
    """What pymavlink's packer writes to."""

    def __init__(self, write: Callable[[bytes], None]) -> None:
        self.write = write


class MavlinkFront:
    """Autopilot and camera behind one link.

    write: sends packed bytes to whoever listens. `receive` takes what they sent, `tick` is called at every step of the
    autopilot. `is_deaf`: takes and answers nothing, as behind a broken link.
    """

    def __init__(self, pilot: Autopilot, write: Callable[[bytes], None], system: int = 1) -> None:
        from pymavlink.dialects.v20 import common

        self.dialect: Any = common
        self.pilot, self.system = pilot, system
        self.is_deaf = False
        pilot.parameters["SYSID_THISMAV"] = float(system)
        self._packer = common.MAVLink(_Writer(write), system, AUTOPILOT)
        self._now_s = 0.0
        writer = _Writer(write)
        self.camera = CameraComponent(common, common.MAVLink(writer, system, camera_component.NUMBER))
        self.follower = Follower(common, common.MAVLink(writer, system, follower.NUMBER), pilot)
        self._components: dict[int, CameraComponent | Follower] = {
            camera_component.NUMBER: self.camera,
            follower.NUMBER: self.follower,
        }
        self._teller = Teller(common, self._packer, pilot)
        self._missions = MissionTransfer(common, self._packer, pilot)
        pilot.take_pictures = lambda count, interval_s: self.camera.start(count, interval_s, self._now_s)

    def tick(self, now_s: float, motion: Motion) -> None:
        """Send what is due."""
        self._now_s = now_s
        if self.is_deaf:
            return
        for component in self._components.values():
            component.tick(now_s, motion)
        if self._teller.tell(now_s, motion):
            self.camera.heartbeat()

    def receive(self, content: bytes, now_s: float) -> None:
        """Take a datagram of whole packets; damaged ones are passed over."""
        if self.is_deaf:
            return
        self._now_s = now_s
        parser = self.dialect.MAVLink(
            None
        )  # a new one, for half a packet shall not swallow the next datagram
        parser.robust_parsing = True
        for message in parser.parse_buffer(content) or ():
            self._take(message)

    def _take(self, message: Any) -> None:
        target = getattr(message, "target_system", getattr(message, "target", 0))
        if target not in (0, self.system):
            return
        match message.get_type():
            case "HEARTBEAT":
                if message.get_srcSystem() == self.pilot.parameters["SYSID_MYGCS"]:
                    self.pilot.hear_station(self._now_s)
            case "MANUAL_CONTROL":
                self._take_sticks(message)
            case "SET_MODE":
                is_done = self.pilot.set_mode(message.custom_mode)
                self._answer_command(message, SET_MODE_MESSAGE, self._accepted_if(is_done))
            case "COMMAND_LONG":
                params = tuple(getattr(message, f"param{number}") for number in range(1, 8))
                self._take_command(message, params)
            case "COMMAND_INT":
                params = (message.param1, message.param2, message.param3, message.param4)
                self._take_command(message, (*params, message.x / 1e7, message.y / 1e7, message.z))
            case "PARAM_SET" | "PARAM_REQUEST_READ" | "PARAM_REQUEST_LIST":
                self._take_parameter(message)
            case _:
                self._missions.take(message)

    def _take_sticks(self, message: Any) -> None:
        if message.get_srcSystem() != self.pilot.parameters["SYSID_MYGCS"] or message.target != self.system:
            return

        def share(value: int, middle: int = 0, travel: int = STICK_TRAVEL) -> float:
            return max(-1.0, min(1.0, (value - middle) / travel)) if abs(value) <= STICK_TRAVEL else 0.0

        up = share(message.z, THROTTLE_MIDDLE, THROTTLE_MIDDLE)
        sticks = Sticks(share(message.x), share(message.y), up, share(message.r), self._now_s)
        self.pilot.move_sticks(sticks)

    def _take_command(self, message: Any, params: tuple[float, ...]) -> None:
        component = self._components.get(message.target_component)
        if component is not None:
            result = component.command(message.command, params, self._now_s)
            self._answer_command(message, message.command, result, component)
        elif message.target_component in (0, AUTOPILOT):
            self._answer_command(message, message.command, self._do(message.command, params))

    def _do(self, command: int, params: tuple[float, ...]) -> int:
        """Do a command to the autopilot; the number of the result."""
        dialect, pilot = self.dialect, self.pilot
        accepted = int(dialect.MAV_RESULT_ACCEPTED)
        match command:
            case dialect.MAV_CMD_DO_SET_MODE:
                return self._accepted_if(pilot.set_mode(int(params[1])))
            case dialect.MAV_CMD_NAV_LOITER_UNLIM:
                return self._accepted_if(pilot.set_mode(Mode.POSHOLD))
            case dialect.MAV_CMD_CONDITION_YAW:
                if not 0.0 <= params[0] <= 360.0 or params[3] not in (0.0, 1.0):
                    return int(dialect.MAV_RESULT_FAILED)
                pilot.look_at(math.radians(params[0]))
            case dialect.MAV_CMD_DO_CHANGE_SPEED:
                if params[1] <= 0.0:
                    return int(dialect.MAV_RESULT_FAILED)
                pilot.parameters["WPNAV_SPEED"] = 100.0 * params[1]
            case dialect.MAV_CMD_COMPONENT_ARM_DISARM:
                pilot.arm(params[0] == 1.0)
            case dialect.MAV_CMD_MISSION_START:
                return self._accepted_if(pilot.is_armed and pilot.set_mode(Mode.AUTO))
            case dialect.MAV_CMD_DO_SET_MISSION_CURRENT:
                return self._accepted_if(pilot.set_item(int(params[0])))
            case dialect.MAV_CMD_REQUEST_MESSAGE:
                return self._send_requested(int(params[0]))
            case dialect.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES:
                self._teller.version()
            case dialect.MAV_CMD_DO_MOUNT_CONTROL | dialect.MAV_CMD_SET_MESSAGE_INTERVAL:
                pass
            case _:
                return int(dialect.MAV_RESULT_UNSUPPORTED)
        return accepted

    def _send_requested(self, number: int) -> int:
        if number == self.dialect.MAVLINK_MSG_ID_AUTOPILOT_VERSION:
            self._teller.version()
        elif number == self.dialect.MAVLINK_MSG_ID_HEARTBEAT:
            self._teller.heartbeat()
        else:
            return int(self.dialect.MAV_RESULT_UNSUPPORTED)
        return int(self.dialect.MAV_RESULT_ACCEPTED)

    def _accepted_if(self, is_done: bool) -> int:
        dialect = self.dialect
        return int(dialect.MAV_RESULT_ACCEPTED if is_done else dialect.MAV_RESULT_FAILED)

    def _answer_command(
        self, message: Any, command: int, result: int, sender: CameraComponent | Follower | None = None
    ) -> None:
        packer = self._packer if sender is None else sender.packer
        packer.command_ack_send(command, result, 0, 0, message.get_srcSystem(), message.get_srcComponent())

    def _take_parameter(self, message: Any) -> None:
        names = list(self.pilot.parameters)
        if message.get_type() == "PARAM_REQUEST_LIST":
            for name in names:
                self._tell_parameter(names, name)
            return
        name = message.param_id
        if message.get_type() == "PARAM_REQUEST_READ" and 0 <= message.param_index < len(names):
            name = names[message.param_index]
        if name not in self.pilot.parameters:
            return
        if message.get_type() == "PARAM_SET" and math.isfinite(message.param_value):
            self.pilot.parameters[name] = message.param_value
        self._tell_parameter(names, name)

    def _tell_parameter(self, names: list[str], name: str) -> None:
        value, kind = self.pilot.parameters[name], self.dialect.MAV_PARAM_TYPE_REAL32
        self._packer.param_value_send(name.encode("ascii"), value, kind, len(names), names.index(name))
