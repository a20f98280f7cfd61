"""The vehicle's own motion as an answer to the diver: it nods or shakes, through the executor."""

from typing import Final, Literal, Protocol

from lightgesture.records import Record
from lightgesture.sinks.answers import Answer, answer_of
from lightgesture.sinks.outbox import Sink

WORDS: Final[dict[Answer, Literal["nod", "shake"]]] = {Answer.DONE: "nod", Answer.REFUSED: "shake"}
"""Accepted is seen by what the vehicle does then; a sign that is wanted again is told without a motion, which would
move the camera that looks at it."""


class Mover(Protocol):
    """Who moves the vehicle, if nothing stands against it."""

    def answer(self, word: Literal["nod", "shake"]) -> None: ...


class MotionSink(Sink):
    """Asks for a nod where something is done, and for a shake where it is refused."""

    name = "motion"

    def __init__(self, mover: Mover) -> None:
        self._mover = mover

    def wants(self, record: Record) -> bool:
        """What is answered by a motion."""
        return answer_of(record, obeys=True) in WORDS

    def send(self, record: Record) -> None:
        """Ask for it."""
        answer = answer_of(record, obeys=True)
        if answer is not None:
            self._mover.answer(WORDS[answer])
