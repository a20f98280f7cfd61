"""What displays follow while a sentence is signed by the rule "sentence": the growing sign and the best reading."""

from lightgesture.fsm.events import Certainty, Growth
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import DECIMALS, DISPLAY_INTERVAL_S, Reporter
from lightgesture.fsm.rules.search import Search
from lightgesture.fsm.rules.windows import Floats

CLEAR = -2.0
"""Least score of the likeliest sign of a frame for it to grow on a display."""


class Display:
    """Makes `state` records of a search. top: the column of the sign that is the likeliest now, -1 before any."""

    def __init__(self, search: Search, reader: Reader, reporter: Reporter) -> None:
        self._search, self._reader, self._reporter = search, reader, reporter
        self.reset()

    def reset(self) -> None:
        """As at the start of a stream."""
        self.top, self._top_s = -1, 0.0

    def follow(self, scores: Floats, step_s: float) -> None:
        """Which sign is the likeliest now, and for how long it has been. scores: of a frame of `step_s` seconds."""
        top = int(scores.argmax())
        if top == self.top and scores[top] > CLEAR:
            self._top_s += step_s
        else:
            self.top, self._top_s = top, 0.0

    def show_growth(self, told: tuple[str, ...], now_s: float) -> None:
        """Show the growing sign, a few times a second."""
        is_growing = self.top >= 0 and self._top_s > 0.0
        is_due = now_s - self._reporter.shown_s >= DISPLAY_INTERVAL_S
        if (is_growing or self._reporter.is_growth_shown) and is_due:
            self.show(told)

    def show(self, told: tuple[str, ...]) -> None:
        """Show the sign that is growing and, where words of a sentence were told, its best reading."""
        growth = certainty = None
        search, reader = self._search, self._reader
        progress = self._top_s / search.hold_s
        if 0.0 < progress < 1.0:
            shown = search.scores.shown(self.top)
            growth = Growth(pair=shown, word=reader.word_of(shown), progress=round(progress, DECIMALS))
        elif not self._reporter.is_growth_shown and not told:
            return
        lead = search.lead
        reading = None if lead is None else search.beam.readings[lead]
        if told and lead is not None and reading is not None:
            sure = [round(value, DECIMALS) for value in search.standing.certainties(lead)]
            words = tuple(zip(reading.words, sure, strict=True))
            certainty = Certainty(words=words, expected=reader.expected)
        reader.show(growth, certainty)
