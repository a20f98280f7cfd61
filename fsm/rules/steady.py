"""Signs that count by themselves, without a sentence around them: control, the second end word, what opens nothing."""

from typing import Final

from lightgesture.fsm.rules.scores import GAP_SCORE
from lightgesture.fsm.rules.search import Search
from lightgesture.fsm.rules.windows import PASSAGE_S, RELEASE_SCORE, Floats

STEADY: Final = 0.5
"""Least geometric mean probability of a hand over the least length of a sign for it to count by itself, 0 to 1."""

KILL: Final = 0.3
"""The same for words of control: to stop is better than to go on."""


class SteadySign:
    """Finds the sign that was shown for the least length, once a hold."""

    def __init__(self, search: Search) -> None:
        self._search = search
        self.reset()

    def reset(self) -> None:
        """As at the start of a stream."""
        self._absent_s = self._from_s = 0.0

    def spend(self, column: int) -> None:
        """This sign was read: it must be gone before it counts again."""
        self._search.spent, self._absent_s = column, 0.0
        self._from_s = self._search.windows.now

    def spend_shown(self) -> None:
        """Whatever is shown now was read."""
        if self._search.windows.window is not None:
            self.spend(int(self._search.windows.window.argmax()))

    def process(self, scores: Floats, step_s: float) -> int | None:
        """The column of a sign that has been the likeliest for the least length, not read yet, and likely enough for
        control; None: there is none. scores: of this frame, which stands for `step_s` seconds."""
        search, windows = self._search, self._search.windows
        if search.spent is not None:
            is_there = scores[search.spent] > max(float(scores.max()), GAP_SCORE) - RELEASE_SCORE
            self._absent_s = 0.0 if is_there else self._absent_s + step_s
            if self._absent_s >= PASSAGE_S:
                search.spent = None
        if windows.window is None or windows.start_s < self._from_s:
            return None
        column = int(windows.window.argmax())
        return column if column != search.spent and windows.likelihood(column) >= KILL else None
