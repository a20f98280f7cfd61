"""Many readings of one sentence at once: token passing through the grammar's table.

A reading is the words so far and the sign of the last one. In every frame it is either in that sign or in the gap
after it, and its score is that of the best way to cut the frames into signs and gaps (Young, Russell and Thornton,
"Token passing: a simple conceptual model for connected speech recognition systems", Cambridge 1989). A sign lasts
`hold_s` at least, so that a word enters with the scores of that long a window at once. Beside them runs the free
loop; how far a reading stays behind it tells whether it fits what was shown (utterance verification, as Rose and Paul,
ICASSP 1990).
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from lightgesture.fsm.language.forms import is_digit, is_number
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.rules.beam import BEAM, SHORT_COST, Beam
from lightgesture.fsm.rules.clarity import Clarity
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.rules.loop import COST, FreeLoop
from lightgesture.fsm.rules.readings import Reading, Spoken
from lightgesture.fsm.rules.scores import GAP_SCORE, RATE, SignScores
from lightgesture.fsm.rules.standing import Standing
from lightgesture.fsm.rules.windows import Floats, Windows
from lightgesture.fsm.signs import Signs

JOIN_COST: Final = 3.0
"""What a digit costs besides that follows another one without the joining word, once a sentence: hands that leave a
digit pass through others. Nothing where the language has no joining word."""

REACTION_S: Final = 0.5
"""Seconds that it takes at least to see that a sign is asked for again and to begin it: what comes sooner is the next
word, of a diver who did not look."""

LIKELY: Final = 0.06
"""Geometric mean probability of a sign over the least length, 0 to 1, below which no word begins with it: more than
that of hands that are not in view."""


class Search:
    """The search for the readings of one stream: the windows, the free loop, the beam and how its readings stand, and
    what was clear.

    is_wary: whether signs that mean something else inside a sentence may open none. spent: a sign that may not, because
    it is still held from what was read before.
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
        self._numbers = [
            column for column, words in sorted(self._inside.items()) if any(map(is_number, words))
        ]
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
        self.loop = FreeLoop(self.scores.size)
        self.clarity = Clarity(self._numbers)
        self.beam = Beam(self._join, self.windows, self.loop)
        self.standing = Standing(self._join, self.beam, self.windows, self.loop)
        self.is_wary = False
        self.spent: int | None = None
        self._cleared = self.windows.now

    def clear(self) -> None:
        """Give up all readings; what is shown now opens a sentence only if it goes on for the least length."""
        self.beam.clear()
        self._cleared = self.windows.now

    @property
    def lead(self) -> int | None:
        """The slot of the best reading; None: there is none."""
        return self.beam.lead

    def step(self, signs: Signs, passed_s: float, in_view_s: float, frame: int, time_s: float) -> Floats:
        """Take in a frame, which stands for `passed_s` seconds; its scores. in_view_s: of them, those that count as
        passed over where nothing is read."""
        scores, of_left = self.scores.of(signs)
        weight = passed_s * RATE
        add, gap_add = scores * weight, GAP_SCORE * weight
        windows, beam = self.windows, self.beam
        self.clarity.step(scores, passed_s, in_view_s)
        windows.step(add, of_left * weight, gap_add, passed_s, (frame, time_s))
        self.loop.step(add, gap_add, windows)
        beam.step(add, gap_add, passed_s, in_view_s)
        if windows.window is not None:
            if windows.start_s >= self._cleared:
                self._open_all(windows.window)
            if beam.slots and windows.has_passage:
                self._continue_all(windows.window)
        beam.prune(self._grammar.dwell.timeout_s)
        return scores

    def _open_all(self, window: Floats) -> None:
        """Signs that were likely for the least length open sentences."""
        gains = window[self._idle_columns]
        for place in (gains > self._least).nonzero()[0].tolist():
            column = int(self._idle_columns[place])
            if column != self.spent and not (self.is_wary and column in self._inside):
                score = self.windows.passed(self.loop.row) + gains[place] - COST - SHORT_COST
                self._open(column, float(score))

    def _continue_all(self, window: Floats) -> None:
        """Signs that were likely for the least length become words of the readings that they fit."""
        windows, beam = self.windows, self.beam
        entered = windows.passed(beam.best_row) - (COST + SHORT_COST)
        floor = self.loop.score - BEAM
        gains = window[self._inside_columns]
        likely = (gains > max(self._least, floor - float(entered.max()))).nonzero()[0]
        if not len(likely):
            return
        scores = gains[likely, None] + entered
        for place, slot in zip(*map(list, (scores > floor).nonzero()), strict=True):
            reading = beam.readings[slot]
            column = int(self._inside_columns[likely[place]])
            if reading is not None and (beam.column[slot] != column or windows.is_released(column)):
                self._continue(slot, reading, column, float(scores[place, slot]))

    def _spoken(
        self, word: str, column: int, behind: float, fine: float, *, is_again: bool = False
    ) -> Spoken:
        """A word whose sign begins with the window."""
        windows = self.windows
        seen = self.clarity.seen - windows.hold_s
        return Spoken(word, column, *windows.start_stamp, behind, fine, windows.start_s, seen, is_again)

    def _open(self, column: int, score: float) -> None:
        """A word opens a sentence, whatever was shown before."""
        word = self._idle[column][0]
        if not self.beam.is_better((word,), column, score):
            return
        windows = self.windows
        spoken = (self._spoken(word, column, 0.0, 0.0),)
        state = self._grammar.table.transitions[0][word]
        text = self.beam.text_number((word,))
        self.beam.enter(Reading(spoken, state, 0, windows.start_s, windows.now, text, (word,), 0.0), score)

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
            if not self.beam.is_better(words, column, score - fine):
                continue
            new = self._grown(slot, reading, words, column, target, fine, is_again)
            slot_again = self.beam.slots.get((words, column))
            if is_again and slot_again is not None:
                self.beam.drop(
                    slot_again
                )  # what led to the sign that is replaced must not lead anywhere else
            self.beam.enter(new, score - fine)

    def _grown(
        self,
        slot: int,
        reading: Reading,
        words: tuple[str, ...],
        column: int,
        target: int,
        fine: float,
        is_again: bool,
    ) -> Reading:
        """A reading with one word more, or with another last one."""
        beam, windows = self.beam, self.windows
        earlier = windows.earlier
        behind = float(self.loop.row[earlier] - beam.best_row[earlier, slot])
        kept = replace(reading.spoken[-1], sure=self.standing.certainty(slot))
        before = reading.spoken[:-1] if is_again else (*reading.spoken[:-1], kept)
        new = Reading(
            spoken=(*before, self._spoken(words[-1], column, behind, fine, is_again=is_again)),
            state=target,
            before=reading.before if is_again else reading.state,
            began=reading.began,
            touched=windows.now,
            text=beam.text_number(words),
            words=words,
            longest=reading.longest if is_again else float(beam.longest_row[earlier, slot]),
        )
        if not is_again:
            self._keep_asking(new, column)
        return new

    def _fine(self, reading: Reading, word: str) -> float:
        """What a word costs for its place alone."""
        last = reading.words[-1]
        is_joined = self._join is None or not (is_digit(word) and is_digit(last)) or word == last
        return 0.0 if is_joined or any(item.fine for item in reading.spoken) else JOIN_COST

    def _keep_asking(self, reading: Reading, column: int) -> None:
        """What was asked for again stays so where a reading finds a better way to the same words."""
        slot = self.beam.slots.get((reading.words, column))
        other = None if slot is None else self.beam.readings[slot]
        if other is not None:
            reading.asked, reading.asked_s = other.asked, other.asked_s

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
