"""The rule "sentence": the best reading of the whole sentence is issued, or, where it is in doubt, nothing.

Searching is `search`; here it is decided what the diver is told of it, and when a sentence is sure enough. A sentence
is issued as soon as its end word was shown for the least length, if all of these hold, each bound made stricter by
`caution`:

- the best reading with another text is clearly behind ("ambiguous"),
- every word was seen well for once ("weak_sign"),
- no longer time than a passage lies between two signs with both hands in view ("passed_over"),
- no part of it is explained much better by signs that make no sentence ("does_not_fit").
"""

import math
from typing import Final

from lightgesture.fsm.events import Certainty, Growth
from lightgesture.fsm.language.forms import spell
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.language.settings import SentenceSettings
from lightgesture.fsm.reader import CONFIRMING, Reader
from lightgesture.fsm.reporter import DECIMALS, DISPLAY_INTERVAL_S, Reporter, Timeline
from lightgesture.fsm.rules.doubts import MARGIN, MISFIT, Doubt, find_doubt, is_weak
from lightgesture.fsm.rules.dwell import Hold
from lightgesture.fsm.rules.readings import Reading, Summary
from lightgesture.fsm.rules.search import Search
from lightgesture.fsm.rules.steady import STEADY, SteadySign
from lightgesture.fsm.rules.windows import Floats
from lightgesture.fsm.sentence import Sentence
from lightgesture.fsm.signs import Signs

LONGEST_STEP_S: Final = 0.25
"""Longest time between two frames, seconds: no sign goes on across more, for of what was not looked at nothing is
known."""

SETTLE_S: Final = 0.1
"""How long an end word is looked at beyond its least length, seconds: the window over which it adds up is then its
own."""

PATIENCE_S: Final = 0.6
"""How long a complete sentence in doubt may stand after its end word before it is rejected, seconds."""

PAUSE_S: Final = 1.5
"""Seconds without a sign after which a sentence that was dropped on the way is over for the diver too."""

SUMMARIES: Final = 5
"""Readings of a sentence that are kept for those who ask why."""


class SentenceRule:
    """Reads one stream; see the module."""

    def __init__(
        self,
        grammar: Grammar,
        settings: SentenceSettings,
        reader: Reader,
        reporter: Reporter,
        timeline: Timeline,
    ) -> None:
        self._grammar, self._timeline = grammar, timeline
        self._reader, self._reporter = reader, reporter
        self._caution = settings.caution
        self.search = Search(grammar, settings.hold_seconds)
        self._steady = SteadySign(self.search)
        control = grammar.control
        self._control = {word for word in (control.kill, control.cancel) if word is not None}
        self._reset()

    def _reset(self) -> None:
        """As at the start of a stream."""
        self._told: tuple[str, ...] = ()
        self._judged: tuple[Summary, ...] = ()
        self._told_s = 0.0
        self._is_told_sure = self._is_waiting = False
        self._paused_s = 0.0
        self._steady.reset()
        self._top, self._top_s = -1, 0.0

    def interrupt(self) -> None:
        """Frames are missing: no reading spans them."""
        self.search.reset()
        self._reset()

    def finish(self) -> None:
        """The end of the stream."""
        self.search.reset()
        self._reset()

    def readings(self) -> tuple[Summary, ...]:
        """The best readings of the last sentence when it was judged."""
        return self._judged

    # One frame

    def process(self, signs: Signs, now_s: float, passed_s: float) -> None:
        """Take in one frame; passed_s: seconds since the one before it."""
        reader, search = self._reader, self.search
        sentence = reader.sentence
        if sentence is not None and now_s - sentence.touched_s >= self._grammar.dwell.timeout_s:
            reader.drop("timeout", f"no word for {self._grammar.dwell.timeout_s:g} s")
            self._close()
        in_view = signs.left.seen and signs.right.seen
        is_counted = in_view or signs.left.is_word or signs.right.is_word or self._grammar.dwell.count_hidden
        step_s = passed_s
        if passed_s > LONGEST_STEP_S:
            search.windows.break_off()
            step_s = 0.0
        stamp = self._reporter.frame, self._timeline.time_s
        scores = search.step(signs, step_s, passed_s if is_counted else 0.0, *stamp)
        self._follow_top(scores, step_s)
        self._wait_for_pause(scores, passed_s)
        if not self._heed_steady_sign(scores, step_s):
            self._heed_readings(now_s)
        is_growing = self._top >= 0 and self._top_s > 0.0
        if (is_growing or self._reporter.is_growth_shown) and (
            now_s - self._reporter.shown_s >= DISPLAY_INTERVAL_S
        ):
            self._show()

    def _close(self) -> None:
        """The sentence is over; what is still shown is no part of the next one."""
        self._judged = self.search.summaries(SUMMARIES)
        self.search.clear()
        self._told = ()
        self._steady.spend_shown()

    def _wait_for_pause(self, scores: Floats, passed_s: float) -> None:
        """A diver who does not look signs on after a rejection: what follows is no new sentence before a pause."""
        if self._is_waiting:
            self._paused_s = 0.0 if scores[self._top] > 2 * math.log(STEADY) else self._paused_s + passed_s
            self._is_waiting = self._paused_s < PAUSE_S
        # What means something else inside a sentence opens none while one is open.
        self.search.is_wary = self._is_waiting or (bool(self._told) and self._is_told_sure)

    # Signs that count by themselves

    def _heed_steady_sign(self, scores: Floats, step_s: float) -> bool:
        """Words of control, the second end word, and words that open nothing; whether there was one."""
        column = self._steady.process(scores, step_s)
        if column is None:
            return False
        reader, search = self._reader, self.search
        likelihood = search.windows.likelihood(column)
        word = reader.word_of(search.scores.shown(column))
        if word not in self._control:
            if likelihood < STEADY:
                return False
            if reader.state != CONFIRMING:
                return self._note(column, word)
        self._steady.spend(column)
        if word == self._grammar.control.cancel and reader.sentence is None:
            return False
        reader.read(search.hold(column, likelihood))
        if reader.sentence is None:
            self._close()
        return True

    def _note(self, column: int, word: str | None) -> bool:
        """A word that opens no sentence while none is open: the diver is told so, once."""
        lead = self.search.lead
        is_idle = self._reader.sentence is None and (lead is None or self.search.behind(lead) > MISFIT)
        if not is_idle or word is None or word in self._grammar.table.transitions[0]:
            return False
        self._steady.spend(column)
        if word == self._grammar.end:
            self._is_waiting = False
        self._reader.read(self.search.hold(column, self.search.windows.likelihood(column)))
        return True

    # The sentence

    def _heed_readings(self, now_s: float) -> None:
        """Tell what the leading reading has become, and conclude it when it is complete."""
        search, reader = self.search, self._reader
        if reader.state == CONFIRMING:
            return
        lead = search.lead
        reading = None if lead is None else search.readings[lead]
        if self._told and not search.has_prefix(self._told):
            self._reject(self._misfit())
            return
        if lead is None or reading is None:
            return
        self._tell(lead, reading, now_s)
        if search.lead is None:
            return
        if len(reading.spoken) >= self._grammar.limits.max_words and search.is_over(lead):
            self._reject(
                Doubt(reason="limit", detail=f"a sentence has at most {self._grammar.limits.max_words} words")
            )
        elif reading.state in self._grammar.table.accepting:
            self._judge(lead, reading, now_s)
        elif search.is_over(lead) and not reading.asked and len(reading.spoken) > 1:
            self._ask_again(lead, reading)

    def _tell(self, lead: int, reading: Reading, now_s: float) -> None:
        """Words on which all near readings agree are told, once each."""
        words = reading.words
        if words == self._told:
            self._is_told_sure = self._is_told_sure or self.search.certainty(lead) > STEADY
            return
        if self.search.behind(lead) > MISFIT / self._caution:
            return
        agreed = words
        for other in self.search.near(lead, MARGIN):
            agreed = agreed[: _common(agreed, other.words)]
        if reading.state in self._grammar.table.accepting:
            agreed = agreed[: len(words) - 1]  # the end word comes with the verdict
        kept = _common(agreed, self._told)
        if agreed and self._is_another(reading):
            if len(self._told) == 1:
                self._reject(self._inside(agreed[0]))
            return
        if len(agreed) <= kept or (kept == 0 and len(self._told) > 1):
            return
        certainties = self.search.certainties(lead)
        if is_weak(words[0], certainties[0], self._caution):
            return
        self._open(reading, agreed, certainties, now_s)
        for place in range(kept, len(agreed)):
            text = spell(agreed[: place + 1], self._grammar.vocabulary.join)
            self._reporter.word(self._hold(reading, place, certainties[place]), agreed[place], text)
        self._told, self._told_s = agreed, self.search.windows.now
        self._is_told_sure = certainties[0] > STEADY or len(agreed) > 1
        self._show()

    def _open(
        self, reading: Reading, words: tuple[str, ...], certainties: list[float], now_s: float
    ) -> Sentence:
        """The sentence of the first words of a reading is the open one."""
        sentence = self._reader.begin(self._hold(reading, 0, certainties[0]), words[0])
        transitions, state = self._grammar.table.transitions, 0
        for place, word in enumerate(words):
            state = transitions[state][word]
            hold = self._hold(reading, place, certainties[place])
            sentence.add(word, hold, state, now_s, self._grammar.vocabulary.join)
        return sentence

    def _hold(self, reading: Reading, place: int, certainty: float) -> Hold:
        spoken = reading.spoken[place]
        return Hold(
            pair=self.search.scores.shown(spoken.column),
            frames=1,
            confidence=certainty,
            first_frame=spoken.frame,
            first_time_s=spoken.time_s,
        )

    def _ask_again(self, lead: int, reading: Reading) -> None:
        """A sign that was seen too badly to be issued with may be shown once more in place of itself."""
        if not is_weak(reading.words[-1], self.search.certainty(lead), self._caution):
            return
        words = {
            near.words[-1] for near in self.search.near(lead, MARGIN) if len(near.words) == len(reading.words)
        }
        self.search.ask(len(reading.words), frozenset(words))
        if self._told:
            detail = f"{' or '.join(sorted(words))} was not seen well; show it again"
            self._reporter.notice("repeat", detail)

    def _judge(self, lead: int, reading: Reading, now_s: float) -> None:
        """A complete sentence: issue it, wait a little for a doubt to pass, or reject it."""
        search = self.search
        waited = search.windows.now - reading.touched
        if waited < SETTLE_S and not search.is_over(lead):
            return
        if self._is_another(reading):
            doubt: Doubt | None = self._inside(reading.words[0])
        else:
            doubt = find_doubt(search, lead, reading, self._caution)
        if doubt is not None:
            if waited > PATIENCE_S and (search.is_over(lead) or waited > 2 * PATIENCE_S + search.hold_s):
                self._reject(doubt, reading)
            return
        certainties = search.certainties(lead)
        words = reading.words
        form = self._grammar.table.accepting[reading.state]
        sentence = self._open(reading, words, certainties, now_s)
        kept = min(_common(words, self._told), len(words) - 1)
        for place in range(kept, len(words) - 1):
            text = spell(words[: place + 1], self._grammar.vocabulary.join)
            self._reporter.word(self._hold(reading, place, certainties[place]), words[place], text)
        if self._grammar.limits.max_digits < _longest_number(words):
            self._reject(
                Doubt(reason="limit", detail=f"a number has at most {self._grammar.limits.max_digits} digits")
            )
            return
        self._reader.conclude(self._hold(reading, len(words) - 1, certainties[-1]), words[-1], form, sentence)
        self._close()

    # Doubts

    def _is_another(self, reading: Reading) -> bool:
        """Whether a reading is of a sentence that began after the one that was told, which is not over."""
        return bool(self._told) and self._is_told_sure and reading.began > self._told_s

    def _inside(self, word: str) -> Doubt:
        """A start word came in mid-sentence."""
        told = spell(self._told, self._grammar.vocabulary.join)
        return Doubt(
            reason="out_of_order", detail=f"{word} cannot follow {told}; expected {self._reader.expected}"
        )

    def _misfit(self) -> Doubt:
        """What was told does not go on as any sentence would."""
        told = spell(self._told, self._grammar.vocabulary.join)
        return Doubt(reason="does_not_fit", detail=f"what came after {told} makes no sentence; sign it again")

    def _reject(self, doubt: Doubt, reading: Reading | None = None) -> None:
        """Nothing is issued of what was told, or of this reading."""
        words = self._told if reading is None else reading.words
        if words:
            text = spell(words, self._grammar.vocabulary.join)
            self._reader.drop(doubt.reason, doubt.detail, text)
            self._is_waiting, self._paused_s = words[-1] != self._grammar.end, 0.0
        self._close()

    # Displays

    def _follow_top(self, scores: Floats, step_s: float) -> None:
        """Which sign is the likeliest now, and for how long it has been, for displays."""
        top = int(scores.argmax())
        if top == self._top and scores[top] > -2.0:
            self._top_s += step_s
        else:
            self._top, self._top_s = top, 0.0

    def _show(self) -> None:
        """A display follows the sign that is growing, the best reading and how sure it is."""
        growth = certainty = None
        search, reader = self.search, self._reader
        progress = self._top_s / search.hold_s
        if 0.0 < progress < 1.0:
            shown = search.scores.shown(self._top)
            growth = Growth(pair=shown, word=reader.word_of(shown), progress=round(progress, DECIMALS))
        elif not self._reporter.is_growth_shown and not self._told:
            return
        lead = search.lead
        reading = None if lead is None else search.readings[lead]
        if self._told and lead is not None and reading is not None:
            sure = [round(value, DECIMALS) for value in search.certainties(lead)]
            words = tuple(zip(reading.words, sure, strict=True))
            certainty = Certainty(words=words, expected=reader.expected)
        reader.show(growth, certainty)


def _common(one: tuple[str, ...], other: tuple[str, ...]) -> int:
    """Length of the beginning that two sequences share."""
    for place, (left, right) in enumerate(zip(one, other, strict=False)):
        if left != right:
            return place
    return min(len(one), len(other))


def _longest_number(words: tuple[str, ...]) -> int:
    """Most digits of a number among the words of a sentence."""
    return max((len(part) for part in spell(words, None).split() if part.isdigit()), default=0)
