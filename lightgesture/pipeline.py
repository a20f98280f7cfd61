"""Frames in, records out: a front end that reads signs, and the decoder of what they say."""

import os
from contextlib import AbstractContextManager, nullcontext
from copy import copy
from dataclasses import replace
from datetime import datetime
from typing import TYPE_CHECKING, Any, Self

from numpy.typing import NDArray

from lightgesture.features.find.selector import SelectorName
from lightgesture.features.types import Image
from lightgesture.front_end import FrontEnd, StageClock
from lightgesture.fsm import Decoder, Event, Instruction, Rejected, Signs
from lightgesture.fsm.language.settings import SENTENCE, Rule
from lightgesture.halves import (
    HANDS,
    CardOptions,
    DecoderOptions,
    FrontOptions,
    HandOptions,
    make_decoder,
    make_front,
)
from lightgesture.hands.pictures import PictureSink, with_text
from lightgesture.models import check_classes
from lightgesture.models.loading import DEFAULT
from lightgesture.records import FrameRecord, Record, SummaryRecord, utc_text

if TYPE_CHECKING:
    from lightgesture.cards import FrontEndName
    from lightgesture.features.tags.detector import DetectorName


class OneBlasThread:
    """Makes blocks in which matrix products run in one thread; after a block the old number holds again.

    The classifier's products are tiny: a second thread gains nothing, and where other work keeps the cores busy, the
    waiting for it makes a frame ten times as slow. A block costs about 20 microseconds, or two where there is one
    thread anyway. Only libraries that are loaded when the object is made are limited, so NumPy must be.
    """

    def __init__(self) -> None:
        from threadpoolctl import ThreadpoolController

        self._libraries = ThreadpoolController().select(user_api="blas")

    def block(self) -> AbstractContextManager[object]:
        """A context with one thread."""
        if all(library.num_threads == 1 for library in self._libraries.lib_controllers):
            return nullcontext()
        limited: AbstractContextManager[object] = self._libraries.limit(limits=1)
        return limited


class Pipeline:
    """Decodes one stream of frames; make another for another stream, or take `for_stream`.

    As a context manager it lets go of what it has loaded when its block ends.

    front, decoder: the two halves; None: what the options below make.

    front_end: what is read, "hands", "tags" (cards, see `cards`) or "tag-motion" (two cards that are moved). mirrored:
    frames come from a selfie camera.

    Hands: model: "cnn", "svm" or the path of a model file. selector: "learned" (locator and refiner) or "classical" (no
    net), see `features.find.selector`. profile: path of a colour profile of the diver's hands, which replaces the map
    of skin colours; None for that map. threshold: least probability of a token, 0 to 1; None for the reader's own.
    rotate: degrees, 0, 90, 180 or 270, by which frames are turned clockwise to stand upright.

    Cards: tag_detector: "aruco" (OpenCV's) or "apriltag" (the extra `tags`, for murk). shapes: path of a file of shapes
    for "tag-motion", beside those of the package.

    The decoder: rule: "frames", "seconds", "evidence" or "sentence", None for the grammar's own. hold: consecutive
    frames that a sign is held; hold_seconds: seconds instead; both None for the grammar's own. caution: of the rule
    "sentence", how sure a sentence must be, None for the grammar's own. grammar: path of a grammar file, None for the
    bundled one. Cards count after the seconds that its [tags] or [motions] say, unless a rule or a hold is given.

    source: the name in the records. frames: give a frame record for each frame. debug: takes a picture of every stage
    of every frame.

    start_utc: the moment at which time_s is 0, if that is known; it may be set before any frame, and gives the records
    their `utc`.
    Raises lightgesture.models.ModelError, lightgesture.features.find.selector_file.SelectorError,
    lightgesture.features.profile.ProfileError, lightgesture.fsm.GrammarError,
    lightgesture.features.motion.shapes.ShapesError or ValueError: one line each.
    """

    def __init__(
        self,
        front: FrontEnd | None = None,
        decoder: Decoder | None = None,
        *,
        front_end: "FrontEndName" = HANDS,
        model: str | os.PathLike[str] = DEFAULT,
        selector: SelectorName = "learned",
        profile: str | os.PathLike[str] | None = None,
        mirrored: bool = False,
        rotate: int = 0,
        threshold: float | None = None,
        tag_detector: "DetectorName" = "aruco",
        shapes: str | os.PathLike[str] | None = None,
        rule: Rule | None = None,
        hold: int | None = None,
        hold_seconds: float | None = None,
        caution: float | None = None,
        grammar: str | os.PathLike[str] | None = None,
        source: str | None = None,
        frames: bool = True,
        debug: PictureSink | None = None,
    ) -> None:
        language = DecoderOptions(rule, hold, hold_seconds, caution, grammar)
        hands = HandOptions(model, selector, profile, threshold, rotate)
        cards = CardOptions(tag_detector, shapes)
        self.decoder = make_decoder(decoder, language, front_end, source)
        self.front = make_front(front, FrontOptions(front_end, mirrored), hands, cards, self.decoder)
        self._frames, self._one_thread = frames, OneBlasThread()
        self._begin(self.decoder.source, debug)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of the nets; what is asked to decode after raises ValueError. Others of `for_stream` go on."""
        self.front = _ClosedFront(self.front.clock)

    def check_language(self) -> str | None:
        """A line that warns of signs that the grammar does not know; None where it knows all that is read.

        Raises lightgesture.models.ModelError where the grammar has tokens that are never read.
        """
        tokens = self.front.tokens
        return None if tokens is None else check_classes(tokens, self.decoder.grammar.tokens)

    def for_stream(self, source: str | None, debug: PictureSink | None = None) -> Self:
        """Another pipeline of the same settings, for another stream, with what this one has loaded.

        The two must not run in several threads at once.
        """
        other = copy(self)
        other.front, other.decoder = self.front.for_stream(), self.decoder.for_stream(source)
        other._begin(source, debug)
        return other

    def _begin(self, source: str | None, debug: PictureSink | None) -> None:
        """Everything that is counted over the stream."""
        self._source, self._debug = source, debug
        self.start_utc: datetime | None = None
        self._index = 0
        self._processed = 0
        self._seconds = 0.0
        self._counts = {Instruction: 0, Rejected: 0}

    def process(self, image_bgr: NDArray[Any], time_s: float, index: int | None = None) -> list[Record]:
        """Records of the next frame: its frame record, then what it led to.

        image_bgr: uint8 (height, width, 3), BGR; another size than before ends the tracks. time_s: seconds since
        the start of the stream. index: position in the source, by default counted.
        """
        index = self._index if index is None else index
        clock = self.front.clock
        with self._one_thread.block():
            clock.start()
            signs = self.front.process(image_bgr, time_s)
            events = self.decoder.step(signs, time_s, index)
            clock.lap("decode")
            clock.end_frame()
        self._index, self._seconds = index + 1, time_s
        self._processed += 1
        if self._debug is not None and self._debug.is_selected:
            picture = self._draw(self._debug, index)
            if picture is not None:
                self._debug.write("decode", index, with_text(picture, self.decoder.sentence or "idle"))
        records: list[Record] = [self._record(index, time_s)] if self._frames else []
        return records + self._count(events)

    def interrupt(self, detail: str, time_s: float, index: int | None = None) -> list[Record]:
        """Something is missing before the next frame, whose stamp and index these are: no sentence spans it.

        detail: what is missing, in words. `lightgesture.watch` finds what no source tells of.
        """
        return self._count(self.decoder.interrupt(detail, time_s, index))

    def finish(self) -> list[Record]:
        """What is pending at the end of the stream, then the summary."""
        pending = self._count(self.decoder.finish())
        summary = SummaryRecord(
            source=self._source,
            frames=self._processed,
            utc=utc_text(self.start_utc, self._seconds),
            seconds=round(self._seconds, 6),
            instructions=self._counts[Instruction],
            rejected=self._counts[Rejected],
            status="ok",
            ms_per_frame=self.front.clock.per_frame(),
            stages_ms=self.front.clock.per_stage(),
        )
        return [*pending, summary]

    def recognize(self, image_bgr: NDArray[Any]) -> FrameRecord:
        """The signs in a single picture, without memory: `frame` and `time_s` are None."""
        with self._one_thread.block():
            self.front.recognize(image_bgr)
        if self._debug is not None and self._debug.is_selected:
            self._draw(self._debug, 0)
        return self._record(None, None)

    def _draw(self, debug: PictureSink, index: int) -> Image | None:
        """Write the pictures of the front end's stages; the last of them."""
        picture = None
        for stage, picture in self.front.pictures():
            debug.write(stage, index, picture)
        return picture

    def _record(self, index: int | None, time_s: float | None) -> FrameRecord:
        is_told = time_s is not None and self.decoder.rule == SENTENCE
        utc = utc_text(self.start_utc, time_s)
        return FrameRecord(
            source=self._source,
            frame=index,
            time_s=time_s,
            utc=utc,
            probabilities=is_told,
            **self.front.shown(),
        )

    def _count(self, events: list[Event]) -> list[Record]:
        for event in events:
            if type(event) in self._counts:
                self._counts[type(event)] += 1
        if self.start_utc is None:
            return list(events)
        return [replace(event, utc=utc_text(self.start_utc, event.time_s)) for event in events]


class _ClosedFront(FrontEnd):
    """Stands in the place of one that was let go."""

    def __init__(self, clock: StageClock) -> None:
        self.clock = clock

    def process(self, image: Image, time_s: float) -> Signs:  # noqa: ARG002 - those of its base
        raise ValueError("this pipeline is closed; make another")
