"""Signs, a pair a frame, become words, and words become instructions."""

from typing import Self

from lightgesture.fsm.events import Event, Growth
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import DECIMALS, DISPLAY_INTERVAL_S, Reporter, Timeline
from lightgesture.fsm.rules.dwell import make_dwell
from lightgesture.fsm.rules.unread import UnreadSigning
from lightgesture.fsm.signs import Signs


class Decoder:
    """Reads the signs of one frame after the other; what it makes of them are events.

    An instruction is issued only for a sentence that the grammar's table accepts from its start word to
    its end word. A held pair that is no word is reported and the sentence kept; a word that has no place
    rejects the sentence; a sentence without a new word for `timeout_s` is dropped, and so is one in which hands were
    seen for too long without saying a word, because a sign of it may have been missed.

    hold: consecutive frames that make a word, at least 1. hold_seconds: seconds instead, above 0; the evidence that a
    word needs where the grammar goes by evidence. Both None: the grammar's own. source: name of the input in the
    events. ValueError: a hold out of range, or both.
    """

    def __init__(
        self,
        grammar: Grammar,
        *,
        hold: int | None = None,
        hold_seconds: float | None = None,
        source: str | None = None,
    ) -> None:
        self.grammar = grammar
        self._dwell = make_dwell(grammar.dwell, hold, hold_seconds)
        self._unread = UnreadSigning(
            grammar.dwell.unread * self._dwell.need, self._dwell.release, grammar.dwell.passage_s
        )
        self._count_hidden = grammar.dwell.count_hidden
        self._timeline = Timeline()
        self._timeout_s = grammar.dwell.timeout_s
        self._reporter = Reporter(source, self._timeline)
        self._reader = Reader(grammar, self._reporter, self._timeline, self._unread)

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
        return self._reader.state

    @property
    def sentence(self) -> str:
        """The open sentence so far, digits joined; empty while idle."""
        return self._reader.text

    @property
    def expected(self) -> str:
        """What may follow, for the diver: "GO or a digit"."""
        return self._reader.expected

    def for_stream(self, source: str | None) -> Self:
        """Another decoder of the same grammar and hold, for another stream."""
        return type(self)(self.grammar, hold=self.hold_frames, hold_seconds=self.hold_seconds, source=source)

    def step(self, signs: Signs, time_s: float, frame: int | None = None) -> list[Event]:
        """Take in one frame: what both hands show and the time stamp, seconds.

        frame: 0-based index; None: one more than the last. Stamps that stand still, run back or are not finite are
        endured: no time passes.
        """
        events: list[Event] = []
        reporter, dwell, timeline = self._reporter, self._dwell, self._timeline
        reporter.events = events
        reporter.frame = reporter.frame + 1 if frame is None else frame
        before_s = timeline.now_s
        now_s = timeline.advance(time_s)
        sentence = self._reader.sentence
        if sentence is not None and now_s - sentence.touched_s >= self._timeout_s:
            # A sign half held must not live on: outside the sentence it may mean something else.
            dwell.discard()
            self._reader.drop("timeout", f"no word for {self._timeout_s:g} s")
            sentence = None
        shown = signs.shown
        hold = dwell.process(shown, signs.confidence, reporter.frame, timeline.time_s, now_s)
        if hold is not None:
            self._reader.read(hold)
        elif sentence is not None and (shown is None or shown != dwell.spent):
            is_counted = signs.left.seen or signs.right.seen or self._count_hidden
            if is_counted and self._unread.process(shown, dwell.step, now_s - before_s):
                self._miss()
        is_worth_showing = dwell.pair is not None or reporter.is_growth_shown
        if is_worth_showing and now_s - reporter.shown_s >= DISPLAY_INTERVAL_S:
            self._show_growth()
        return events

    def interrupt(self, detail: str, time_s: float, frame: int | None = None) -> list[Event]:
        """A hole before the frame stamped `time_s`: no hold spans it, and an open sentence is dropped as "timeout"."""
        reporter = self._reporter
        reporter.events = []
        reporter.frame = reporter.frame if frame is None else frame
        self._timeline.advance(time_s)
        reporter.notice("gap", detail)
        if self._reader.sentence is None:
            self._dwell.reset()
        else:
            self._dwell.discard()
            self._reader.drop("timeout", f"a sign may be missing: {detail}")
        return reporter.events

    def finish(self) -> list[Event]:
        """The end of the stream: an open sentence is dropped as "cancelled"; the decoder is idle again."""
        self._reporter.events = []
        self._dwell.reset()
        if self._reader.sentence is not None:
            self._reader.drop("cancelled", "the input ended inside the sentence")
        return self._reporter.events

    def _miss(self) -> None:
        """Hands were seen for too long without a word: whatever follows, a word may be missing before it."""
        # What the sign means inside the sentence it may not mean outside.
        self._dwell.discard()
        detail = f"a sign after {self.sentence} was not read; sign the sentence again"
        self._reader.drop("unread_sign", detail)

    def _show_growth(self) -> None:
        """A display follows the hold, and learns that it broke off, at most five times a second."""
        reader, pair = self._reader, self._dwell.pair
        growth: Growth | None = None
        if pair is not None:
            progress = round(self._dwell.progress, DECIMALS)
            growth = Growth(pair=pair, word=reader.word_of(pair), progress=progress)
        reader.show(growth)
