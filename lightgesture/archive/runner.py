"""One input through the pipeline, records to files and messages.

An input that fails before its first frame leaves no file. One that fails later, a video that ends early or shows hardly
anything, keeps what was decoded: its records and its files end with a summary whose status is "failed". An interrupted
input leaves no file.
"""

import gc
import time
from collections.abc import Iterable
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lightgesture.archive.tasks import Advanced, Hear, Opened, Outcome, Printed, Remarked, Task
from lightgesture.config.opening import make_debug_pictures, open_stream
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import ReaderGoneError
from lightgesture.errors import InputError, UsageError, defect_of
from lightgesture.frames import Frame
from lightgesture.hints import Hints
from lightgesture.pipeline import Pipeline
from lightgesture.records import FrameRecord, Record, SummaryRecord
from lightgesture.results import (
    WRITERS,
    DebugPictures,
    JsonPrinter,
    TextPrinter,
    Writer,
    open_writer,
)
from lightgesture.results.ownership import ANNOTATED
from lightgesture.sources import Source
from lightgesture.watch import Watch

if TYPE_CHECKING:
    from lightgesture.results.annotated import AnnotatedVideo


class Runner:
    """Decodes input after input with the models that the first one loaded.

    encoding: of standard output, for what it lacks is escaped in JSON.
    """

    def __init__(self, settings: DecodeSettings, encoding: str) -> None:
        self._settings = settings
        self._encoding = encoding
        self._pipeline: Pipeline | None = None

    def run(self, task: Task, hear: Hear) -> Outcome:
        """Decode one input and tell `hear` of it, all but the outcome.

        UsageError: the model, the grammar or an output folder is wrong.
        """
        start = time.perf_counter()
        debug = make_debug_pictures(self._settings, task.stem)
        pipeline = self._open_pipeline(task, debug, hear)
        try:
            outcome = _Work(task, self._settings, pipeline, debug, self._encoding, hear).run()
        except InputError as error:
            outcome = Outcome("failed", str(error))
        except (UsageError, ReaderGoneError, BrokenPipeError, ModuleNotFoundError):
            raise
        except Exception as error:
            # A stage, ours or one that was given, must not take the other inputs with it.
            outcome = Outcome("failed", f"{task.name}: {defect_of(error)}")
        # Frames and decoders that hang in circles of references would wait for it through many videos.
        gc.collect()
        return replace(outcome, seconds=time.perf_counter() - start)

    def _open_pipeline(self, task: Task, debug: DebugPictures | None, hear: Hear) -> Pipeline:
        if self._pipeline is None:
            needs_frames = self._settings.frames or self._settings.is_annotated or self._settings.plot
            settings = self._settings.model_copy(update={"frames": needs_frames})
            self._pipeline = open_stream(settings, None, None, lambda text: hear(Remarked(task.place, text)))
        return self._pipeline.for_stream(task.name, debug)


class _Work:
    """One input while it is decoded."""

    def __init__(
        self,
        task: Task,
        settings: DecodeSettings,
        pipeline: Pipeline,
        debug: DebugPictures | None,
        encoding: str,
        hear: Hear,
    ) -> None:
        self._task, self._settings, self._pipeline, self._debug = task, settings, pipeline, debug
        self._hear = hear
        self._writers: list[Writer] = [self._printer(encoding)]
        self._frame_writers: list[Writer] = []
        self._video: AnnotatedVideo | None = None
        self._files: list[str] = []
        self._summary: SummaryRecord | None = None
        self._watch = Watch()
        self._hints = None if settings.quiet else Hints(pipeline, settings.mirrored, settings.rotate)

    def run(self) -> Outcome:
        """InputError: no frame could be decoded."""
        with ExitStack() as stack:
            source = stack.enter_context(self._task.open(self._settings))
            self._hear(Opened(self._task.place, source.frame_count))
            self._pipeline.start_utc = source.start_utc
            self._open_files(stack)
            failure = self._process(source)
        summary = self._summary
        return Outcome(
            status="ok" if failure is None else "failed",
            message=None if failure is None else str(failure),
            frames=summary.frames if summary else 0,
            instructions=summary.instructions if summary else 0,
            rejected=summary.rejected if summary else 0,
            files=tuple(self._files),
        )

    def _printer(self, encoding: str) -> Writer:
        place, name = self._task.place, self._task.name

        def print_line(line: str) -> None:
            self._hear(Printed(place, (line,)))

        return JsonPrinter(print_line, encoding) if self._settings.as_json else TextPrinter(print_line, name)

    def _open_files(self, stack: ExitStack) -> None:
        if not self._settings.out:
            return
        # What is opened last is put in place first, and where that fails the rest is not: so the likeliest to fail.
        for suffix in reversed(WRITERS):
            self._writers.append(stack.enter_context(open_writer(self._path(suffix), self._task.name)))
        if self._settings.plot:
            from lightgesture.results.timeline import open_plot

            self._frame_writers.append(stack.enter_context(open_plot(self._path(".png"), self._task.name)))
        if self._settings.annotate != "no":
            from lightgesture.results.annotated import open_annotated_video

            video = open_annotated_video(
                self._path(ANNOTATED), self._task.files, self._settings.annotate, self._settings.rotate
            )
            self._video = stack.enter_context(video)

    def _path(self, suffix: str) -> Path:
        name = f"{self._task.stem}{suffix}"
        self._files.append(name)
        return Path(self._settings.out or "") / name

    def _process(self, source: Source) -> InputError | None:
        """Run the source to its end; what ended it early, if at least one frame was decoded before."""
        failure = None
        is_begun = False
        try:
            for frame in source:
                self._process_frame(frame)
                is_begun = True
        except InputError as error:
            if not is_begun:
                raise
            failure = error
        if failure is None and self._watch.is_blank:
            text = "most frames show nothing, all pixels being the same; look at the camera, or convert the input"
            failure = InputError(f"{source.name}: {text}")
        self._write(_finish(self._pipeline, is_failed=failure is not None))
        for text in self._hints.texts() if self._hints is not None else ():
            self._hear(Remarked(self._task.place, f"{self._task.name}: {text}"))
        return failure

    def _process_frame(self, frame: Frame) -> None:
        if self._debug is not None:
            self._debug.select(frame.time_s)
        hole = self._watch.look(frame.image, frame.time_s)
        records: list[Record] = []
        if (gap := frame.gap or hole) is not None:
            records += self._pipeline.interrupt(gap, frame.time_s, frame.index)
        records += self._pipeline.process(frame.image, frame.time_s, frame.index)
        if self._video is not None:
            self._video.write(frame.image, frame.time_s, records)
        self._write(records)
        if self._hints is not None:
            self._hints.look(frame.image, frame.time_s, records)
        self._hear(Advanced(self._task.place, 1))

    def _write(self, records: Iterable[Record]) -> None:
        for record in records:
            for writer in self._frame_writers:
                writer.write(record)
            if isinstance(record, FrameRecord) and not self._settings.frames:
                continue
            if isinstance(record, SummaryRecord):
                self._summary = record
            for writer in self._writers:
                writer.write(record)


def _finish(pipeline: Pipeline, is_failed: bool) -> Iterable[Record]:
    for record in pipeline.finish():
        if is_failed and isinstance(record, SummaryRecord):
            yield replace(record, status="failed")
        else:
            yield record
