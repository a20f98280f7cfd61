"""What `decode` does: inputs through the pipeline, records to standard output and to files.

An input that fails before its first frame leaves nothing but its error line. One that fails later, a video
that ends early, keeps what was decoded: its records and its file end with a summary whose status is "failed".
An interrupted input leaves no file.
"""

from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from lightgesture.console import Progress, say
from lightgesture.errors import ExitStatus, InputError
from lightgesture.opening import make_debug_pictures, make_folder, open_pipeline
from lightgesture.pipeline import Pipeline
from lightgesture.records import Record, SummaryRecord
from lightgesture.results import DebugPictures, JsonPrinter, TextPrinter, Writer, open_writer, output_stems
from lightgesture.settings import DecodeSettings
from lightgesture.sources import Source, open_source

SAMPLE = Path(__file__).with_name("data") / "sample.mp4"
"""The bundled clip, decoded where no input is named."""


class Task(NamedTuple):
    """One input: where it lies, what its records and its output files call it."""

    path: str
    name: str
    stem: str


def decode(inputs: Sequence[str], settings: DecodeSettings) -> ExitStatus:
    """Decode every input, one after the other; none: the bundled clip.

    An input that fails is told on standard error and the others go on. UsageError: the model, the grammar
    or an output folder is wrong.
    """
    if settings.out:
        make_folder(settings.out)
    status = ExitStatus.OK
    for task in _tasks(inputs, settings.quiet):
        try:
            _decode_one(task, settings)
        except InputError as error:
            say(str(error))
            status = ExitStatus.SOME_FAILED
    return status


def _tasks(inputs: Sequence[str], quiet: bool) -> list[Task]:
    if inputs:
        return [Task(path, path, stem) for path, stem in zip(inputs, output_stems(inputs), strict=True)]
    if not quiet:
        say("no input named; decoding the bundled clip")
    return [Task(str(SAMPLE), SAMPLE.name, SAMPLE.stem)]


def _decode_one(task: Task, settings: DecodeSettings) -> None:
    debug = make_debug_pictures(settings, task.stem)
    pipeline = open_pipeline(settings, task.name, debug)
    with ExitStack() as stack:
        source = stack.enter_context(
            open_source(task.path, settings.fps, size=settings.width_height, topic=settings.topic)
        )
        progress = stack.enter_context(Progress(task.name, source.frame_count, "frame", settings.quiet))
        printer = JsonPrinter if settings.as_json else TextPrinter
        writers: list[Writer] = [printer(progress.print_line, task.name)]
        if settings.out:
            writers.append(stack.enter_context(open_writer(Path(settings.out) / f"{task.stem}.jsonl")))
        failure = _process(source, pipeline, debug, progress, writers)
    if failure is not None:
        raise failure


def _process(
    source: Source,
    pipeline: Pipeline,
    debug: DebugPictures | None,
    progress: Progress,
    writers: Sequence[Writer],
) -> InputError | None:
    """Run a source to its end; what ended it early, if at least one frame was decoded before."""
    failure = None
    is_begun = False
    try:
        for frame in source:
            if debug is not None:
                debug.select(frame.time_s)
            _write(pipeline.process(frame.image, frame.time_s, frame.index), writers)
            progress.advance()
            is_begun = True
    except InputError as error:
        if not is_begun:
            raise
        failure = error
    _write(_finish(pipeline, is_failed=failure is not None), writers)
    return failure


def _finish(pipeline: Pipeline, is_failed: bool) -> Iterable[Record]:
    for record in pipeline.finish():
        if is_failed and isinstance(record, SummaryRecord):
            yield replace(record, status="failed")
        else:
            yield record


def _write(records: Iterable[Record], writers: Sequence[Writer]) -> None:
    for record in records:
        for writer in writers:
            writer.write(record)
