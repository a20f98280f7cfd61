"""Modes by MAVLink: DO_SET_MODE, the old SET_MODE where that is not known, and the heartbeat that shows what came
of it."""

from collections.abc import Mapping
from typing import Any, Final

from lightgesture.sinks.mavlink_jobs import CommandJob, Job, Talk
from lightgesture.vehicle.interface import SendCommand, SetMode

SHOWN_S: Final = 2.5
"""Seconds in which a heartbeat must show the mode: they come once a second, and one may get lost."""

_DO_SET_MODE: Final = 176
_REQUEST_MESSAGE: Final = 512
_CUSTOM: Final = 1
"""MAV_MODE_FLAG_CUSTOM_MODE_ENABLED alone: the flag that says "armed" is never set."""

_REAL_REFUSALS: Final = (4,)
"""Results after which the old message is of no use: the vehicle knows the command, and cannot enter the mode."""


class ModeJob(Job):
    """Tries one mode after the other until the vehicle is in it.

    numbers: name -> number of all modes. mode: the vehicle's present number, kept up by `note_mode`.
    """

    def __init__(self, talk: Talk, order: SetMode, numbers: Mapping[str, int], mode: int | None) -> None:
        super().__init__(talk)
        self._left = [name for name in order.names if name in numbers]
        self._numbers, self._mode = numbers, mode
        self._failed: list[str] = []
        self._command: CommandJob | None = None
        self._shown_by_s: float | None = None
        self._is_old_way = False
        if not self._left:
            self.reply.refuse("no such mode")

    @property
    def kind(self) -> tuple[object, ...]:
        return ("mode",)

    @property
    def wanted(self) -> int | None:
        """The number of the mode that is tried."""
        return self._numbers[self._left[0]] if self._left else None

    def note_mode(self, number: int) -> None:
        """A heartbeat shows this mode."""
        self._mode = number

    def note(self, message: Any, now_s: float) -> None:
        """Hand on to the command."""
        if self._command is not None:
            self._command.note(message, now_s)

    def poll(self, now_s: float) -> None:
        """Go on with the mode that is tried, or with the next."""
        while not self.is_done:
            if self._mode == self.wanted:
                self._accept()
            elif self._shown_by_s is not None:
                if now_s < self._shown_by_s:
                    return
                self._fail("is not entered")
            elif not self._ask(now_s):
                return

    def _ask(self, now_s: float) -> bool:
        """Send the command and heed its answer; whether there is more to do at once."""
        if self._command is None:
            self._command = CommandJob(self.talk, self._order())
        self._command.poll(now_s)
        reply = self._command.reply
        if reply.state == "pending":
            return False
        if reply.state == "accepted":
            self._await_mode(now_s)
        elif self._command.result in _REAL_REFUSALS:
            self._fail(reply.detail)
        else:
            dialect = self.talk.dialect
            self.talk.send(dialect.MAVLink_set_mode_message(self.talk.peer.system, _CUSTOM, self.wanted))
            self._is_old_way = True
            self._await_mode(now_s)
        return True

    def _await_mode(self, now_s: float) -> None:
        """A heartbeat comes within a second; one is asked for besides, which spares the diver most of that second."""
        dialect, peer = self.talk.dialect, self.talk.peer
        params = (float(dialect.MAVLINK_MSG_ID_HEARTBEAT), 0, 0, 0, 0, 0, 0)
        self.talk.send(
            dialect.MAVLink_command_long_message(peer.system, peer.target, _REQUEST_MESSAGE, 0, *params)
        )
        self._shown_by_s = now_s + SHOWN_S

    def _order(self) -> SendCommand:
        params = (float(_CUSTOM), float(self.wanted or 0), 0.0, 0.0, 0.0, 0.0, 0.0)
        return SendCommand(
            name="MAV_CMD_DO_SET_MODE", command=_DO_SET_MODE, params=params, component=self.talk.peer.target
        )

    def _accept(self) -> None:
        way = " by SET_MODE" if self._is_old_way else ""
        failed = f" ({'; '.join(self._failed)})" if self._failed else ""
        self.reply.accept(f"mode {self._left[0]}{way}{failed}")

    def _fail(self, reason: str) -> None:
        self._failed.append(f"{self._left.pop(0)} {reason}")
        self._command = self._shown_by_s = None
        self._is_old_way = False
        if not self._left:
            self.reply.refuse("; ".join(self._failed))
