"""Signs, a pair a frame, become words, and words become instructions."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol, Self

from lightgesture.fsm.events import Event
from lightgesture.fsm.language.grammar import Grammar
from lightgesture.fsm.language.settings import SENTENCE, Rule
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import Reporter, Timeline
from lightgesture.fsm.rules.dwell import make_dwell
from lightgesture.fsm.rules.holds import HoldRule
from lightgesture.fsm.rules.unread import UnreadSigning
from lightgesture.fsm.signs import Signs

if TYPE_CHECKING:
    from lightgesture.fsm.rules.readings import Summary


class _Rule(Protocol):
    """When signs count: feeds the reader, and the reporter, with what it makes of the frames."""

    def process(self, signs: Signs, now_s: float, passed_s: float) -> None:
        """Take in one frame at `now_s` seconds of a time that never runs back, `passed_s` after the one before it."""
        ...

    def interrupt(self) -> None:
        """Frames are missing: what was half signed comes to nothing. The decoder drops an open sentence."""
        ...

    def finish(self) -> None:
        """The stream ends."""
        ...

    def readings(self) -> "Sequence[Summary]":
        """Of the last sentence, the best first."""
        ...


class Decoder:
    """Reads the signs of one frame after the other; what it makes of them are events.

    An instruction is issued only for a sentence that the grammar's table accepts from its start word to
    its end word. A held pair that is no word is reported and the sentence kept; a word that has no place
    rejects the sentence; a sentence without a new word for `timeout_s` is dropped, and so is one in which hands were
    seen for too long without saying a word, because a sign of it may have been missed. The rule "sentence" keeps
    several readings of the whole sentence instead and rejects what it doubts (`rules.sentence`).

    rule: in place of the grammar's own, see `DwellSettings`. hold: consecutive frames that make a word, at least 1, by
    the rule "frames". hold_seconds: seconds, above 0, by any other; the evidence that a word needs where the rule goes
    by evidence, the least length of a word by the rule "sentence". Both None: the grammar's own. caution: of the rule
    "sentence", above 0, see `SentenceSettings`; None: the grammar's own. source: name of the input in the events.
    ValueError: a number out of range, both holds, or one that the rule does not have.
    """

    def __init__(
        self,
        grammar: Grammar,
        *,
        rule: Rule | None = None,
        hold: int | None = None,
        hold_seconds: float | None = None,
        caution: float | None = None,
        source: str | None = None,
    ) -> None:
        self.grammar, self.source = grammar, source
        self._options: dict[str, Any] = {
            "rule": rule,
            "hold": hold,
            "hold_seconds": hold_seconds,
            "caution": caution,
        }
        self._timeline = Timeline()
        self._reporter = Reporter(source, self._timeline)
        # Frames are asked for by their number alone, whatever the grammar's own rule.
        self.rule: Rule = rule or ("frames" if hold is not None else grammar.dwell.rule)
        self._hold_frames: int | None = None
        if self.rule == SENTENCE:
            self._make_sentence_rule(hold, hold_seconds, caution)
        else:
            self._make_hold_rule(rule, hold, hold_seconds)

    def _make_sentence_rule(
        self, hold: int | None, hold_seconds: float | None, caution: float | None
    ) -> None:
        # NumPy is needed by this rule alone
        from lightgesture.fsm.rules.sentence import SentenceRule

        if hold is not None:
            raise ValueError("hold: the rule sentence goes by seconds; use hold_seconds")
        settings = self.grammar.sentence.changed(hold_seconds, caution)
        self._reader = Reader(self.grammar, self._reporter, self._timeline)
        self._hold_seconds: float | None = settings.hold_seconds
        self._rule: _Rule = SentenceRule(self.grammar, settings, self._reader, self._reporter, self._timeline)

    def _make_hold_rule(self, rule: Rule | None, hold: int | None, hold_seconds: float | None) -> None:
        settings = self.grammar.dwell
        dwell = make_dwell(settings, hold, hold_seconds, rule)
        unread = UnreadSigning(settings.unread * dwell.need, dwell.release, settings.passage_s)
        self._reader = Reader(self.grammar, self._reporter, self._timeline, unread)
        self._hold_frames = None if dwell.timed else int(dwell.need)
        self._hold_seconds = dwell.need if dwell.timed else None
        if dwell.timed and self.rule == "frames":
            self.rule = "seconds"
        self._rule = HoldRule(settings, dwell, unread, self._reader, self._reporter, self._timeline)

    @property
    def hold_frames(self) -> int | None:
        """Frames that make a word; None where a word is a matter of time."""
        return self._hold_frames

    @property
    def hold_seconds(self) -> float | None:
        """Seconds, of time or of evidence, that make a word; None where it is a matter of frames."""
        return self._hold_seconds

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

    @property
    def readings(self) -> "Sequence[Summary]":
        """By the rule "sentence" the best readings of the last sentence when it was judged; none by the others."""
        return self._rule.readings()

    def for_stream(self, source: str | None) -> Self:
        """Another decoder of the same grammar and options, for another stream."""
        return type(self)(self.grammar, **self._options, source=source)

    def step(self, signs: Signs, time_s: float, frame: int | None = None) -> list[Event]:
        """Take in one frame: what both hands show and the time stamp, seconds.

        frame: 0-based index; None: one more than the last. Stamps that stand still, run back or are not finite are
        endured: no time passes.
        """
        events: list[Event] = []
        reporter, timeline = self._reporter, self._timeline
        reporter.events = events
        reporter.frame = reporter.frame + 1 if frame is None else frame
        before_s = timeline.now_s
        now_s = timeline.advance(time_s)
        self._rule.process(signs, now_s, now_s - before_s)
        return events

    def interrupt(self, detail: str, time_s: float, frame: int | None = None) -> list[Event]:
        """A hole before the frame stamped `time_s`: no hold spans it, and an open sentence is dropped as "timeout"."""
        reporter = self._reporter
        reporter.events = []
        reporter.frame = reporter.frame if frame is None else frame
        self._timeline.advance(time_s)
        reporter.notice("gap", detail)
        self._rule.interrupt()
        if self._reader.sentence is not None:
            self._reader.drop("timeout", f"a sign may be missing: {detail}")
        return reporter.events

    def finish(self) -> list[Event]:
        """The end of the stream: an open sentence is dropped as "cancelled"; the decoder is idle again."""
        self._reporter.events = []
        self._rule.finish()
        if self._reader.sentence is not None:
            self._reader.drop("cancelled", "the input ended inside the sentence")
        return self._reporter.events
