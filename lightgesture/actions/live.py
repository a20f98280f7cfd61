"""What `live` does: the parts put together, run until the end, and taken apart in order."""

import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

from lightgesture.config.opening import make_debug_pictures, open_stream
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import print_unbuffered, say
from lightgesture.errors import ExitStatus
from lightgesture.hints import Hints
from lightgesture.interruption import Stopping, stop_signals
from lightgesture.live import Listener, LiveLoop, Mailbox, Reader, Report
from lightgesture.live.loop import HEARTBEAT_S
from lightgesture.pipeline import Pipeline
from lightgesture.records import VehicleRecord
from lightgesture.results import JsonPrinter, TextPrinter
from lightgesture.results.overlay import Overlay
from lightgesture.sinks import Outbox, Sink, make_answers, make_sinks
from lightgesture.sinks.printer import PrinterSink
from lightgesture.sources import LiveSource, live_source, refuse_missing_device

if TYPE_CHECKING:
    from lightgesture.vehicle.runner import Runner

DEBUG_STEM = "live"
"""Folder of the pictures of the stages, for an address makes no name."""


def run_live(
    source: str | LiveSource,
    settings: DecodeSettings,
    listeners: Sequence[Listener] = (),
    heartbeat_s: float = HEARTBEAT_S,
    clock: Callable[[], float] | None = None,
) -> ExitStatus:
    """Decode a stream, by its name or as it stands, until it ends for good, nobody takes the records any more, or a
    signal asks for the end.

    clock: seconds since the start, which never run back, for a stream whose pictures come faster or slower than they
    were taken; None: the computer's.
    OK, also after SIGTERM, for a service that is asked to stop has not failed; INTERRUPTED after Ctrl-C; SOME_FAILED
    if the reader of standard output went away and nobody else takes the records, the stream was given up, or not one
    picture could be decoded.
    UsageError: the source, an option, the model or the grammar is wrong.
    """
    if isinstance(source, str):
        refuse_missing_device(source)
        source = live_source(source, settings.source_options)
    report = make_report()
    clock = clock or make_clock()

    def tell(record: VehicleRecord) -> None:
        loop.tell(record)

    sinks = [_make_printer(settings, source.name), *make_sinks(settings, tell, clock)]
    debug = make_debug_pictures(settings, DEBUG_STEM, report)
    mailbox = Mailbox()
    pipeline = open_stream(for_stream(settings), source.name, debug, report)
    with ExitStack() as stack:
        stopping = stack.enter_context(stop_signals())
        runner = _obeying(settings, tell, report, clock, stopping)
        outboxes = [Outbox(sink, report) for sink in (*sinks, *make_answers(settings, runner))]
        loop = LiveLoop(
            source.name,
            mailbox,
            pipeline,
            outboxes,
            clock=clock,
            report=report,
            listeners=[*listeners, *_serving(settings, stack, report, pipeline), *filter(None, [runner])],
            frames=settings.frames,
            debug=debug,
            heartbeat_s=heartbeat_s,
            start_utc=datetime.now(UTC) - timedelta(seconds=clock()),
            hints=None if settings.quiet else Hints(pipeline, settings.mirrored, settings.rotate),
        )
        reader = Reader(source, mailbox, clock, report, give_up_s=settings.give_up)
        # The last is ended first: a vehicle must not wait for what a sink still has to send.
        parts: list[Outbox | Reader | Runner] = [*outboxes, reader, *filter(None, [runner])]
        for part in parts:
            part.start()
            stack.callback(part.stop)
        loop.run(stopping)
    if not settings.quiet:
        say(f"{source.name}: {loop.processed} pictures decoded, {mailbox.dropped} passed over for newer ones")
    return ExitStatus.SOME_FAILED if reader.has_given_up else _status(loop, outboxes, stopping)


def for_stream(settings: DecodeSettings) -> DecodeSettings:
    """With frame records: listeners draw the hands whether the sinks get them or not."""
    return settings.model_copy(update={"frames": True})


def _obeying(
    settings: DecodeSettings,
    tell: Callable[[VehicleRecord], None],
    report: Report,
    clock: Callable[[], float],
    stopping: threading.Event,
) -> "Runner | None":
    """What carries the instructions out, where the user wants that."""
    if settings.obey is None:
        return None
    from lightgesture.vehicle.opening import open_runner

    return open_runner(settings, tell, report, clock, stopping)


def _serving(
    settings: DecodeSettings, stack: ExitStack, report: Report, pipeline: Pipeline
) -> list[Listener]:
    """The page, where the user wants one, served until the stack ends."""
    if settings.web is None:
        return []
    from lightgesture.web import WebListener

    draw = Overlay("below", settings.rotate).draw
    obeys, is_extension = settings.obey is not None, settings.web_blueos
    grammar = pipeline.decoder.grammar
    page = stack.enter_context(
        WebListener(
            settings.web,
            settings.web_host,
            draw,
            grammar,
            obeys=obeys,
            is_extension=is_extension,
            token=settings.web_token,
        )
    )
    if not settings.quiet:
        report(f"the page is at {page.link()}")
    return [page]


def _status(loop: LiveLoop, outboxes: Sequence[Outbox], stopping: Stopping) -> ExitStatus:
    if stopping.is_interrupted:
        return ExitStatus.INTERRUPTED
    is_unheard = all(outbox.is_gone for outbox in outboxes)
    is_failed = is_unheard or (not stopping.is_set() and not loop.processed)
    return ExitStatus.SOME_FAILED if is_failed else ExitStatus.OK


def _make_printer(settings: DecodeSettings, name: str) -> Sink:
    if settings.as_json:
        return PrinterSink(JsonPrinter(print_unbuffered, sys.stdout.encoding or "utf-8"))
    return PrinterSink(TextPrinter(print_unbuffered, name))


def make_clock() -> Callable[[], float]:
    """Seconds since now, to the microsecond."""
    start_s = time.monotonic()
    return lambda: round(time.monotonic() - start_s, 6)


def make_report() -> Report:
    """Messages on standard error, one at a time, whichever thread they are from."""
    lock = threading.Lock()

    def report(text: str) -> None:
        with lock:
            say(text)

    return report
