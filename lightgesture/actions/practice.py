"""What `practice` does: tasks, a camera or a recording, a page, and a summary at the end."""

import json
import os
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Final

from lightgesture.actions.live import for_stream, make_clock, make_report
from lightgesture.config.opening import make_folder, open_stream
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.fsm import Grammar
from lightgesture.fsm.language.settings import SENTENCE
from lightgesture.interruption import Stopping, stop_signals
from lightgesture.live import LiveLoop, Mailbox, Reader, Report
from lightgesture.pipeline import Pipeline
from lightgesture.practice.guide import Guide
from lightgesture.practice.page import mirror_drawing
from lightgesture.practice.session import Session
from lightgesture.practice.study import TABLE, person_file, read_people, tabulate, tell_table, to_csv
from lightgesture.practice.summary import summary, tell_summary, view
from lightgesture.practice.tasks import Task, drawn_tasks, named_tasks, study_tasks
from lightgesture.records import Record
from lightgesture.results.atomic import replacing
from lightgesture.sources import Source, live_source, open_source, refuse_missing_device
from lightgesture.watch import Watch
from lightgesture.web import WebListener

GIVE_UP_S: Final = 10.0
"""Seconds without a picture after which a practice ends: somebody stands before the camera and waits."""

END_S: Final = 3.0
"""Seconds for which the page stays after the last sentence, so that a browser gets the summary."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """What is practised; see the command's options."""

    sentences: tuple[str, ...] = ()
    count: int = 5
    seed: int | None = None
    limit_s: float = 60.0
    is_study: bool = False
    person: str | None = None
    level: str = "beginner"
    folder: str = "practice"


def run_practice(source_name: str, settings: DecodeSettings, plan: Plan) -> ExitStatus:
    """Practise and write the summary; what was signed before an interruption or the end of a stream is kept.

    OK; INTERRUPTED after Ctrl-C; SOME_FAILED where the stream was no use. UsageError: source, sentence, grammar or
    folder is wrong.
    """
    _check(plan)
    is_recording = os.path.isfile(source_name) or os.path.isdir(source_name)
    if not is_recording:
        refuse_missing_device(source_name)
    make_folder(plan.folder)
    report = make_report()
    tell: Callable[[str], None] = (lambda _: None) if settings.as_json else print_line
    with ExitStack() as stack:
        stopping = stack.enter_context(stop_signals())
        source = _open(source_name, settings, is_recording)
        pipeline = open_stream(for_stream(settings), source.name, None, report)
        grammar = pipeline.decoder.grammar
        session = Session(
            _tasks(grammar, plan), grammar, plan.limit_s, is_revised=pipeline.decoder.rule == SENTENCE
        )
        page = stack.enter_context(
            WebListener(
                settings.web or 0,
                settings.web_host,
                None if settings.mirrored else mirror_drawing(),
                grammar,
                token=settings.web_token,
            )
        )
        if not settings.quiet:
            report(f"open {page.link('practice')} in a browser")
        practice = Guide(session, pipeline, page, tell, report, stopping)
        if isinstance(source, Source):
            status = _run_recording(source, pipeline, practice, stopping, report, settings.web is not None)
        else:
            status = _run_live(source, settings, pipeline, practice, stopping, report)
        content = summary(
            session, source.name, grammar.file, plan.person, plan.level if plan.is_study else None
        )
        page.tell("practice", {**view(session), "is_done": True, "summary": list(tell_summary(content))})
        is_whole = status == ExitStatus.OK and (session.is_done or not stopping.is_set())
        _close(content, settings, plan, tell, is_whole)
        if page.viewers:
            time.sleep(END_S)
    return ExitStatus.INTERRUPTED if stopping.is_interrupted else status


def _check(plan: Plan) -> None:
    """UsageError: options that do not go together."""
    if plan.is_study and plan.sentences:
        raise UsageError("--study: has sentences of its own; leave out --sentence")
    if plan.is_study and plan.person is None:
        raise UsageError("--study: whose results are these? name a code with --person CODE")
    if plan.person is not None:
        person_file(plan.folder, plan.person)


def _tasks(grammar: Grammar, plan: Plan) -> list[Task]:
    if plan.is_study:
        return study_tasks(grammar)
    if plan.sentences:
        return named_tasks(grammar, plan.sentences)
    return drawn_tasks(grammar, plan.count, plan.seed)


def _open(name: str, settings: DecodeSettings, is_recording: bool) -> Any:
    """The source. UsageError: it is none, or cannot be opened."""
    if not is_recording:
        return live_source(name, settings.source_options)
    try:
        return open_source(name, settings.source_options)
    except InputError as error:
        raise UsageError(str(error)) from error


def _run_recording(
    source: Source,
    pipeline: Pipeline,
    practice: Guide,
    stopping: Stopping,
    report: Report,
    is_paced: bool,
) -> ExitStatus:
    """Every frame of a recording; paced: no faster than it was recorded, for who looks at the page.

    SOME_FAILED where it breaks off.
    """
    watch, start_s = Watch(), time.monotonic()
    try:
        with source as frames:
            for frame in frames:
                if stopping.is_set():
                    break
                hole = frame.gap or watch.look(frame.image, frame.time_s)
                records: list[Record] = []
                if hole is not None:
                    records += pipeline.interrupt(hole, frame.time_s, frame.index)
                records += pipeline.process(frame.image, frame.time_s, frame.index)
                practice.show(frame.image, records)
                if is_paced:
                    stopping.wait(max(0.0, frame.time_s - (time.monotonic() - start_s)))
    except InputError as error:
        report(str(error))
        return ExitStatus.SOME_FAILED
    return ExitStatus.OK


def _run_live(
    source: Any,
    settings: DecodeSettings,
    pipeline: Pipeline,
    practice: Guide,
    stopping: Stopping,
    report: Report,
) -> ExitStatus:
    """The newest picture of a stream, again and again; SOME_FAILED where it gave none."""
    mailbox, clock = Mailbox(), make_clock()
    reader = Reader(source, mailbox, clock, report, give_up_s=settings.give_up or GIVE_UP_S)
    loop = LiveLoop(source.name, mailbox, pipeline, [], clock=clock, report=report, listeners=[practice])
    reader.start()
    try:
        loop.run(stopping)
    finally:
        reader.stop()
    return ExitStatus.SOME_FAILED if reader.has_given_up or not loop.processed else ExitStatus.OK


def _close(
    content: dict[str, Any],
    settings: DecodeSettings,
    plan: Plan,
    tell: Callable[[str], None],
    is_whole: bool,
) -> None:
    """Write the files and print the summary. is_whole: it was not broken off; else it is no result of the study."""
    is_result = plan.is_study and plan.person is not None and is_whole
    if is_result and plan.person is not None:
        path = person_file(plan.folder, plan.person)
    else:
        path = Path(plan.folder) / f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}.json"
    _write(path, json.dumps(content, indent=1) + "\n")
    from lightgesture.practice.picture import summary_page
    from lightgesture.signs.sheet import write_pages

    names = [str(path), *write_pages([summary_page(content)], str(path.with_suffix(".png")))]
    for line in tell_summary(content):
        tell(line)
    if is_result:
        rows = tabulate(read_people(plan.folder))
        table = Path(plan.folder) / TABLE
        _write(table, to_csv(rows))
        names.append(str(table))
        tell("Mean mistakes before success, all people so far:")
        for line in tell_table(rows):
            tell(line)
    tell(f"written: {', '.join(names)}")
    if settings.as_json:
        print_line(json.dumps(content))


def _write(path: Path, text: str) -> None:
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
