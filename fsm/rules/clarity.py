"""What was shown clearly, and when: how much of the time around a word its sign was, and how often another number.

A window of the least length says how well a sign was seen at its best. A hand that is seen badly before and after may
be read for that long as another number, and so a number must be clear for a good part of the time that it was shown,
and another one must not have been nearly as likely for long.
"""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final

import numpy as np

from lightgesture.fsm.rules.readings import Spoken
from lightgesture.fsm.rules.windows import PASSAGE_S, TOLERANCE_S, Floats

CLEAR: Final = 2 * math.log(0.7)
"""Score of a frame, both hands together, from which a sign is clear in it: 0.7 for each hand."""

LIKELY: Final = math.log(0.25)
"""Score of a frame, both hands together, from which a number may be what is shown in it."""

NEARLY: Final = math.log(0.5)
"""How much less likely than the likeliest number another one may be that contests it, as a logarithm."""

MOST_RUNS: Final = 400
"""Runs that are remembered: ten a word of the longest sentence."""


@dataclass(slots=True)
class Run:
    """A sign that was clear without a break longer than a passage; times in seconds of the search.

    seen_from, seen_to: the same counted with both hands in view only. clear_s: of them, those of clear frames.
    """

    column: int
    began: float
    last: float
    seen_from: float
    seen_to: float
    clear_s: float = 0.0


@dataclass(slots=True)
class Lead:
    """A number that was the likeliest one without a break; times in seconds of the search.

    led_s: for how long. contested_s: of them, those in which another number was nearly as likely.
    """

    column: int
    began: float
    last: float
    led_s: float = 0.0
    contested_s: float = 0.0


class Clarity:
    """The runs of clear signs, and of likely numbers, of one stream.

    numbers: columns of the signs that are digits or carry a number.
    """

    def __init__(self, numbers: Sequence[int] = ()) -> None:
        self._numbers = np.array(numbers, np.intp)
        self._runs: deque[Run] = deque(maxlen=MOST_RUNS)
        self._leads: deque[Lead] = deque(maxlen=MOST_RUNS)
        self._now = 0.0
        self.seen = 0.0
        """Seconds with both hands in view so far."""

    def step(self, scores: Floats, passed_s: float, in_view_s: float) -> None:
        """Take in the scores of a frame, (columns,), which stands for so many seconds."""
        before, seen_before = self._now, self.seen
        self._now += passed_s
        self.seen += in_view_s
        self._step_numbers(scores, before, passed_s)
        column = int(scores.argmax())
        if scores[column] < CLEAR:
            return
        run = self._latest(column)
        if run is None or before - run.last > PASSAGE_S + TOLERANCE_S:
            run = Run(column, before, before, seen_before, seen_before)
            self._runs.append(run)
        run.last, run.seen_to = self._now, self.seen
        run.clear_s += in_view_s

    def _step_numbers(self, scores: Floats, before: float, passed_s: float) -> None:
        if len(self._numbers) < 2:
            return
        own = scores[self._numbers]
        first = int(own.argmax())
        if own[first] < LIKELY:
            return
        column, score = int(self._numbers[first]), float(own[first])
        own[first] = -math.inf
        lead = self._leads[-1] if self._leads else None
        if lead is None or lead.column != column or lead.last != before:
            lead = Lead(column, before, before)
            self._leads.append(lead)
        lead.last = self._now
        lead.led_s += passed_s
        if own.max() > max(LIKELY, score + NEARLY):
            lead.contested_s += passed_s

    def _latest(self, column: int) -> Run | None:
        """The last run of a sign, if nothing but a few others came since."""
        return next((run for run in islice(reversed(self._runs), 4) if run.column == column), None)

    def clear(self, spoken: tuple[Spoken, ...]) -> Iterator[tuple[float, float]]:
        """Of each word between the first and the last, with both hands in view: its clear seconds, and their share of
        those from the last clear frame of the word before it to the first of the word after it, 0 to 1."""
        for before, word, after in zip(spoken, spoken[1:], spoken[2:], strict=False):
            ends = (run.seen_to for run in self._of(before, before.began, word.began))
            since = word.seen if word.is_again else max(ends, default=before.seen)
            until = min((run.seen_from for run in self._of(after, after.began, math.inf)), default=after.seen)
            clear = sum(run.clear_s for run in self._of(word, word.began, after.began))
            yield clear, clear / max(until - since, clear, TOLERANCE_S)

    def contested(self, word: Spoken, after: Spoken) -> float:
        """For how much of the time that a number was likely, from its beginning to that of the word after it, another
        one was nearly as likely or more, 0 to 1."""
        led_s = contested_s = 0.0
        for lead in self._leads:
            if word.began <= (lead.began + lead.last) / 2 + PASSAGE_S < after.began:
                led_s += lead.led_s
                contested_s += lead.contested_s if lead.column == word.column else lead.led_s
        return contested_s / max(led_s, TOLERANCE_S)

    def _of(self, word: Spoken, first: float, end: float) -> Iterator[Run]:
        """The runs of a word's sign that touch the time from `first` to `end`."""
        return (
            run for run in self._runs if run.column == word.column and run.last > first and run.began < end
        )
