"""The rule "sentence": the best reading of the whole sentence is issued, or, where it is in doubt, nothing.

Searching is `search`; here it is decided what the diver is told of it, and when a sentence is sure enough. A sentence
is issued as soon as its end word was shown for the least length, if all of these hold, each bound made stricter by
`caution`:

- the best reading with another text is clearly behind ("ambiguous"),
- every word was seen well for once ("weak_sign"),
- every number was shown steadily ("weak_sign"),
- no longer time than a passage lies between two signs with both hands in view ("passed_over"),
- no part of it is explained much better by signs that make no sentence ("does_not_fit").
"""

import math
from typing import Final

from lightgesture.fsm.language.forms import is_digit, spell
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.language.settings import SentenceSettings
from lightgesture.fsm.reader import CONFIRMING, Reader
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules.display import Display
from lightgesture.fsm.rules.doubts import MARGIN, MISFIT, Doubt, find_doubt, is_weak
from lightgesture.fsm.rules.readings import Reading, Summary
from lightgesture.fsm.rules.search import Search
from lightgesture.fsm.rules.steady import STEADY, SteadySign
from lightgesture.fsm.rules.telling import Telling, common
from lightgesture.fsm.rules.windows import Floats
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
        self._telling = Telling(grammar, settings.caution, self.search, reader, reporter)
        self._display = Display(self.search, reader, reporter)
        control = grammar.control
        self._control = {word for word in (control.kill, control.cancel) if word is not None}
        self._reset()

    def _reset(self) -> None:
        """As at the start of a stream."""
        self._judged: tuple[Summary, ...] = ()
        self._is_waiting, self._paused_s = False, 0.0
        self._steady.reset()
        self._telling.reset()
        self._display.reset()

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
        self._display.follow(scores, step_s)
        self._wait_for_pause(scores, passed_s)
        if not self._heed_steady_sign(scores, step_s):
            self._heed_readings(now_s)
        self._display.show_growth(self._telling.told, now_s)

    def _close(self) -> None:
        """The sentence is over; what is still shown is no part of the next one."""
        self._judged = self.search.standing.summaries(SUMMARIES)
        self.search.clear()
        self._telling.told = ()
        self._steady.spend_shown()

    def _wait_for_pause(self, scores: Floats, passed_s: float) -> None:
        """A diver who does not look signs on after a rejection: what follows is no new sentence before a pause."""
        if self._is_waiting:
            is_shown = scores[self._display.top] > 2 * math.log(STEADY)
            self._paused_s = 0.0 if is_shown else self._paused_s + passed_s
            self._is_waiting = self._paused_s < PAUSE_S
        # What means something else inside a sentence opens none while one is open.
        self.search.is_wary = self._is_waiting or (bool(self._telling.told) and self._telling.is_sure)

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
        is_idle = self._reader.sentence is None and (
            lead is None or self.search.standing.behind(lead) > MISFIT
        )
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
        search, telling = self.search, self._telling
        if self._reader.state == CONFIRMING:
            return
        lead = search.lead
        reading = None if lead is None else search.beam.readings[lead]
        if telling.told and not search.standing.has_prefix(telling.told):
            detail = f"what came after {telling.text} makes no sentence; sign it again"
            self._reject(Doubt(reason="does_not_fit", detail=detail))
            return
        if lead is None or reading is None:
            return
        told = telling.told
        doubt = telling.tell(lead, reading, now_s)
        if doubt is not None:
            self._reject(doubt)
            return
        if telling.told != told:
            self._display.show(telling.told)
        most = self._grammar.limits.max_words
        if len(reading.spoken) >= most and search.standing.is_over(lead):
            self._reject(Doubt(reason="limit", detail=f"a sentence has at most {most} words"))
        elif reading.state in self._grammar.table.accepting:
            self._judge(lead, reading, now_s)
        elif search.standing.is_over(lead) and not reading.asked:
            self._ask_again(lead, reading)

    def _ask_again(self, lead: int, reading: Reading) -> None:
        """A sign that was seen too badly to be issued with may be shown once more in place of itself."""
        standing = self.search.standing
        count = len(reading.words)
        if not is_weak(reading.words[-1], standing.certainty(lead), self._caution, opens=count == 1):
            return
        words = {near.words[-1] for near in standing.near(lead, MARGIN) if len(near.words) == count}
        self.search.beam.ask(count, frozenset(words))
        if self._telling.told:
            detail = f"{' or '.join(sorted(words))} was not seen well; show it again"
            self._reporter.notice("repeat", detail)

    def _judge(self, lead: int, reading: Reading, now_s: float) -> None:
        """A complete sentence: issue it, wait a little for a doubt to pass, or reject it."""
        search, telling = self.search, self._telling
        is_over = search.standing.is_over(lead)
        waited = search.windows.now - reading.touched
        if waited < SETTLE_S and not is_over:
            return
        if telling.is_another(reading):
            doubt: Doubt | None = telling.inside(reading.words[0])
        else:
            doubt = find_doubt(search, lead, reading, self._caution)
        if doubt is None:
            self._issue(lead, reading, now_s)
        elif waited > PATIENCE_S and (is_over or waited > 2 * PATIENCE_S + search.hold_s):
            self._reject(doubt, reading)

    def _issue(self, lead: int, reading: Reading, now_s: float) -> None:
        """A complete sentence that is beyond doubt."""
        telling, words = self._telling, reading.words
        certainties = self.search.standing.certainties(lead)
        sentence = telling.open(reading, words, certainties, now_s)
        kept = min(common(words, telling.told), len(words) - 1)
        telling.tell_words(reading, words[:-1], kept, certainties)
        if self._grammar.limits.max_digits < _most_digits(words, self._grammar.vocabulary.join):
            most = self._grammar.limits.max_digits
            self._reject(Doubt(reason="limit", detail=f"a number has at most {most} digits"))
            return
        form = self._grammar.table.accepting[reading.state]
        self._reader.conclude(
            telling.hold(reading, len(words) - 1, certainties[-1]), words[-1], form, sentence
        )
        self._close()

    def _reject(self, doubt: Doubt, reading: Reading | None = None) -> None:
        """Nothing is issued of what was told, or of this reading."""
        words = self._telling.told if reading is None else reading.words
        if words:
            text = spell(words, self._grammar.vocabulary.join)
            self._reader.drop(doubt.reason, doubt.detail, text)
            self._is_waiting, self._paused_s = words[-1] != self._grammar.end, 0.0
        self._close()


def _most_digits(words: tuple[str, ...], join: str | None) -> int:
    """Most digits of a number among the words of a sentence, as they were signed: joined or not, leading zeros too."""
    most = count = 0
    for word in words:
        if is_digit(word):
            count += 1
            most = max(most, count)
        elif word != join:
            count = 0
    return most
