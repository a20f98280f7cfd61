"""Ctrl-C and SIGTERM: what a user presses and what a service manager sends end a run alike, and cleanly."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def terminated_as_interrupted() -> Iterator[None]:
    """Within this block the first SIGTERM raises KeyboardInterrupt, so that every clean-up runs; later ones do nothing.

    Outside the main thread, where Python takes no signals, nothing is changed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before if before is not None else signal.SIG_DFL)


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the shape of a handler
    # A second signal must not break off the clean-up after the first.
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise KeyboardInterrupt


class Stopping(threading.Event):
    """Set once the end was asked for; `is_interrupted`: by Ctrl-C."""

    def __init__(self) -> None:
        super().__init__()
        self.is_interrupted = False


@contextmanager
def stop_signals() -> Iterator[Stopping]:
    """Within this block SIGINT and SIGTERM set the flag; a second SIGINT interrupts at once, as everywhere.

    Only the main thread can have this; in another one the flag is set by nobody but the caller.
    """
    stopping = Stopping()

    def note(number: int, _frame: FrameType | None) -> None:
        stopping.is_interrupted = number == signal.SIGINT
        stopping.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    if threading.current_thread() is not threading.main_thread():
        yield stopping
        return
    kept = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stopping
    finally:
        for number, handler in kept.items():
            signal.signal(number, handler)
