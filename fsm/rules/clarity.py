"""What was shown clearly, and when: how much of the time around a word its sign was.

A window of the least length says how well a sign was seen at its best. A hand that is seen badly before and after may
be read for that long as another number, and so a number must be clear for a good part of the time that it was shown.
"""

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Final

from lightgesture.fsm.rules.readings import Spoken
from lightgesture.fsm.rules.windows import PASSAGE_S, TOLERANCE_S, Floats

CLEAR: Final = 2 * math.log(0.7)
"""Score of a frame, both hands together, from which a sign is clear in it: 0.7 for each hand."""

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


class Clarity:
    """The runs of clear signs of one stream."""

    def __init__(self) -> None:
        self._runs: deque[Run] = deque(maxlen=MOST_RUNS)
        self._now = 0.0
        self.seen = 0.0
        """Seconds with both hands in view so far."""

    def step(self, scores: Floats, passed_s: float, in_view_s: float) -> None:
        """Take in the scores of a frame, (columns,), which stands for so many seconds."""
        before, seen_before = self._now, self.seen
        self._now += passed_s
        self.seen += in_view_s
        column = int(scores.argmax())
        if scores[column] < CLEAR:
            return
        run = self._latest(column)
        if run is None or before - run.last > PASSAGE_S + TOLERANCE_S:
            run = Run(column, before, before, seen_before, seen_before)
            self._runs.append(run)
        run.last, run.seen_to = self._now, self.seen
        run.clear_s += in_view_s

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

    def _of(self, word: Spoken, first: float, end: float) -> Iterator[Run]:
        """The runs of a word's sign that touch the time from `first` to `end`."""
        return (
            run for run in self._runs if run.column == word.column and run.last > first and run.began < end
        )
