"""The loaded mission by MAVLink: how many items there are, which is next, and the mode in which it runs."""

from collections.abc import Mapping
from typing import Any

from lightgesture.sinks.mavlink_jobs import Job, Repeated, Talk
from lightgesture.vehicle.interface import SetMode, StartMission
from lightgesture.vehicle.mavlink_modes import ModeJob


class _CountJob(Repeated):
    """How many items the loaded mission has, in `Reply.value`."""

    @property
    def kind(self) -> tuple[object, ...]:
        return ("mission count",)

    def message(self) -> Any:
        """MISSION_REQUEST_LIST."""
        peer = self.talk.peer
        return self.talk.dialect.MAVLink_mission_request_list_message(peer.system, peer.target, 0)

    def note(self, message: Any, now_s: float) -> None:  # noqa: ARG002 - those of its base
        """Heed MISSION_COUNT, and say that no item is wanted."""
        talk = self.talk
        is_answer = (
            message.get_type() == "MISSION_COUNT"
            and talk.is_from(message, talk.peer.target)
            and talk.is_for_us(message)
        )
        if is_answer and self.sent and not self.is_done:
            self.reply.accept(value=float(message.count))
            talk.send(talk.dialect.MAVLink_mission_ack_message(talk.peer.system, talk.peer.target, 0, 0))


class _CurrentJob(Repeated):
    """Makes an item the next one."""

    def __init__(self, talk: Talk, item: int) -> None:
        super().__init__(talk)
        self._item = item

    @property
    def kind(self) -> tuple[object, ...]:
        return ("mission current",)

    def message(self) -> Any:
        """MISSION_SET_CURRENT."""
        peer = self.talk.peer
        return self.talk.dialect.MAVLink_mission_set_current_message(peer.system, peer.target, self._item)

    def note(self, message: Any, now_s: float) -> None:  # noqa: ARG002 - those of its base
        """Heed MISSION_CURRENT with the item."""
        is_current = message.get_type() == "MISSION_CURRENT" and self.talk.is_from(
            message, self.talk.peer.target
        )
        if is_current and message.seq == self._item and self.sent and not self.is_done:
            self.reply.accept()


class MissionJob(Job):
    """Counts the items, sets the next one, enters the mode; refused at the first that fails."""

    def __init__(self, talk: Talk, order: StartMission, numbers: Mapping[str, int], mode: int | None) -> None:
        super().__init__(talk)
        self._order = order
        self.mode = ModeJob(talk, SetMode(names=(order.mode,)), numbers, mode)
        self._parts: list[Job] = [_CountJob(talk), _CurrentJob(talk, order.first), self.mode]
        self._last = order.first

    @property
    def kind(self) -> tuple[object, ...]:
        return ("mode",)

    def note(self, message: Any, now_s: float) -> None:
        """Hand on."""
        for job in self._parts:
            job.note(message, now_s)

    def poll(self, now_s: float) -> None:
        """Go on with the part that is not done."""
        while not self.is_done:
            if not self._parts:
                self.reply.accept(value=float(self._last))
                return
            job = self._parts[0]
            job.poll(now_s)
            if job.reply.state == "refused":
                what = "the mode" if job is self.mode else "the mission"
                self.reply.refuse(f"{what}: {job.reply.detail}")
            elif not job.is_done:
                return
            else:
                self._parts.pop(0)
                if job.reply.value is not None:
                    self._check_count(int(job.reply.value))

    def _check_count(self, count: int) -> None:
        last = count - 1 if self._order.last is None else self._order.last
        self._last = last
        if not self._order.first <= last < count:
            wanted = max(self._order.first, last)
            self.reply.refuse(f"item {wanted} of the mission is not loaded; the vehicle has {count}")
