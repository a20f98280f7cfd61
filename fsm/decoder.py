"""Pairs, one a frame, become words, and words become instructions."""

import math

from lightgesture.fsm.dwell import Hold, make_dwell
from lightgesture.fsm.events import Event, Growth, Pair
from lightgesture.fsm.forms import MENU, Form, Item, spell
from lightgesture.fsm.grammar import Grammar
from lightgesture.fsm.reporter import DECIMALS, DISPLAY_INTERVAL_S, Reporter
from lightgesture.fsm.sentence import Sentence, name_expected, needs_confirmation, objection
from lightgesture.fsm.table import Arguments, bind
from lightgesture.fsm.timeline import Timeline
from lightgesture.fsm.unread import UnreadSigning

IDLE = "idle"
COLLECTING = "collecting"
CONFIRMING = "confirming"


class Decoder:
    """Reads one pair of tokens a frame; what it makes of them are events.

    An instruction is issued only for a sentence that the grammar's table accepts from its start word to
    its end word. A held pair that is no word is reported and the sentence kept; a word that has no place
    rejects the sentence; a sentence without a new word for `timeout_s` is dropped, and so is one in which hands were
    seen for too long without saying a word, because a sign of it may have been missed.

    hold: consecutive frames that make a word, at least 1. hold_seconds: seconds instead, above 0; the evidence that a
    word needs where the grammar goes by evidence. Both None: the grammar's own. source: name of the input in the
    events. ValueError: a hold out of range, or both.
    """

    __slots__ = ("_dwell", "_grammar", "_reporter", "_sentence", "_timeline", "_unread")

    def __init__(
        self,
        grammar: Grammar,
        *,
        hold: int | None = None,
        hold_seconds: float | None = None,
        source: str | None = None,
    ) -> None:
        self._grammar = grammar
        self._dwell = make_dwell(grammar.dwell, hold, hold_seconds)
        self._unread = UnreadSigning(
            grammar.dwell.unread * self._dwell.need, self._dwell.release, grammar.dwell.passage_s
        )
        self._timeline = Timeline()
        self._reporter = Reporter(source)
        self._sentence: Sentence | None = None

    @property
    def hold_frames(self) -> int | None:
        """Frames that make a word; None where a word is a matter of time."""
        return None if self._dwell.timed else int(self._dwell.need)

    @property
    def hold_seconds(self) -> float | None:
        """Seconds, of time or of evidence, that make a word; None where it is a matter of frames."""
        return self._dwell.need if self._dwell.timed else None

    @property
    def state(self) -> str:
        """ "idle", "collecting", or "confirming" while a complete sentence waits for its second end word."""
        if self._sentence is None:
            return IDLE
        return COLLECTING if self._sentence.complete is None else CONFIRMING

    @property
    def sentence(self) -> str:
        """The open sentence so far, digits joined; empty while idle."""
        return "" if self._sentence is None else self._sentence.text

    @property
    def expected(self) -> str:
        """What may follow, for the diver: "GO or a digit"."""
        if self._sentence is None:
            return name_expected(self._grammar.table.transitions[0])
        if self._sentence.complete is not None:
            return self._grammar.end
        return name_expected(self._grammar.table.transitions[self._sentence.state])

    def step(
        self,
        left: str | None,
        right: str | None,
        time_s: float,
        left_confidence: float = 1.0,
        right_confidence: float = 1.0,
        frame: int | None = None,
        left_seen: bool | None = None,
        right_seen: bool | None = None,
    ) -> list[Event]:
        """Take in one frame: the tokens of the diver's hands (None: no token) and the time stamp, seconds.

        Confidences: 0 to 1; the lower of the two is the pair's. frame: 0-based index; None: one more
        than the last. left_seen, right_seen: whether the hand is in view, read or not; None: where it has a
        token. Stamps that stand still, run back or are not finite are endured: no time passes.
        """
        reporter, dwell = self._reporter, self._dwell
        events: list[Event] = []
        reporter.events = events
        reporter.frame = reporter.frame + 1 if frame is None else frame
        if math.isfinite(time_s):
            reporter.time_s = time_s
        before_s = self._timeline.now_s
        now_s = self._timeline.advance(reporter.time_s)
        timeout_s = self._grammar.dwell.timeout_s
        if self._sentence is not None and now_s - self._sentence.touched_s >= timeout_s:
            # A sign half held must not live on: outside the sentence it may mean something else.
            dwell.discard()
            self._drop("timeout", self.sentence, f"no word for {timeout_s:g} s")
        confidence = left_confidence if left_confidence < right_confidence else right_confidence
        pair = None if left is None or right is None else (left, right)
        hold = dwell.process(pair, confidence, reporter.frame, reporter.time_s, now_s)
        if hold is not None:
            self._read(hold)
        elif self._sentence is not None and (pair is None or pair != dwell.spent):
            is_left = left is not None if left_seen is None else left_seen
            is_right = right is not None if right_seen is None else right_seen
            if (is_left or is_right) and self._unread.process(pair, dwell.step, now_s - before_s):
                self._miss()
        is_worth_showing = dwell.pair is not None or reporter.is_growth_shown
        if is_worth_showing and now_s - reporter.shown_s >= DISPLAY_INTERVAL_S:
            self._show_growth()
        return events

    def finish(self) -> list[Event]:
        """The end of the stream: an open sentence is dropped as "cancelled"; the decoder is idle again."""
        self._reporter.events = []
        self._dwell.reset()
        if self._sentence is not None:
            self._drop("cancelled", self.sentence, "the input ended inside the sentence")
        return self._reporter.events

    def _read(self, hold: Hold) -> None:
        """A pair was held long enough."""
        word = self._meaning(hold.pair)
        sentence, control = self._sentence, self._grammar.control
        if word is None:
            self._report_unknown(hold.pair)
        elif word == control.kill:
            self._kill(hold, word)
        elif sentence is None:
            self._open(hold, word)
        elif word == control.cancel:
            self._drop("cancelled", self.sentence, f"{word} was signed")
        elif sentence.complete is not None:
            self._confirm(hold, word, sentence, sentence.complete)
        else:
            self._continue(hold, word, sentence)

    def _meaning(self, pair: Pair) -> str | None:
        if self._sentence is None:
            return self._grammar.idle_words.get(pair)
        is_menu = self._sentence.words[0] == MENU
        return (self._grammar.menu_words if is_menu else self._grammar.sentence_words).get(pair)

    def _report_unknown(self, pair: Pair) -> None:
        self._unread.pass_over()
        if self._sentence is not None:
            self._sentence.has_unknown = True
        inside = self._sentence is not None and pair in self._grammar.idle_words
        place = "no word inside a sentence" if inside else "no word"
        self._reporter.notice("unknown_pair", f"{pair[0]},{pair[1]} is {place}; repeat it")

    def _open(self, hold: Hold, word: str) -> None:
        """A word while no sentence is open."""
        row = self._grammar.table.transitions[0]
        if word in row:
            self._accept(hold, word, row[word], self._begin(hold))
        else:
            detail = f"{word} opens no sentence; expected {self.expected}"
            self._reporter.notice("out_of_order", detail)

    def _begin(self, hold: Hold) -> Sentence:
        self._sentence = Sentence(
            start_frame=hold.first_frame, start_time_s=hold.first_time_s, touched_s=self._timeline.now_s
        )
        return self._sentence

    def _continue(self, hold: Hold, word: str, sentence: Sentence) -> None:
        """A word inside a sentence: it has its place, or rejects the sentence."""
        row = self._grammar.table.transitions[sentence.state]
        if word in row:
            self._accept(hold, word, row[word], sentence)
        else:
            detail = f"{word} cannot follow {self.sentence}; expected {self.expected}"
            text = spell([*sentence.words, word], self._grammar.vocabulary.join)
            self._drop("out_of_order", text, detail)

    def _accept(self, hold: Hold, word: str, target: int, sentence: Sentence) -> None:
        """A word has its place: the sentence goes on or is complete."""
        self._unread.reset()
        sentence.add(word, hold, target, self._timeline.now_s, self._grammar.vocabulary.join)
        form = self._grammar.table.accepting.get(target)
        limits = self._grammar.limits
        if form is not None:
            self._complete(hold, word, form, sentence)
            return
        self._reporter.word(hold, word, self.sentence)
        if sentence.digits > limits.max_digits:
            self._drop("limit", self.sentence, f"a number has at most {limits.max_digits} digits")
        elif len(sentence.words) >= limits.max_words:
            self._drop("limit", self.sentence, f"a sentence has at most {limits.max_words} words")
        else:
            self._show(None)

    def _complete(self, hold: Hold, word: str, form: Form, sentence: Sentence) -> None:
        """A sentence is complete: issue it, ask for its second end word, or reject it for what it says."""
        arguments = bind(form, sentence.words, self._grammar.table)
        refused = objection(arguments, self._grammar)
        if refused is None and needs_confirmation(form, sentence, self._grammar.control):
            sentence.complete = form
            self._reporter.word(hold, word, self.sentence)
            self._reporter.notice("confirm", f"{self.sentence}: sign {self._grammar.end} again to confirm")
            self._show(None)
            return
        self._reporter.word(hold, word, IDLE)
        if refused is None:
            self._issue(form, sentence, arguments)
        else:
            self._drop(refused[0], self.sentence, refused[1])

    def _confirm(self, hold: Hold, word: str, sentence: Sentence, form: Form) -> None:
        """A word after a complete sentence that waits for its second end word."""
        if word == self._grammar.end:
            self._reporter.word(hold, word, IDLE)
            self._issue(form, sentence, bind(form, sentence.words, self._grammar.table))
        else:
            detail = f"{word} instead of {self._grammar.end} for {self.sentence}"
            self._drop("unconfirmed", self.sentence, detail)

    def _kill(self, hold: Hold, word: str) -> None:
        """The one word that is an instruction by itself, in every state."""
        if self._sentence is not None:
            self._drop("cancelled", self.sentence, f"{word} was signed")
        self._reporter.word(hold, word, IDLE)
        sentence = self._begin(hold)
        sentence.add(word, hold, 0, self._timeline.now_s, None)
        alone = Form(kind="kill", sentence=word, items=(Item(frozenset([word]), None, False),))
        self._issue(alone, sentence, Arguments(action=word))

    def _issue(self, form: Form, sentence: Sentence, arguments: Arguments) -> None:
        self._reporter.instruction(form, sentence, self.sentence, arguments)
        self._sentence = None
        self._show(None)

    def _miss(self) -> None:
        """Hands were seen for too long without a word: whatever follows, a word may be missing before it."""
        # What the sign means inside the sentence it may not mean outside.
        self._dwell.discard()
        detail = f"a sign after {self.sentence} was not read; sign the sentence again"
        self._drop("unread_sign", self.sentence, detail)

    def _drop(self, reason: str, text: str, detail: str) -> None:
        self._sentence = None
        self._reporter.rejected(reason, text, detail)
        self._show(None)

    def _show_growth(self) -> None:
        """A display follows the hold, and learns that it broke off, at most five times a second."""
        pair = self._dwell.pair
        if pair is None:
            self._show(None)
            return
        progress = round(self._dwell.progress, DECIMALS)
        self._show(Growth(pair=pair, word=self._meaning(pair), progress=progress))

    def _show(self, growth: Growth | None) -> None:
        self._reporter.state(self.state, self.sentence, growth, self._timeline.now_s)
