"""Missions up, down and current: MAVLink's mission protocol, the vehicle's side."""

from __future__ import annotations

from typing import Any

from lightgesture.synth.pool.autopilot import Autopilot
from lightgesture.synth.pool.mission import Item


class MissionTransfer:
    """Answers the messages of the protocol by `packer`; a mission that came whole takes the place of the old one."""

    def __init__(self, dialect: Any, packer: Any, pilot: Autopilot) -> None:
        self._dialect, self._packer, self._pilot = dialect, packer, pilot
        self._coming: list[Item] = []
        self._count = 0

    def take(self, message: Any) -> None:
        """Answer one message; those that are no part of the protocol are passed over."""
        back = message.get_srcSystem(), message.get_srcComponent()
        mission = self._pilot.mission
        match message.get_type():
            case "MISSION_REQUEST_LIST":
                self._packer.mission_count_send(*back, len(mission))
            case "MISSION_REQUEST_INT" | "MISSION_REQUEST":
                if message.seq < len(mission):
                    self._send_item(back, message.seq)
                else:
                    self._answer(back, self._dialect.MAV_MISSION_INVALID_SEQUENCE)
            case "MISSION_COUNT":
                self._coming, self._count = [], message.count
                self._ask(back)
            case "MISSION_ITEM_INT":
                self._take_item(back, message)
            case "MISSION_CLEAR_ALL":
                self._pilot.mission, self._pilot.item = [], 0
                self._answer(back, self._dialect.MAV_MISSION_ACCEPTED)
            case "MISSION_SET_CURRENT":
                if self._pilot.set_item(message.seq):
                    self._packer.mission_current_send(self._pilot.item)
                else:
                    self._answer(back, self._dialect.MAV_MISSION_INVALID_SEQUENCE)

    def _take_item(self, back: tuple[int, int], message: Any) -> None:
        if message.seq != len(self._coming) or len(self._coming) == self._count:
            return
        params = (message.param1, message.param2, message.param3, message.param4)
        self._coming.append(Item(message.command, params, message.x / 1e7, message.y / 1e7, message.z))
        self._ask(back)

    def _ask(self, back: tuple[int, int]) -> None:
        """Ask for the next item, or take the mission that is whole."""
        if len(self._coming) < self._count:
            self._packer.mission_request_int_send(*back, len(self._coming))
            return
        self._pilot.mission, self._pilot.item = self._coming, 0
        self._answer(back, self._dialect.MAV_MISSION_ACCEPTED)

    def _answer(self, back: tuple[int, int], result: int) -> None:
        self._packer.mission_ack_send(*back, result)

    def _send_item(self, back: tuple[int, int], number: int) -> None:
        item, dialect = self._pilot.mission[number], self._dialect
        place = (round(1e7 * item.latitude), round(1e7 * item.longitude), item.altitude_m)
        frame = dialect.MAV_FRAME_GLOBAL_RELATIVE_ALT
        is_current = int(number == self._pilot.item)
        self._packer.mission_item_int_send(
            *back, number, frame, item.command, is_current, 1, *item.params, *place
        )
