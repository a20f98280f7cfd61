"""The events of a frame as they are made, their time, and the pace of those that are for displays."""

import math

from lightgesture.fsm.events import Certainty, Event, Growth, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.language.forms import Form
from lightgesture.fsm.language.table import Arguments
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.sentence import Sentence

DISPLAY_INTERVAL_S = 0.2
"""Shortest time between two `state` records while a hold grows, seconds: five a second."""

DECIMALS = 4
"""Decimals of confidences and progress in the events."""


class Timeline:
    """Seconds that never run back, whatever stamps come in: a loop or a reset of the source adds nothing.

    now_s: the time so far. time_s: the last stamp that was finite.
    """

    def __init__(self) -> None:
        self.now_s = 0.0
        self.time_s = 0.0
        self._offset_s = 0.0

    def advance(self, time_s: float) -> float:
        """The time after a frame stamped `time_s`: stands still where a stamp runs back or is not finite."""
        now_s = time_s + self._offset_s
        if self.now_s <= now_s < math.inf:  # never true of a stamp that is no number
            self.now_s = now_s
            self.time_s = time_s
        elif math.isfinite(time_s):
            self._offset_s = self.now_s - time_s
            self.time_s = time_s
        return self.now_s


class Reporter:
    """Collects the events of one frame. source: name of the input. timeline: has the time stamp, frame the number."""

    def __init__(self, source: str | None, timeline: Timeline) -> None:
        self._source = source
        self._timeline = timeline
        self.frame = -1
        self.events: list[Event] = []
        self.shown_s = -math.inf
        """When something was last shown, seconds of the timeline."""
        self.is_growth_shown = False

    def word(self, hold: Hold, word: str, state: str) -> None:
        """A sign has its place; state: the sentence so far, or "idle"."""
        self.events.append(
            Word(
                source=self._source,
                frame=self.frame,
                time_s=self._timeline.time_s,
                pair=hold.pair,
                word=word,
                state=state,
                confidence=round(hold.confidence, DECIMALS),
            )
        )

    def instruction(self, form: Form, sentence: Sentence, arguments: Arguments) -> None:
        """A sentence is complete and makes sense."""
        self.events.append(
            Instruction(
                source=self._source,
                frame=self.frame,
                time_s=self._timeline.time_s,
                start_frame=sentence.start_frame,
                start_time_s=sentence.start_time_s,
                text=sentence.text,
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
                time_s=self._timeline.time_s,
                reason=reason,
                text=text,
                detail=detail,
            )
        )

    def notice(self, reason: str, detail: str) -> None:
        """Something to tell the diver; the sentence is kept."""
        self.events.append(
            Notice(
                source=self._source,
                frame=self.frame,
                time_s=self._timeline.time_s,
                reason=reason,
                detail=detail,
            )
        )

    def state(
        self, state: str, sentence: str, growth: Growth | None, certainty: Certainty | None = None
    ) -> None:
        """What a display shows from now on."""
        self.shown_s = self._timeline.now_s
        self.is_growth_shown = growth is not None
        self.events.append(
            State(
                source=self._source,
                frame=self.frame,
                time_s=self._timeline.time_s,
                state=state,
                sentence=sentence,
                dwell=growth,
                certainty=certainty,
            )
        )
