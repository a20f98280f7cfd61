"""The events of a frame as they are made, and the pace of those that are for displays."""

import math

from lightgesture.fsm.dwell import Hold
from lightgesture.fsm.events import Event, Growth, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.forms import Form
from lightgesture.fsm.sentence import Sentence
from lightgesture.fsm.table import Arguments

DISPLAY_INTERVAL_S = 0.2
"""Shortest time between two `state` records while a hold grows, seconds: five a second."""

DECIMALS = 4
"""Decimals of confidences and progress in the events."""


class Reporter:
    """Collects the events of one frame. source: name of the input. frame, time_s: of the frame, in the events."""

    __slots__ = ("_source", "events", "frame", "is_growth_shown", "shown_s", "time_s")

    def __init__(self, source: str | None) -> None:
        self._source = source
        self.frame = -1
        self.time_s = 0.0
        self.events: list[Event] = []
        self.shown_s = -math.inf
        """When something was last shown, seconds of the decoder's timeline."""
        self.is_growth_shown = False

    def word(self, hold: Hold, word: str, state: str) -> None:
        """A sign has its place; state: the sentence so far, or "idle"."""
        self.events.append(
            Word(
                source=self._source,
                frame=self.frame,
                time_s=self.time_s,
                pair=hold.pair,
                word=word,
                state=state,
                confidence=round(hold.confidence, DECIMALS),
            )
        )

    def instruction(self, form: Form, sentence: Sentence, text: str, arguments: Arguments) -> None:
        """A sentence is complete and makes sense."""
        self.events.append(
            Instruction(
                source=self._source,
                frame=self.frame,
                time_s=self.time_s,
                start_frame=sentence.start_frame,
                start_time_s=sentence.start_time_s,
                text=text,
                kind=form.kind,
                action=arguments.action,
                duration_s=arguments.seconds,
                program=arguments.program,
                parameter=arguments.parameter,
                change=arguments.change,
                confidence=round(sentence.confidence, DECIMALS),
                words=tuple(sentence.words),
            )
        )

    def rejected(self, reason: str, text: str, detail: str) -> None:
        """A sentence was dropped."""
        self.events.append(
            Rejected(
                source=self._source,
                frame=self.frame,
                time_s=self.time_s,
                reason=reason,
                text=text,
                detail=detail,
            )
        )

    def notice(self, reason: str, detail: str) -> None:
        """Something to tell the diver; the sentence is kept."""
        self.events.append(
            Notice(source=self._source, frame=self.frame, time_s=self.time_s, reason=reason, detail=detail)
        )

    def state(self, state: str, sentence: str, growth: Growth | None, now_s: float) -> None:
        """What a display shows from now on, `now_s` seconds of the decoder's timeline."""
        self.shown_s = now_s
        self.is_growth_shown = growth is not None
        self.events.append(
            State(
                source=self._source,
                frame=self.frame,
                time_s=self.time_s,
                state=state,
                sentence=sentence,
                dwell=growth,
            )
        )
