"""What the executor is shown: from any thread, taken in by its own."""

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from lightgesture.features.types import Image
from lightgesture.fsm import Instruction, Notice, State
from lightgesture.records import FrameRecord, Record
from lightgesture.vehicle.bench import Frame
from lightgesture.vehicle.guard import Senses

MAX_AGE_S: Final = 1.0
"""Seconds after which an instruction that waited is not begun any more: it would meet another situation."""


@dataclass(frozen=True, slots=True)
class Taken:
    """What came since the last look. new: instructions that are fresh; late: those that are not. frame: the newest."""

    new: tuple[Instruction, ...]
    late: tuple[Instruction, ...]
    senses: Senses
    frame: Frame | None


class Intake:
    """Takes pictures and records. clock: the executor's."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._instructions: list[tuple[float, Instruction]] = []
        self._picture_s: float | None = None
        self._hand_s: float | None = None
        self._hole: str | None = None
        self._frame: Frame | None = None

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Take note of a picture and its records, at once."""
        now_s = self._clock()
        with self._lock:
            if image_bgr is not None:
                self._picture_s, self._frame = now_s, Frame(image_bgr, now_s)
            for record in records:
                if isinstance(record, Instruction):
                    self._instructions.append((now_s, record))
                elif shows_diver(record):
                    self._hand_s = now_s
                elif isinstance(record, Notice) and record.reason == "gap":
                    self._hole = record.detail

    def take(self, now_s: float) -> Taken:
        """What came; a hole in the pictures is told once."""
        with self._lock:
            waiting, self._instructions = self._instructions, []
            senses = Senses(self._picture_s, self._hand_s, self._hole)
            self._hole = None
            frame = self._frame
        new = tuple(record for shown_s, record in waiting if now_s - shown_s <= MAX_AGE_S)
        late = tuple(record for shown_s, record in waiting if now_s - shown_s > MAX_AGE_S)
        return Taken(new, late, senses, frame)


def shows_diver(record: Record) -> bool:
    """Whether a record tells of a hand or a sign in view."""
    if isinstance(record, FrameRecord):
        return bool(record.hands)
    return isinstance(record, State) and record.dwell is not None
