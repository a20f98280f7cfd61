"""A vehicle by MAVLink."""

import time
from collections import deque
from collections.abc import Callable
from typing import Any, Final

from lightgesture.backoff import Backoff
from lightgesture.records import Record
from lightgesture.sinks.mavlink_companion import Companion, send_value
from lightgesture.sinks.mavlink_jobs import CommandJob, Job, Talk
from lightgesture.sinks.mavlink_link import Link, Wire
from lightgesture.sinks.mavlink_map import MavlinkMap
from lightgesture.sinks.mavlink_peer import Peer
from lightgesture.sinks.outbox import CAPACITY, MAX_AGE_S, SinkError
from lightgesture.vehicle.interface import (
    NEUTRAL,
    Order,
    ReadParameter,
    Reply,
    SendCommand,
    SendValue,
    SetMode,
    StartMission,
    Status,
    Stick,
    StopPictures,
    TakePictures,
    Vehicle,
    WriteParameter,
)
from lightgesture.vehicle.mavlink_missions import MissionJob
from lightgesture.vehicle.mavlink_modes import ModeJob
from lightgesture.vehicle.mavlink_parameters import ParameterJob
from lightgesture.vehicle.mavlink_pilot import PilotWatch
from lightgesture.vehicle.mavlink_state import Told
from lightgesture.vehicle.profile import Profile

_WAY: Final = 1000
_IMAGE_START, _IMAGE_STOP = 2000, 2001
_LONGEST_RETRY_S: Final = 5.0


class MavlinkVehicle(Vehicle):
    """Implements the executor's vehicle on a link, and is our companion's half of it as well: `note` takes any record.

    system: the vehicle's number; None: learnt from its heartbeat. report: takes a line where the link breaks. It
    opens the link at the first poll, and again whenever it broke off.
    """

    def __init__(
        self,
        link: Link,
        profile: Profile,
        *,
        system: int | None = None,
        mapping: MavlinkMap | None = None,
        report: Callable[[str], None] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        table = profile.link
        self._link, self._profile, self._clock = link, profile, clock
        self._peer = Peer(system, table.component, table.target, table.timeout_s)
        self._talk = Talk(link, self._peer, table.answer_s, table.tries, table.progress_s)
        self._companion = Companion(self._talk, mapping)
        self._pilot = PilotWatch(profile, self._peer)
        self._report = report
        self._records: deque[tuple[float, Record]] = deque(maxlen=CAPACITY)
        self._jobs: list[Job] = []
        self._kinds: dict[str, int] = {}
        self._told = Told(self._talk, self._pilot, {number: name for name, number in profile.modes.items()})
        self._shots = 0
        self._backoff, self._open_s = Backoff(longest_s=_LONGEST_RETRY_S), float("-inf")
        self._broken = ""

    def note(self, record: Record) -> None:
        """Send what a record leads to, such as a text for the pilot, at the next poll; from any thread."""
        if self._companion.wants(record):
            self._records.append((self._clock(), record))

    def poll(self, now_s: float) -> Status:
        """Receive, send, and say how things stand."""
        try:
            if self._link.is_open or self._reopen(now_s):
                self._exchange(now_s)
        except SinkError as error:
            self._lose(str(error), now_s)
        self._peer.poll(now_s)
        return self._told.status(self._broken)

    def stick(self, stick: Stick, now_s: float) -> None:
        """Send MANUAL_CONTROL."""
        if not self._link.is_open:
            return
        self._pilot.note_own(stick == NEUTRAL, now_s)
        try:
            table = self._profile.stick
            self._link.send(self._manual_control(stick), table.system, self._peer.component)
        except SinkError as error:
            self._lose(str(error), now_s)

    def order(self, order: Order, now_s: float) -> Reply:
        """Send it at once; the rest in later polls."""
        if not self._link.is_open:
            reply = Reply()
            reply.refuse("the link is down")
            return reply
        if isinstance(order, SendValue):
            return self._send_value(order, now_s)
        job = self._job_for(order)
        for other in [other for other in self._jobs if other.kind == job.kind]:
            other.reply.refuse("replaced by another order")
            self._jobs.remove(other)
        self._jobs.append(job)
        try:
            self._poll_job(job, now_s)
        except SinkError as error:
            self._lose(str(error), now_s)
        return job.reply

    def neutral_packet(self) -> bytes:
        """The message that puts the sticks to their middle, for a process that has nothing but bytes."""
        table = self._profile.stick
        return self._link.packed(self._manual_control(NEUTRAL), table.system, self._peer.component)

    def mode_packet(self, name: str) -> bytes:
        """Likewise the old message that enters a mode."""
        message = self._talk.dialect.MAVLink_set_mode_message(self._peer.system, 1, self._profile.modes[name])
        return self._link.packed(message, self._peer.system, self._peer.component)

    def wire(self) -> Wire | None:
        """What another process needs to send on this link."""
        return self._link.wire() if self._link.is_open else None

    def close(self) -> None:
        """Close the link."""
        self._link.close()

    def _manual_control(self, stick: Stick) -> Any:
        table = self._profile.stick
        x, y, r = (round(way * _WAY) for way in (stick.x, stick.y, stick.r))
        z = table.z_neutral + round(stick.z * table.z_range)
        return self._talk.dialect.MAVLink_manual_control_message(self._peer.system, x, y, z, r, 0)

    def _exchange(self, now_s: float) -> None:
        for message in self._link.receive():
            self._take(message, now_s)
        while self._records:
            queued_s, record = self._records.popleft()
            # Not for long, as in every sink: it may meet another situation.
            if now_s - queued_s <= MAX_AGE_S:
                self._companion.send(record, now_s)
        self._companion.poll(now_s)
        for job in list(self._jobs):
            self._poll_job(job, now_s)
        self._jobs = [job for job in self._jobs if not job.is_done]

    def _poll_job(self, job: Job, now_s: float) -> None:
        job.poll(now_s)
        self._told.note_order(job)

    def _take(self, message: Any, now_s: float) -> None:
        self._told.note(message, self._jobs, now_s)
        self._companion.note(message, now_s)
        for job in self._jobs:
            job.note(message, now_s)

    def _send_value(self, order: SendValue, now_s: float) -> Reply:
        reply = Reply()
        try:
            send_value(self._talk, order.name, order.value, now_s, is_float=not order.value.is_integer())
            reply.accept()
        except SinkError as error:
            self._lose(str(error), now_s)
            reply.refuse(str(error))
        return reply

    def _job_for(self, order: Order) -> Job:
        match order:
            case SetMode():
                return ModeJob(self._talk, order, self._profile.modes, self._told.mode)
            case StartMission():
                self._told.begin_mission()
                return MissionJob(self._talk, order, self._profile.modes, self._told.mode)
            case ReadParameter():
                return ParameterJob(self._talk, order.name, self._kinds)
            case WriteParameter():
                return ParameterJob(self._talk, order.name, self._kinds, order.value)
            case TakePictures():
                return CommandJob(self._talk, self._start_pictures(order))
            case StopPictures():
                return CommandJob(
                    self._talk, _command("MAV_CMD_IMAGE_STOP_CAPTURE", _IMAGE_STOP, order.component)
                )
            case SendCommand():
                return CommandJob(self._talk, order)
            case SendValue():
                raise AssertionError("sent without a job")

    def _start_pictures(self, order: TakePictures) -> SendCommand:
        """A single picture bears a number, so that a command that came twice takes one picture."""
        self._shots += 1
        number = self._shots if order.count == 1 else 0
        interval_s = 0.0 if order.count == 1 else order.interval_s
        return _command(
            "MAV_CMD_IMAGE_START_CAPTURE", _IMAGE_START, order.component, 0, interval_s, order.count, number
        )

    def _reopen(self, now_s: float) -> bool:
        if now_s < self._open_s:
            return False
        self._link.open()
        self._backoff.reset()
        if self._broken and self._report is not None:
            self._report(f"{self._link.name}: works again")
        self._broken = ""
        return True

    def _lose(self, reason: str, now_s: float) -> None:
        """The link broke off: what was asked is not answered any more, and it is opened again after a while."""
        self._link.close()
        if not self._broken and self._report is not None:
            self._report(f"{reason}; trying again until it works")
        self._broken = reason
        self._open_s = now_s + self._backoff.next_wait()
        for job in self._jobs:
            if not job.is_done:
                job.reply.refuse(reason)
        self._jobs.clear()


def _command(name: str, command: int, component: int, *params: float) -> SendCommand:
    seven = (*map(float, params), *(0.0,) * (7 - len(params)))
    return SendCommand(name=name, command=command, params=seven, component=component)
