"""Pairs, one a frame, become words, and words become instructions."""

import math

from lightgesture.fsm.dwell import Hold, make_dwell
from lightgesture.fsm.events import Event, Growth, Instruction, Notice, Pair, Rejected, State, Word
from lightgesture.fsm.forms import Form, spell
from lightgesture.fsm.grammar import Grammar
from lightgesture.fsm.sentence import Sentence, name_expected, objection
from lightgesture.fsm.table import bind
from lightgesture.fsm.timeline import Timeline
from lightgesture.fsm.unread import UnreadSigning

IDLE = "idle"
COLLECTING = "collecting"

DISPLAY_INTERVAL_S = 0.2
"""Shortest time between two `state` records while a hold grows, seconds: five a second."""

DECIMALS = 4
"""Decimals of confidences and progress in the events."""


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

    __slots__ = (
        "_dwell",
        "_frame",
        "_grammar",
        "_growth_shown",
        "_sentence",
        "_shown_s",
        "_source",
        "_time_s",
        "_timeline",
        "_unread",
    )

    def __init__(
        self,
        grammar: Grammar,
        *,
        hold: int | None = None,
        hold_seconds: float | None = None,
        source: str | None = None,
    ) -> None:
        self._grammar = grammar
        self._source = source
        self._dwell = make_dwell(grammar.dwell, hold, hold_seconds)
        self._unread = UnreadSigning(grammar.dwell.unread * self._dwell.need)
        self._timeline = Timeline()
        self._sentence: Sentence | None = None
        self._frame = -1
        self._time_s = 0.0
        self._shown_s = -math.inf
        self._growth_shown = False

    @property
    def state(self) -> str:
        """ "idle" or "collecting"."""
        return IDLE if self._sentence is None else COLLECTING

    @property
    def sentence(self) -> str:
        """The open sentence so far, digits joined; empty while idle."""
        return "" if self._sentence is None else self._sentence.text(self._grammar.vocabulary.join)

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
        self._frame = self._frame + 1 if frame is None else frame
        if math.isfinite(time_s):
            self._time_s = time_s
        now_s = self._timeline.advance(self._time_s)
        events: list[Event] = []
        timeout_s = self._grammar.dwell.timeout_s
        if self._sentence is not None and now_s - self._sentence.touched_s >= timeout_s:
            # A sign half held must not live on: outside the sentence it may mean something else.
            self._dwell.discard()
            self._drop(events, "timeout", self.sentence, f"no word for {timeout_s:g} s")
        confidence = left_confidence if left_confidence < right_confidence else right_confidence
        pair = None if left is None or right is None else (left, right)
        dwell = self._dwell
        hold = dwell.process(pair, confidence, self._frame, self._time_s, now_s)
        if hold is not None:
            self._read(events, hold)
        elif self._sentence is not None and (pair is None or pair != dwell.spent):
            is_left = left is not None if left_seen is None else left_seen
            is_right = right is not None if right_seen is None else right_seen
            if (is_left or is_right) and self._unread.process(pair, dwell.pair, dwell.step):
                self._miss(events)
        self._show_growth(events)
        return events

    def finish(self) -> list[Event]:
        """The end of the stream: an open sentence is dropped as "cancelled"; the decoder is idle again."""
        events: list[Event] = []
        self._dwell.reset()
        if self._sentence is not None:
            self._drop(events, "cancelled", self.sentence, "the input ended inside the sentence")
        return events

    def _read(self, events: list[Event], hold: Hold) -> None:
        """A pair was held long enough."""
        word = self._meaning(hold.pair)
        left, right = hold.pair
        if word is None:
            inside = hold.pair in self._grammar.idle_words
            place = "no word inside a sentence" if inside else "no word"
            self._unread.pass_over()
            self._notice(events, "unknown_pair", f"{left},{right} is {place}; repeat it")
            return
        row = self._grammar.table.transitions[self._sentence.state if self._sentence else 0]
        if word in row:
            self._accept(events, hold, word, row[word])
        elif self._sentence is None:
            self._notice(events, "out_of_order", f"{word} opens no sentence; expected {name_expected(row)}")
        else:
            detail = f"{word} cannot follow {self.sentence}; expected {name_expected(row)}"
            text = spell([*self._sentence.words, word], self._grammar.vocabulary.join)
            self._drop(events, "out_of_order", text, detail)

    def _meaning(self, pair: Pair) -> str | None:
        words = self._grammar.idle_words if self._sentence is None else self._grammar.sentence_words
        return words.get(pair)

    def _accept(self, events: list[Event], hold: Hold, word: str, target: int) -> None:
        """A word has its place: the sentence goes on or is complete."""
        now_s = self._timeline.now_s
        if self._sentence is None:
            self._sentence = Sentence(
                start_frame=hold.first_frame, start_time_s=hold.first_time_s, touched_s=now_s
            )
        sentence = self._sentence
        self._unread.reset()
        sentence.add(word, hold, target, now_s, self._grammar.vocabulary.join)
        form = self._grammar.table.accepting.get(target)
        events.append(
            Word(
                source=self._source,
                frame=self._frame,
                time_s=self._time_s,
                pair=hold.pair,
                word=word,
                state=self.sentence if form is None else IDLE,
                confidence=round(hold.confidence, DECIMALS),
            )
        )
        max_digits = self._grammar.limits.max_digits
        if form is not None:
            self._conclude(events, sentence, form)
        elif sentence.digits > max_digits:
            self._drop(events, "limit", self.sentence, f"a number has at most {max_digits} digits")
        else:
            self._show(events, None)

    def _conclude(self, events: list[Event], sentence: Sentence, form: Form) -> None:
        """A sentence is complete: issue it, or reject it for what it says."""
        arguments = bind(form, sentence.words, self._grammar.vocabulary)
        refused = objection(arguments, self._grammar)
        if refused is not None:
            reason, detail = refused
            self._drop(events, reason, self.sentence, detail)
            return
        events.append(
            Instruction(
                source=self._source,
                frame=self._frame,
                time_s=self._time_s,
                start_frame=sentence.start_frame,
                start_time_s=sentence.start_time_s,
                text=self.sentence,
                kind=form.kind,
                action=arguments.action,
                duration_s=arguments.seconds,
                program=arguments.program,
                parameter=arguments.parameter,
                change=arguments.change,
                confidence=round(sentence.confidence, DECIMALS),
                words=tuple(sentence.words),
            )
        )
        self._sentence = None
        self._show(events, None)

    def _miss(self, events: list[Event]) -> None:
        """Hands were seen for too long without a word: whatever follows, a word may be missing before it."""
        # What the sign means inside the sentence it may not mean outside.
        self._dwell.discard()
        detail = f"a sign after {self.sentence} was not read; sign the sentence again"
        self._drop(events, "unread_sign", self.sentence, detail)

    def _drop(self, events: list[Event], reason: str, text: str, detail: str) -> None:
        self._sentence = None
        rejected = Rejected(
            source=self._source,
            frame=self._frame,
            time_s=self._time_s,
            reason=reason,
            text=text,
            detail=detail,
        )
        events.append(rejected)
        self._show(events, None)

    def _notice(self, events: list[Event], reason: str, detail: str) -> None:
        notice = Notice(
            source=self._source, frame=self._frame, time_s=self._time_s, reason=reason, detail=detail
        )
        events.append(notice)

    def _show_growth(self, events: list[Event]) -> None:
        """A display follows the hold, and learns that it broke off, at most five times a second."""
        pair = self._dwell.pair
        if pair is None and not self._growth_shown:
            return
        if self._timeline.now_s - self._shown_s < DISPLAY_INTERVAL_S:
            return
        if pair is None:
            self._show(events, None)
            return
        progress = round(self._dwell.progress, DECIMALS)
        self._show(events, Growth(pair=pair, word=self._meaning(pair), progress=progress))

    def _show(self, events: list[Event], growth: Growth | None) -> None:
        self._shown_s = self._timeline.now_s
        self._growth_shown = growth is not None
        state = State(
            source=self._source,
            frame=self._frame,
            time_s=self._time_s,
            state=self.state,
            sentence=self.sentence,
            dwell=growth,
        )
        events.append(state)
