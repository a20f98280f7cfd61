"""Many readings of one sentence at once: token passing through the grammar's table.

A reading is the words so far and the sign of the last one. In every frame it is either in that sign or in the gap
after it, and its score is that of the best way to cut the frames into signs and gaps (Young, Russell and Thornton,
"Token passing: a simple conceptual model for connected speech recognition systems", Cambridge 1989). A sign lasts
`hold_s` at least, so that a word enters with the scores of that long a window at once. Beside them runs the free
loop, the best score of any signs in any order, words or not; how far a reading stays behind it tells whether it fits
what was shown (utterance verification, as Rose and Paul, ICASSP 1990).
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Final

import numpy as np

from lightgesture.fsm.language.forms import is_digit, spell
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.rules.readings import Reading, Spoken, Summary
from lightgesture.fsm.rules.scores import GAP_SCORE, RATE, SignScores
from lightgesture.fsm.rules.windows import NEVER, ROWS, Floats, Windows
from lightgesture.fsm.signs import Signs

COST: Final = 0.5
"""What every word costs, in units of score: against readings that change their mind for a moment."""

SHORT_COST: Final = 1.5
"""What a word costs that has just reached its least length, given back while it is held on: a sign is held longer."""

SHORT_S: Final = 0.25
"""Seconds beyond the least length after which it is all given back."""

JOIN_COST: Final = 3.0
"""What a digit costs besides that follows another one without the joining word, once a sentence: hands that leave a
digit pass through others. Nothing where the language has no joining word."""

REACTION_S: Final = 0.5
"""Seconds that it takes at least to see that a sign is asked for again and to begin it: what comes sooner is the next
word, of a diver who did not look."""

BEAM: Final = 12.0
"""How far behind the free loop a reading may be before it is given up, in units of score."""

MOST: Final = 40
"""Readings that are kept, the best ones: bounds time and memory."""

MOST_TEXTS: Final = 1000
"""Texts of readings, those that were given up included, that are told apart by number."""

LIKELY: Final = 0.06
"""Geometric mean probability of a sign over the least length, 0 to 1, below which no word begins with it: more than
that of hands that are not in view."""


class Search:
    """The readings of one stream, by slot; what changes in every frame lies in arrays over the slots.

    held, gap: the score of a reading in its last sign, and in the gap after it. sure: the less sure hand's summed
    scores over the best window of that sign. bridged: seconds with both hands in view since the sign was last the
    better of the two; longest: the most of it so far. credit: what of SHORT_COST is still to be given back. is_wary:
    whether signs that mean something else inside a sentence may open none. spent: a sign that may not, because it is
    still held from what was read before.
    """

    def __init__(self, grammar: Grammar, hold_s: float) -> None:
        self._grammar = grammar
        self._join = grammar.vocabulary.join
        self.hold_s = hold_s
        self.scores = SignScores(grammar)
        self._least = 2 * hold_s * RATE * math.log(LIKELY)
        self._idle = self._columns(grammar.idle_words, set(grammar.table.transitions[0]))
        inside = {word for row in grammar.table.transitions[1:] for word in row}
        self._inside = self._columns({**grammar.sentence_words}, inside)
        for column, words in self._columns(grammar.menu_words, inside).items():
            self._inside[column] = tuple(dict.fromkeys((*self._inside.get(column, ()), *words)))
        self._idle_columns = np.array(sorted(self._idle), np.intp)
        self._inside_columns = np.array(sorted(self._inside), np.intp)
        self._column = np.zeros(MOST, np.intp)
        self.reset()

    def _columns(self, pairs: Mapping[tuple[str, str], str], words: set[str]) -> dict[int, tuple[str, ...]]:
        """The words of each column that lead anywhere, those that say themselves too."""
        found: dict[int, tuple[str, ...]] = {
            self.scores.column(pair): (word,) for pair, word in pairs.items() if word in words
        }
        found.update({self.scores.column((word,)): (word,) for word in words & {*self.scores.words}})
        return found

    def reset(self) -> None:
        """As at the start of a stream."""
        self.windows = Windows(self.scores.size, self.hold_s)
        self._free_row = [0.0] * ROWS
        self._free_signs, self._free_gap = np.full(self.scores.size, NEVER), 0.0
        self.free = 0.0
        self.is_wary = False
        self.spent: int | None = None
        self._best_row, self._longest_row = np.full((ROWS, MOST), NEVER), np.zeros((ROWS, MOST))
        self.clear()

    def clear(self) -> None:
        """Give up all readings; what is shown now opens a sentence only if it goes on for the least length."""
        self.readings: list[Reading | None] = [None] * MOST
        self._slots: dict[tuple[tuple[str, ...], int], int] = {}
        self._texts: dict[str, int] = {}
        self._text, self._touched = np.full(MOST, -1), np.zeros(MOST)
        self.held, self.gap = np.full(MOST, NEVER), np.full(MOST, NEVER)
        self.best = np.full(MOST, NEVER)
        self.sure = np.full(MOST, NEVER)
        self.bridged, self.longest, self.credit = np.zeros(MOST), np.zeros(MOST), np.zeros(MOST)
        self._best_row.fill(NEVER)
        self._cleared = self.windows.now
        self.lead: int | None = None

    # One frame

    @property
    def known_texts(self) -> int:
        """Sentences that are told apart by a number; at most MOST_TEXTS and those of the readings."""
        return len(self._texts)

    def step(self, signs: Signs, passed_s: float, in_view_s: float, frame: int, time_s: float) -> Floats:
        """Take in a frame, which stands for `passed_s` seconds; its scores. in_view_s: of them, those that count as
        passed over where nothing is read."""
        scores, of_left = self.scores.of(signs)
        weight = passed_s * RATE
        add, gap_add = scores * weight, GAP_SCORE * weight
        windows = self.windows
        windows.step(add, of_left * weight, gap_add, passed_s, (frame, time_s))
        self._step_free(add, gap_add)
        self._free_row[windows.row] = self.free
        if self._slots:
            self._step_readings(add, gap_add, passed_s, in_view_s)
        self._best_row[windows.row], self._longest_row[windows.row] = self.best, self.longest
        if windows.window is not None:
            self._extend(windows.window)
        if self._slots:
            self._prune()
        return scores

    def _step_free(self, add: Floats, gap_add: float) -> None:
        """The best of all signs in any order, each as long as a word at least."""
        self._free_gap = max(self._free_gap, float(self._free_signs.max())) + gap_add
        self._free_signs += add
        window = self.windows.window
        if window is not None:
            entered = window + (self.windows.passed(self._free_row) - COST)
            np.maximum(self._free_signs, entered, out=self._free_signs)
        self.free = max(self._free_gap, float(self._free_signs.max()))

    def _step_readings(self, add: Floats, gap_add: float, passed_s: float, in_view_s: float) -> None:
        """Every reading goes on: in its sign, or in the gap."""
        column = self._column
        np.maximum(self.gap, self.held, out=self.gap)
        self.gap += gap_add
        back = np.minimum(self.credit, passed_s * (SHORT_COST / SHORT_S))
        self.credit -= back
        self.held += add[column]
        self.held += back
        is_held = self.held >= self.gap
        if self.windows.window is not None:
            np.maximum(self.sure, self.windows.weaker[column], out=self.sure, where=is_held)
        self.bridged += in_view_s
        self.bridged[is_held] = 0.0
        np.maximum(self.longest, self.bridged, out=self.longest)
        np.maximum(self.held, self.gap, out=self.best)

    # New words

    def _extend(self, window: Floats) -> None:
        """Signs that were likely for the least length become words of the readings that they fit."""
        windows = self.windows
        if windows.start_s >= self._cleared:
            gains = window[self._idle_columns]
            for place in (gains > self._least).nonzero()[0].tolist():
                column = int(self._idle_columns[place])
                if column != self.spent and not (self.is_wary and column in self._inside):
                    score = windows.passed(self._free_row) + gains[place] - COST - SHORT_COST
                    self._open(column, float(score))
        if not self._slots or not windows.has_passage:
            return
        entered = windows.passed(self._best_row) - (COST + SHORT_COST)
        floor = self.free - BEAM
        gains = window[self._inside_columns]
        likely = (gains > max(self._least, floor - float(entered.max()))).nonzero()[0]
        if not len(likely):
            return
        scores = gains[likely, None] + entered
        for place, slot in zip(*map(list, (scores > floor).nonzero()), strict=True):
            reading = self.readings[slot]
            column = int(self._inside_columns[likely[place]])
            if reading is not None and (self._column[slot] != column or windows.is_released(column)):
                self._continue(slot, reading, column, float(scores[place, slot]))

    def _spoken(self, word: str, column: int, behind: float, fine: float) -> Spoken:
        """A word whose sign begins with the window."""
        frame, time_s = self.windows.start_stamp
        return Spoken(word, column, frame, time_s, behind, fine)

    def _open(self, column: int, score: float) -> None:
        """A word opens a sentence, whatever was shown before."""
        word = self._idle[column][0]
        if not self._is_better((word,), column, score):
            return
        windows = self.windows
        spoken = (self._spoken(word, column, 0.0, 0.0),)
        state = self._grammar.table.transitions[0][word]
        text = self._text_number((word,))
        self._enter(Reading(spoken, state, 0, windows.start_s, windows.now, text, (word,), 0.0), score)

    def _continue(self, slot: int, reading: Reading, column: int, score: float) -> None:
        """A word goes on with a reading, where the table has it, or replaces the last one that was asked for
        again."""
        transitions = self._grammar.table.transitions
        for word in self._inside[column]:
            is_again = word in reading.asked and self.windows.start_s >= reading.asked_s + REACTION_S
            before = reading.before if is_again else reading.state
            target = transitions[before].get(word)
            if target is None or (not is_again and len(reading.words) >= self._grammar.limits.max_words):
                continue
            fine = 0.0 if is_again else self._fine(reading, word)
            words = (*(reading.words[:-1] if is_again else reading.words), word)
            if not self._is_better(words, column, score - fine):
                continue
            earlier = self.windows.earlier
            behind = float(self._free_row[earlier] - self._best_row[earlier, slot])
            last = reading.spoken[-1]
            kept = replace(last, sure=self.certainty(slot))
            before_it = reading.spoken[:-1] if is_again else (*reading.spoken[:-1], kept)
            spoken = (*before_it, self._spoken(word, column, behind, fine))
            text = self._text_number(words)
            longest = reading.longest if is_again else float(self._longest_row[earlier, slot])
            new = Reading(spoken, target, before, reading.began, self.windows.now, text, words, longest)
            if not is_again:
                self._keep_asking(new, column)
            if is_again and (slot_again := self._slots.get((words, column))) is not None:
                self._drop(slot_again)  # what led to the sign that is replaced must not lead anywhere else
            self._enter(new, score - fine)

    def _fine(self, reading: Reading, word: str) -> float:
        """What a word costs for its place alone."""
        last = reading.words[-1]
        is_joined = self._join is None or not (is_digit(word) and is_digit(last)) or word == last
        return 0.0 if is_joined or any(item.fine for item in reading.spoken) else JOIN_COST

    def _keep_asking(self, reading: Reading, column: int) -> None:
        """What was asked for again stays so where a reading finds a better way to the same words."""
        slot = self._slots.get((reading.words, column))
        other = None if slot is None else self.readings[slot]
        if other is not None:
            reading.asked, reading.asked_s = other.asked, other.asked_s

    def _is_better(self, words: tuple[str, ...], column: int, score: float) -> bool:
        """Whether a reading with this score is worth keeping: it may already be there, with a better one."""
        slot = self._slots.get((words, column))
        return score > self.free - BEAM if slot is None else score > self.best[slot]

    def _text_number(self, words: tuple[str, ...]) -> int:
        """The number of what these words say, digits joined."""
        if len(self._texts) >= MOST_TEXTS:
            self._texts.clear()
            for slot, reading in enumerate(self.readings):
                if reading is not None:
                    text = spell(reading.words, self._join)
                    self._text[slot] = reading.text = self._texts.setdefault(text, len(self._texts))
        return self._texts.setdefault(spell(words, self._join), len(self._texts))

    def _enter(self, reading: Reading, score: float) -> None:
        """Keep a reading whose last word begins to count now."""
        column = reading.spoken[-1].column
        key = reading.words, column
        slot = self._slots.get(key)
        if slot is None:
            slot = self._free_slot(score)
            if slot is None:
                return
            self._slots[key] = slot
            self.gap[slot] = NEVER
            self._best_row[:, slot] = NEVER
        self.readings[slot] = reading
        self._text[slot], self._column[slot] = reading.text, column
        self._touched[slot] = reading.touched
        self.held[slot] = self.best[slot] = score
        self.credit[slot], self.bridged[slot], self.longest[slot] = SHORT_COST, 0.0, reading.longest
        self.sure[slot] = self.windows.weaker[column]

    def _free_slot(self, score: float) -> int | None:
        """A slot for a new reading, at need that of the worst one; None where all are better."""
        slot = int(self.best.argmin())
        if self.readings[slot] is not None:
            if self.best[slot] >= score:
                return None
            self._drop(slot)
        return slot

    def _drop(self, slot: int) -> None:
        reading = self.readings[slot]
        if reading is not None:
            del self._slots[reading.words, int(self._column[slot])]
        self.readings[slot] = None
        self._text[slot] = -1
        self.best[slot] = self.held[slot] = self.gap[slot] = NEVER

    def _prune(self) -> None:
        """Give up what is far behind or has not grown for too long, and find what leads."""
        is_old = self._touched < self.windows.now - self._grammar.dwell.timeout_s
        is_given_up = (self.best < self.free - BEAM) | is_old
        for slot in (is_given_up & (self._text >= 0)).nonzero()[0].tolist():
            self._drop(slot)
        self.lead = int(self.best.argmax()) if self._slots else None

    # What the readings say

    def certainty(self, slot: int) -> float:
        """How well the last sign of a reading was seen: `Spoken.sure` of its last word."""
        return math.exp(self.sure[slot] / self.windows.span)

    def certainties(self, slot: int) -> list[float]:
        """The same of all its words."""
        reading = self.readings[slot]
        return [] if reading is None else [*(item.sure for item in reading.spoken[:-1]), self.certainty(slot)]

    def margin(self, slot: int) -> float:
        """How far the best reading with another text is behind this one, in units of score."""
        others = self.best[(self._text != self._text[slot]) & (self._text >= 0)]
        return float(self.best[slot] - others.max()) if len(others) else -NEVER

    def misfit(self, slot: int) -> tuple[float, int]:
        """How far a reading fell behind the free loop within one word and the gap before it, at most, and which."""
        reading = self.readings[slot]
        if reading is None:
            return 0.0, 0
        marks = [*(item.behind for item in reading.spoken), self.behind(slot)]
        steps = [
            after - before - item.fine
            for (before, after), item in zip(pairwise(marks), reading.spoken, strict=True)
        ]
        worst = max(range(len(steps)), key=steps.__getitem__)
        return steps[worst], worst

    def is_over(self, slot: int) -> bool:
        """Whether the last sign of a reading has gone."""
        return bool(self.gap[slot] > self.held[slot])

    def behind(self, slot: int) -> float:
        """How far a reading is behind the free loop, in units of score, without what its last word is still owed."""
        return float(self.free - self.best[slot] - self.credit[slot])

    def near(self, slot: int, margin: float) -> Iterator[Reading]:
        """The readings that are at most `margin` behind this one, it included."""
        for other in np.flatnonzero(self.best >= self.best[slot] - margin).tolist():
            reading = self.readings[other]
            if reading is not None:
                yield reading

    def summaries(self, most: int) -> tuple[Summary, ...]:
        """The best readings, the best first."""
        found = []
        for slot in np.argsort(-self.best)[:most].tolist():
            reading = self.readings[slot]
            if reading is not None:
                misfit, place = self.misfit(slot)
                found.append(
                    Summary(
                        words=tuple(zip(reading.words, self.certainties(slot), strict=True)),
                        behind=self.behind(slot),
                        longest_s=float(self.longest[slot]),
                        misfit=misfit,
                        misfit_at=reading.words[place],
                    )
                )
        return tuple(found)

    def rival(self, slot: int) -> str:
        """The text of the best reading with another text than this one; empty where there is none."""
        others = np.where(self._text != self._text[slot], self.best, 2 * NEVER)
        reading = self.readings[int(others.argmax())]
        return "" if reading is None else spell(reading.words, self._join)

    def has_prefix(self, words: tuple[str, ...]) -> bool:
        """Whether some reading begins with these words."""
        count = len(words)
        lead = None if self.lead is None else self.readings[self.lead]
        if lead is not None and lead.words[:count] == words:
            return True
        return any(reading is not None and reading.words[:count] == words for reading in self.readings)

    def ask(self, count: int, words: frozenset[str]) -> None:
        """In readings of so many words, one of `words` replaces the last one when it is shown again."""
        for reading in self.readings:
            if reading is not None and len(reading.spoken) == count and reading.words[-1] in words:
                reading.asked, reading.asked_s = words, self.windows.now

    def hold(self, column: int, confidence: float) -> Hold:
        """A sign that was shown over the window."""
        frame, time_s = self.windows.start_stamp
        return Hold(
            pair=self.scores.shown(column),
            frames=1,
            confidence=confidence,
            first_frame=frame,
            first_time_s=time_s,
        )
