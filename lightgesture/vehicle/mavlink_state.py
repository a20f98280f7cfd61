"""What a vehicle tells of itself unasked: mode, start, mission, pictures."""

from typing import Any, Final

from lightgesture.sinks.mavlink_jobs import Job, Talk
from lightgesture.vehicle.interface import Picture, Status
from lightgesture.vehicle.mavlink_missions import MissionJob
from lightgesture.vehicle.mavlink_modes import ModeJob
from lightgesture.vehicle.mavlink_pilot import PilotWatch

REBOOT_MS: Final = 1000
"""Milliseconds by which the vehicle's clock must have gone back to have started anew; messages may overtake each
other."""

_CLOCKS = ("SYSTEM_TIME", "ATTITUDE", "GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "RC_CHANNELS")
"""Messages with the time since the vehicle's start, which most vehicles send unasked."""


class Told:
    """Takes every message. names: of the modes, by their numbers."""

    def __init__(self, talk: Talk, pilot: PilotWatch, names: dict[int, str]) -> None:
        self._talk, self._peer, self._pilot, self._names = talk, talk.peer, pilot, names
        self.mode: int | None = None
        self._ordered: set[int] = set()
        self._foreign_modes = self._boots = 0
        self._boot_ms: int | None = None
        self._item: int | None = None
        self._pictures: list[Picture] = []

    def begin_mission(self) -> None:
        """Items that were reached before do not count."""
        self._item = None

    def note_order(self, job: Job) -> None:
        """The mode that a job is about to bring is ordered by us."""
        mode = mode_job(job)
        if mode is not None and mode.wanted is not None:
            self._ordered.add(mode.wanted)

    def note(self, message: Any, jobs: list[Job], now_s: float) -> None:
        """Look at a message. jobs: those that are not done."""
        kind = message.get_type()
        if kind == "HEARTBEAT":
            self._peer.note(message, now_s)
        self._pilot.note(message, now_s)
        if kind == "CAMERA_IMAGE_CAPTURED" and message.get_srcSystem() == self._peer.system:
            self._pictures.append(Picture(number=message.image_index, place=message.file_url))
        if not self._talk.is_from(message, self._peer.target):
            return
        if kind == "HEARTBEAT":
            self._note_mode(message.custom_mode, jobs)
        elif kind in _CLOCKS:
            self._note_clock(message.time_boot_ms)
        elif kind == "MISSION_ITEM_REACHED":
            self._item = message.seq

    def status(self, trouble: str) -> Status:
        """All that is known; trouble: what is wrong with the link, "" where nothing is."""
        heard, pictures = self._peer.heard, tuple(self._pictures)
        self._pictures.clear()
        return Status(
            heard_s=None if heard is None else heard.time_s,
            mode="" if self.mode is None else self._names.get(self.mode, str(self.mode)),
            foreign_modes=self._foreign_modes,
            is_armed=heard is not None and heard.is_armed,
            boots=self._boots,
            pilot_s=self._pilot.pilot_s,
            stick_s=self._pilot.stick_s,
            rival_s=self._peer.rival_s,
            trouble=trouble or self._peer.trouble,
            item=self._item,
            pictures=pictures,
        )

    def _note_mode(self, number: int, jobs: list[Job]) -> None:
        if number == self.mode:
            return
        if self.mode is not None and number not in self._ordered:
            self._foreign_modes += 1
        self.mode = number
        # What was ordered before has come, or was overtaken; only a job that is not done may still bring another.
        self._ordered = set()
        for job in jobs:
            mode = mode_job(job)
            if mode is not None:
                mode.note_mode(number)
                self._ordered |= {mode.wanted} if mode.wanted is not None else set()

    def _note_clock(self, boot_ms: int) -> None:
        if self._boot_ms is not None and boot_ms < self._boot_ms - REBOOT_MS:
            self._boots += 1
        self._boot_ms = boot_ms


def mode_job(job: Job) -> ModeJob | None:
    """What of a job is about a mode."""
    if isinstance(job, MissionJob):
        return job.mode
    return job if isinstance(job, ModeJob) else None
