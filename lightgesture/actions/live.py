"""What `live` does: the parts put together, run until the end, and taken apart in order."""

import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime, timedelta
from typing import Final

from lightgesture.config.opening import make_debug_pictures, open_stream
from lightgesture.config.settings import DecodeSettings
from lightgesture.console import print_unbuffered, say
from lightgesture.errors import ExitStatus
from lightgesture.interruption import Stopping, stop_signals
from lightgesture.live import Listener, LiveLoop, Mailbox, Reader, Report
from lightgesture.live.loop import HEARTBEAT_S
from lightgesture.results import JsonPrinter, TextPrinter
from lightgesture.sinks import Outbox, Sink, make_sinks
from lightgesture.sinks.printer import PrinterSink
from lightgesture.sources import live_source, refuse_missing_device

DEBUG_STEM = "live"
"""Folder of the pictures of the stages, for an address makes no name."""


HOLD_S: Final = 0.5
"""Seconds for which a sign is held, unless the user or a grammar of the user's says otherwise."""


def run_live(
    source_name: str,
    settings: DecodeSettings,
    listeners: Sequence[Listener] = (),
    heartbeat_s: float = HEARTBEAT_S,
) -> ExitStatus:
    """Decode a stream until it ends for good, nobody takes the records any more, or a signal asks for the end.

    OK, also after SIGTERM, for a service that is asked to stop has not failed; INTERRUPTED after Ctrl-C; SOME_FAILED
    if the reader of standard output went away and nobody else takes the records, the stream was given up, or not one
    picture could be decoded.
    UsageError: the source, an option, the model or the grammar is wrong.
    """
    refuse_missing_device(source_name)
    source = live_source(source_name, settings.source_options)
    sinks = [_make_printer(settings, source.name), *make_sinks(settings)]
    debug = make_debug_pictures(settings, DEBUG_STEM)
    report = _make_report()
    clock = _make_clock()
    mailbox = Mailbox()
    pipeline = open_stream(_for_pipeline(settings), source.name, debug, report)
    with ExitStack() as stack:
        listeners = [*listeners, *_serving(settings, stack, report)]
        stopping = stack.enter_context(stop_signals())
        outboxes = [Outbox(sink, report) for sink in sinks]
        reader = Reader(source, mailbox, clock, report, give_up_s=settings.give_up)
        parts: list[Outbox | Reader] = [*outboxes, reader]
        for part in parts:
            part.start()
            stack.callback(part.stop)
        loop = LiveLoop(
            source.name,
            mailbox,
            pipeline,
            outboxes,
            clock=clock,
            report=report,
            listeners=listeners,
            frames=settings.frames,
            debug=debug,
            heartbeat_s=heartbeat_s,
            start_utc=datetime.now(UTC) - timedelta(seconds=clock()),
        )
        loop.run(stopping)
    if not settings.quiet:
        say(f"{source.name}: {loop.processed} pictures decoded, {mailbox.dropped} passed over for newer ones")
    return ExitStatus.SOME_FAILED if reader.has_given_up else _status(loop, outboxes, stopping)


def _for_pipeline(settings: DecodeSettings) -> DecodeSettings:
    """With frame records, for listeners draw the hands whether the sinks get them or not; and with a hold by time, for
    a stream has no steady rate: unless the user chose another, or brings a grammar with a dwell of its own."""
    changes: dict[str, object] = {"frames": True}
    given = settings.rule, settings.hold, settings.hold_seconds, settings.grammar
    if settings.front_end == "hands" and given == (None, None, None, None):
        changes["hold_seconds"] = HOLD_S
    return settings.model_copy(update=changes)


def _serving(settings: DecodeSettings, stack: ExitStack, report: Report) -> list[Listener]:
    """The page, where the user wants one, served until the stack ends."""
    if settings.web is None:
        return []
    from lightgesture.web import WebListener

    page = stack.enter_context(WebListener(settings.web, settings.web_host))
    if not settings.quiet:
        report(f"the page is at {page.address}")
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


def _make_clock() -> Callable[[], float]:
    """Seconds since now, to the microsecond."""
    start_s = time.monotonic()
    return lambda: round(time.monotonic() - start_s, 6)


def _make_report() -> Report:
    """Messages on standard error, one at a time, whichever thread they are from."""
    lock = threading.Lock()

    def report(text: str) -> None:
        with lock:
            say(text)

    return report
