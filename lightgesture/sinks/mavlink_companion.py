"""Our half of a MAVLink link: heartbeat, texts, what the map says, and what became of its commands."""

from collections.abc import Callable
from typing import Any, Final

from lightgesture.fsm import Instruction
from lightgesture.records import HeartbeatRecord, Record, VehicleRecord
from lightgesture.sinks.mavlink_jobs import CommandJob, Talk
from lightgesture.sinks.mavlink_map import MavlinkMap
from lightgesture.sinks.mavlink_texts import Texts, text_of
from lightgesture.vehicle.interface import SendCommand

_MILLISECONDS, _UINT32, _INT32 = 1000.0, 0xFFFFFFFF, 0x7FFFFFFF

MOST_JOBS: Final = 32
"""Commands that wait for an answer at a time; beyond, the oldest is let go."""

Tell = Callable[[VehicleRecord], None]
"""Takes what became of a command, at once."""


class Companion:
    """Sends what a record leads to, and awaits what the vehicle says to the commands of the map.

    tell: takes the vehicle's answers. All calls come from one thread; none waits.
    """

    def __init__(self, talk: Talk, mapping: MavlinkMap | None = None, tell: Tell | None = None) -> None:
        self._talk, self._mapping, self._tell = talk, mapping or MavlinkMap(), tell
        self._texts = Texts(talk.dialect)
        self._jobs: list[tuple[CommandJob, str, Instruction]] = []

    @staticmethod
    def wants(record: Record) -> bool:
        """Whether a record leads to anything."""
        return isinstance(record, HeartbeatRecord) or text_of(record) is not None

    def send(self, record: Record, now_s: float) -> None:
        """Send the messages of one record. SinkError: the link is dead."""
        if isinstance(record, HeartbeatRecord):
            self._send_heartbeat()
            return
        for message in self._texts.messages(record, now_s):
            self._talk.send(message)
        if isinstance(record, Instruction):
            self._send_values(record)
            self._begin_commands(record)
        self.poll(now_s)

    def note(self, message: Any, now_s: float) -> None:
        """Look at a message that came; of two that wait for the same answer the older gets it."""
        for job, *_ in self._jobs:
            if not job.is_done:
                job.note(message, now_s)
                if job.is_done:
                    return

    def poll(self, now_s: float) -> None:
        """Send again what was not answered, and tell what was. SinkError: the link is dead."""
        for job, name, record in self._jobs:
            job.poll(now_s)
            if job.is_done:
                self._report(job, name, record, now_s)
        self._jobs = [item for item in self._jobs if not item[0].is_done]

    def _report(self, job: CommandJob, name: str, record: Instruction, now_s: float) -> None:
        if self._tell is None:
            return
        is_accepted = job.reply.state == "accepted"
        detail = name if is_accepted else f"{name}: {job.reply.detail}"
        self._tell(
            VehicleRecord(
                time_s=round(now_s, 3),
                state="accepted" if is_accepted else "refused",
                instruction=record.text,
                detail=detail,
            )
        )

    def _send_heartbeat(self) -> None:
        dialect = self._talk.dialect
        self._talk.send(
            dialect.MAVLink_heartbeat_message(
                dialect.MAV_TYPE_ONBOARD_CONTROLLER,
                dialect.MAV_AUTOPILOT_INVALID,
                0,  # base mode: no flag, and so never the one that says "armed"
                0,
                dialect.MAV_STATE_ACTIVE,
                3,  # version of the protocol
            )
        )

    def _send_values(self, record: Instruction) -> None:
        for rule, number in self._mapping.values(record):
            send_value(self._talk, rule.name, number, record.time_s, rule.is_float)

    def _begin_commands(self, record: Instruction) -> None:
        for name, command, component, params in self._mapping.commands(record):
            order = SendCommand(name=name, command=command, params=tuple(params), component=component)
            self._jobs.append((CommandJob(self._talk, order), name, record))
        for job, *_ in self._jobs[:-MOST_JOBS]:
            job.reply.refuse(f"more than {MOST_JOBS} commands wait for an answer")


def send_value(talk: Talk, name: str, number: float, time_s: float, is_float: bool) -> None:
    """Send a named value, whole unless `is_float`."""
    dialect, time_ms, content = talk.dialect, int(time_s * _MILLISECONDS) & _UINT32, name.encode("ascii")
    if is_float:
        talk.send(dialect.MAVLink_named_value_float_message(time_ms, content, number))
    else:
        whole = max(-_INT32, min(_INT32, round(number)))
        talk.send(dialect.MAVLink_named_value_int_message(time_ms, content, whole))
