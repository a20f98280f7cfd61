"""Word by word: what a rule of dwell takes for a held sign is a word at once ("frames", "seconds", "evidence")."""

from lightgesture.fsm.events import Growth
from lightgesture.fsm.language.settings import DwellSettings
from lightgesture.fsm.reader import Reader
from lightgesture.fsm.reporter import DECIMALS, DISPLAY_INTERVAL_S, Reporter, Timeline
from lightgesture.fsm.rules.dwell import Dwell
from lightgesture.fsm.rules.unread import UnreadSigning
from lightgesture.fsm.signs import Signs


class HoldRule:
    """Reads one held sign after the other.

    dwell: tells what is held. unread: is told by the reader what was read. A sentence without a new word for
    `timeout_s` is dropped, and so is one in which hands were seen for too long without saying a word, because a sign
    of it may have been missed.
    """

    def __init__(
        self,
        settings: DwellSettings,
        dwell: Dwell,
        unread: UnreadSigning,
        reader: Reader,
        reporter: Reporter,
        timeline: Timeline,
    ) -> None:
        self._dwell, self._unread = dwell, unread
        self._reader, self._reporter, self._timeline = reader, reporter, timeline
        self._count_hidden = settings.count_hidden
        self._timeout_s = settings.timeout_s

    def process(self, signs: Signs, now_s: float, passed_s: float) -> None:
        """Take in one frame; passed_s: seconds since the one before it."""
        reporter, dwell, reader = self._reporter, self._dwell, self._reader
        sentence = reader.sentence
        if sentence is not None and now_s - sentence.touched_s >= self._timeout_s:
            # A sign half held must not live on: outside the sentence it may mean something else.
            dwell.discard()
            reader.drop("timeout", f"no word for {self._timeout_s:g} s")
            sentence = None
        shown = signs.shown
        hold = dwell.process(shown, signs.confidence, reporter.frame, self._timeline.time_s, now_s)
        if hold is not None:
            reader.read(hold)
        elif sentence is not None and (shown is None or shown != dwell.spent):
            is_counted = signs.left.seen or signs.right.seen or self._count_hidden
            if is_counted and self._unread.process(shown, dwell.step, passed_s):
                self._miss()
        is_worth_showing = dwell.pair is not None or reporter.is_growth_shown
        if is_worth_showing and now_s - reporter.shown_s >= DISPLAY_INTERVAL_S:
            self._show_growth()

    def interrupt(self) -> None:
        """Frames are missing; inside a sentence the sign that was half held must not live on outside it."""
        if self._reader.sentence is None:
            self._dwell.reset()
        else:
            self._dwell.discard()

    def finish(self) -> None:
        """The end of the stream: a sign half held comes to nothing."""
        self._dwell.reset()

    def readings(self) -> tuple[()]:
        """There is but one reading, the sentence itself."""
        return ()

    def _miss(self) -> None:
        """Hands were seen for too long without a word: whatever follows, a word may be missing before it."""
        # What the sign means inside the sentence it may not mean outside.
        self._dwell.discard()
        reader = self._reader
        detail = f"a sign after {reader.text} was not read; sign the sentence again"
        reader.drop("unread_sign", detail)

    def _show_growth(self) -> None:
        """A display follows the hold, and learns that it broke off, at most five times a second."""
        reader, pair = self._reader, self._dwell.pair
        growth: Growth | None = None
        if pair is not None:
            progress = round(self._dwell.progress, DECIMALS)
            growth = Growth(pair=pair, word=reader.word_of(pair), progress=progress)
        reader.show(growth)
