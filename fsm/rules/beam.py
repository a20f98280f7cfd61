"""The readings that are kept, in slots; what changes in every frame lies in arrays over the slots."""

from typing import Final

import numpy as np

from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.rules.loop import FreeLoop
from lightgesture.fsm.rules.readings import Reading
from lightgesture.fsm.rules.windows import NEVER, ROWS, Floats, Windows

SHORT_COST: Final = 1.5
"""What a word costs that has just reached its least length, given back while it is held on: a sign is held longer."""

SHORT_S: Final = 0.25
"""Seconds beyond the least length after which it is all given back."""

BEAM: Final = 12.0
"""How far behind the free loop a reading may be before it is given up, in units of score."""

MOST: Final = 40
"""Readings that are kept, the best ones: bounds time and memory."""

MOST_TEXTS: Final = 1000
"""Texts of readings, those that were given up included, that are told apart by number."""


class Beam:
    """The readings of one stream, by slot.

    held, gap: the score of a reading in its last sign, and in the gap after it; best: the better of the two. text: the
    number of what it says, -1 in an empty slot. sure: the less sure hand's summed scores over the best window of that
    sign. bridged: seconds with both hands in view since the sign was last the better of the two; longest: the most of
    it so far. credit: what of SHORT_COST is still to be given back. column: of the last sign. best_row, longest_row:
    best and longest in the last frames, where the windows' rows are. lead: the slot of the best reading.
    """

    def __init__(self, join: str | None, windows: Windows, loop: FreeLoop) -> None:
        self._join, self._windows, self._loop = join, windows, loop
        self.column = np.zeros(MOST, np.intp)
        self.best_row, self.longest_row = np.full((ROWS, MOST), NEVER), np.zeros((ROWS, MOST))
        self.clear()

    def clear(self) -> None:
        """Give up all readings."""
        self.readings: list[Reading | None] = [None] * MOST
        self.slots: dict[tuple[tuple[str, ...], int], int] = {}
        self._texts: dict[str, int] = {}
        self.text, self._touched = np.full(MOST, -1), np.zeros(MOST)
        self.held, self.gap = np.full(MOST, NEVER), np.full(MOST, NEVER)
        self.best = np.full(MOST, NEVER)
        self.sure = np.full(MOST, NEVER)
        self.bridged, self.longest, self.credit = np.zeros(MOST), np.zeros(MOST), np.zeros(MOST)
        self.best_row.fill(NEVER)
        self.lead: int | None = None

    # One frame

    def step(self, add: Floats, gap_add: float, passed_s: float, in_view_s: float) -> None:
        """Every reading goes on: in its sign, or in the gap."""
        if self.slots:
            self._go_on(add, gap_add, passed_s, in_view_s)
        row = self._windows.row
        self.best_row[row], self.longest_row[row] = self.best, self.longest

    def _go_on(self, add: Floats, gap_add: float, passed_s: float, in_view_s: float) -> None:
        column = self.column
        np.maximum(self.gap, self.held, out=self.gap)
        self.gap += gap_add
        back = np.minimum(self.credit, passed_s * (SHORT_COST / SHORT_S))
        self.credit -= back
        self.held += add[column]
        self.held += back
        is_held = self.held >= self.gap
        if self._windows.window is not None:
            np.maximum(self.sure, self._windows.weaker[column], out=self.sure, where=is_held)
        self.bridged += in_view_s
        self.bridged[is_held] = 0.0
        np.maximum(self.longest, self.bridged, out=self.longest)
        np.maximum(self.held, self.gap, out=self.best)

    def prune(self, timeout_s: float) -> None:
        """Give up what is far behind or has not grown for so long, and find what leads."""
        if not self.slots:
            return
        is_old = self._touched < self._windows.now - timeout_s
        is_given_up = (self.best < self._loop.score - BEAM) | is_old
        for slot in (is_given_up & (self.text >= 0)).nonzero()[0].tolist():
            self.drop(slot)
        self.lead = int(self.best.argmax()) if self.slots else None

    # Entering and leaving

    @property
    def known_texts(self) -> int:
        """Sentences that are told apart by a number; at most MOST_TEXTS and those of the readings."""
        return len(self._texts)

    def is_better(self, words: tuple[str, ...], column: int, score: float) -> bool:
        """Whether a reading with this score is worth keeping: it may already be there, with a better one."""
        slot = self.slots.get((words, column))
        return score > self._loop.score - BEAM if slot is None else score > self.best[slot]

    def text_number(self, words: tuple[str, ...]) -> int:
        """The number of what these words say, digits joined."""
        if len(self._texts) >= MOST_TEXTS:
            self._texts.clear()
            for slot, reading in enumerate(self.readings):
                if reading is not None:
                    text = spell(reading.words, self._join)
                    self.text[slot] = reading.text = self._texts.setdefault(text, len(self._texts))
        return self._texts.setdefault(spell(words, self._join), len(self._texts))

    def enter(self, reading: Reading, score: float) -> None:
        """Keep a reading whose last word begins to count now."""
        column = reading.spoken[-1].column
        key = reading.words, column
        slot = self.slots.get(key)
        if slot is None:
            slot = self._free_slot(score)
            if slot is None:
                return
            self.slots[key] = slot
            self.gap[slot] = NEVER
            self.best_row[:, slot] = NEVER
        self.readings[slot] = reading
        self.text[slot], self.column[slot] = reading.text, column
        self._touched[slot] = reading.touched
        self.held[slot] = self.best[slot] = score
        self.credit[slot], self.bridged[slot], self.longest[slot] = SHORT_COST, 0.0, reading.longest
        self.sure[slot] = self._windows.weaker[column]

    def _free_slot(self, score: float) -> int | None:
        """A slot for a new reading, at need that of the worst one; None where all are better."""
        slot = int(self.best.argmin())
        if self.readings[slot] is not None:
            if self.best[slot] >= score:
                return None
            self.drop(slot)
        return slot

    def drop(self, slot: int) -> None:
        """Give up the reading of a slot."""
        reading = self.readings[slot]
        if reading is not None:
            del self.slots[reading.words, int(self.column[slot])]
        self.readings[slot] = None
        self.text[slot] = -1
        self.best[slot] = self.held[slot] = self.gap[slot] = NEVER

    def ask(self, count: int, words: frozenset[str]) -> None:
        """In readings of so many words, one of `words` replaces the last one when it is shown again."""
        for reading in self.readings:
            if reading is not None and len(reading.spoken) == count and reading.words[-1] in words:
                reading.asked, reading.asked_s = words, self._windows.now
