"""What the diver is answered: accepted, refused, done, show that again."""

from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Final

from lightgesture.fsm import Instruction, Notice, Rejected, State
from lightgesture.records import Record, VehicleRecord


class Answer(Enum):
    """One answer."""

    ACCEPTED = "accepted"
    REFUSED = "refused"
    DONE = "done"
    REPEAT = "repeat"


REPEATED: Final = ("unknown_pair", "repeat", "confirm", "out_of_order")
"""Notices after which the last sign is wanted again."""

_OF_VEHICLE: Final = {
    "accepted": Answer.ACCEPTED,
    "refused": Answer.REFUSED,
    "aborted": Answer.REFUSED,
    "done": Answer.DONE,
}
_ENDS: Final = ("refused", "aborted", "done")


def answer_of(record: Record, obeys: bool) -> Answer | None:
    """What a record tells the diver; None: nothing. obeys: whether a vehicle says what becomes of instructions."""
    match record:
        case VehicleRecord() if record.instruction is not None:
            return _OF_VEHICLE.get(record.state)
        case Instruction():
            return None if obeys else Answer.ACCEPTED
        case Rejected():
            return Answer.REFUSED
        case Notice() if record.reason in REPEATED:
            return Answer.REPEAT
        case _:
            return None


SHOWN_S: Final = {Answer.ACCEPTED: 1.5, Answer.REFUSED: 3.0, Answer.DONE: 3.0, Answer.REPEAT: 2.0}
"""Seconds for which an answer is shown before the light tells of idle and busy again."""

BLINK_S: Final = 0.25
"""Seconds for which a blinking light is on, and off; slower is missed at a glance."""


@dataclass(frozen=True, slots=True)
class Lights:
    """Three lamps, each on or off."""

    green: bool = False
    orange: bool = False
    red: bool = False


@dataclass(frozen=True, slots=True)
class Mood:
    """What the lights are made of. is_open: whether a sentence is open. tasks: instructions that are carried out.
    answer: the last one, at `since_s`."""

    is_open: bool = False
    tasks: frozenset[str] = field(default_factory=frozenset)
    answer: Answer | None = None
    since_s: float = 0.0


def advance(mood: Mood, record: Record, now_s: float, obeys: bool) -> Mood:
    """The mood after a record."""
    if isinstance(record, State):
        return replace(mood, is_open=record.state != "idle")
    if isinstance(record, VehicleRecord) and record.instruction is not None:
        is_over = record.state in _ENDS
        tasks = mood.tasks - {record.instruction} if is_over else mood.tasks | {record.instruction}
        mood = replace(mood, tasks=tasks)
    answer = answer_of(record, obeys)
    return mood if answer is None else replace(mood, answer=answer, since_s=now_s)


def lights(mood: Mood, now_s: float) -> Lights:
    """Green while idle, orange while busy, red after a failure; green blinks for accepted and done, orange for
    "again"."""
    elapsed_s = now_s - mood.since_s
    if mood.answer is not None and elapsed_s < SHOWN_S[mood.answer]:
        is_on = int(elapsed_s / BLINK_S) % 2 == 0
        if mood.answer is Answer.REFUSED:
            return Lights(red=True)
        return Lights(orange=is_on) if mood.answer is Answer.REPEAT else Lights(green=is_on)
    is_busy = mood.is_open or bool(mood.tasks)
    return Lights(orange=is_busy, green=not is_busy)
