"""Pairs, one a frame, become words, and words become instructions."""

import math

from lightgesture.fsm.dwell import Dwell, Hold, release_frames
from lightgesture.fsm.events import Event, Growth, Instruction, Notice, Rejected, State, Word
from lightgesture.fsm.forms import Form, spell
from lightgesture.fsm.grammar import Grammar
from lightgesture.fsm.sentence import Sentence, name_expected, objection
from lightgesture.fsm.table import bind
from lightgesture.fsm.timeline import Timeline

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
    rejects the sentence; a sentence without a new word for `timeout_s` is dropped.

    hold: consecutive frames that make a word, at least 1; None: the grammar's own. source: name of the
    input in the events. ValueError: a hold below 1.
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
    )

    def __init__(self, grammar: Grammar, *, hold: int | None = None, source: str | None = None) -> None:
        frames = grammar.dwell.hold if hold is None else hold
        if frames < 1:
            raise ValueError(f"hold is {frames} frames; use a whole number from 1, such as 15")
        self._grammar = grammar
        self._source = source
        self._dwell = Dwell(frames, release_frames(frames, grammar.dwell.release))
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
    ) -> list[Event]:
        """Take in one frame: the tokens of the diver's hands (None: no token) and the time stamp, seconds.

        Confidences: 0 to 1; the lower of the two is the pair's. frame: 0-based index; None: one more
        than the last. Stamps that stand still, run back or are not finite are endured: no time passes.
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
        hold = self._dwell.process(pair, confidence, self._frame, self._time_s)
        if hold is not None:
            self._read(events, hold)
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
        word = self._meaning(hold)
        left, right = hold.pair
        if word is None:
            inside = hold.pair in self._grammar.idle_words
            place = "no word inside a sentence" if inside else "no word"
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

    def _meaning(self, hold: Hold) -> str | None:
        words = self._grammar.idle_words if self._sentence is None else self._grammar.sentence_words
        return words.get(hold.pair)

    def _accept(self, events: list[Event], hold: Hold, word: str, target: int) -> None:
        """A word has its place: the sentence goes on or is complete."""
        now_s = self._timeline.now_s
        if self._sentence is None:
            self._sentence = Sentence(
                start_frame=hold.first_frame, start_time_s=hold.first_time_s, touched_s=now_s
            )
        sentence = self._sentence
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
        hold = self._dwell.growing
        if hold is None and not self._growth_shown:
            return
        if self._timeline.now_s - self._shown_s < DISPLAY_INTERVAL_S:
            return
        if hold is None:
            self._show(events, None)
            return
        progress = round(hold.frames / self._dwell.hold, DECIMALS)
        self._show(events, Growth(pair=hold.pair, word=self._meaning(hold), progress=progress))

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
