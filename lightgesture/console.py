"""Standard output and standard error of the command line, and progress bars.

Messages go through the standard library's `logging`, under the name `lightgesture`: the command line writes them to
standard error, other programs get them wherever their own logging goes.
"""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from typing import IO, Any, Final, Self

from lightgesture.errors import UsageError

MAX_LABEL = 30
"""Longest label of a progress bar, letters."""

LOGGER: Final = logging.getLogger("lightgesture")
"""Takes every message: errors at ERROR, what may be wrong and does not end the work at WARNING, the rest at INFO."""


class ReaderGoneError(Exception):
    """Whoever read the results from standard output has gone, as `head` does when it has enough."""


def one_line(text: str) -> str:
    """The text with everything unprintable escaped: file names may hold line feeds and stray bytes."""
    if text.isprintable():
        return text
    return "".join(
        sign if sign.isprintable() else sign.encode("unicode_escape").decode("ascii") for sign in text
    )


def say(text: str, level: int = logging.INFO) -> None:
    """One message, to whoever hears `lightgesture` in the program's logging."""
    LOGGER.log(level, "%s", one_line(text))


def warn(text: str) -> None:
    """A message of something that may have gone wrong, and did not end the work."""
    say(text, logging.WARNING)


def fail(text: str) -> None:
    """A message of something that went wrong."""
    say(text, logging.ERROR)


class _ToStandardError(logging.Handler):
    """Writes messages to whatever stands for standard error at the time."""

    def emit(self, record: logging.LogRecord) -> None:
        """One line, or none where nobody can read it."""
        with suppress(OSError, ValueError):
            write_message(f"lightgesture: {record.getMessage()}")


@contextmanager
def messages_shown() -> Iterator[None]:
    """Within this block messages from INFO up stand on standard error; within another one it does nothing."""
    if any(isinstance(handler, _ToStandardError) for handler in LOGGER.handlers):
        yield
        return
    handler, level = _ToStandardError(), LOGGER.level
    LOGGER.addHandler(handler)
    LOGGER.setLevel(logging.INFO)
    try:
        yield
    finally:
        LOGGER.removeHandler(handler)
        LOGGER.setLevel(level)


def write_message(line: str) -> None:
    """One line as it stands on standard error."""
    print(line, file=sys.stderr, flush=True)


def print_line(text: str) -> None:
    """One line of results on standard output, at once, so that a reader at the other end is never behind.

    What the stream's encoding lacks is escaped. UsageError: the stream takes no more, as on a full disk.
    ReaderGoneError: nobody reads it any more.
    """
    encoding = sys.stdout.encoding or "utf-8"
    with _output_told():
        print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)


def print_unbuffered(text: str) -> None:
    """One line on standard output, past its buffer, whose lock a blocked thread would hold while the program ends.

    UsageError, ReaderGoneError: as of `print_line`.
    """
    try:
        descriptor = sys.stdout.fileno()
    except (OSError, ValueError):  # something else stands in its place
        print_line(text)
        return
    content = (text + "\n").encode(sys.stdout.encoding or "utf-8", "backslashreplace")
    with _output_told():
        while content:
            content = content[os.write(descriptor, content) :]


@contextmanager
def _output_told() -> Iterator[None]:
    """Tell in our own errors what keeps standard output from taking more."""
    try:
        yield
    except BrokenPipeError as error:
        raise ReaderGoneError from error
    except OSError as error:
        raise UsageError(
            f"standard output: cannot be written ({error.strerror}); send it elsewhere"
        ) from error


class Bars:
    """Several progress bars on standard error at once, where that is a terminal and the user wants them.

    Bars come and go; a line of results or a message is printed in an `away` block, clear of them.
    """

    def __init__(self, quiet: bool) -> None:
        self._is_shown = not quiet and sys.stderr.isatty()
        self._bars: list[Any] = []

    def add(self, label: str, total: int | None, unit: str = "frame") -> Any:
        """A new bar below the others; None where none is shown, which the other methods take too."""
        if not self._is_shown:
            return None
        from tqdm import tqdm

        taken = {-bar.pos for bar in self._bars}
        place = next(number for number in range(len(taken) + 1) if number not in taken)
        bar = tqdm(
            desc=_shortened(one_line(label)),
            total=total,
            unit=unit,
            leave=False,
            file=sys.stderr,
            dynamic_ncols=True,
            position=place,
        )
        self._bars.append(bar)
        return bar

    def advance(self, bar: Any, count: int) -> None:
        """So many frames more."""
        if bar is not None:
            bar.update(count)

    def set_total(self, bar: Any, total: int) -> None:
        """A better estimate of the frames in all."""
        if bar is not None:
            bar.total = max(total, bar.n)

    def remove(self, bar: Any) -> None:
        """Take a bar away."""
        if bar is not None:
            self._bars.remove(bar)
            bar.close()

    def away(self) -> AbstractContextManager[Any]:
        """A block in which both streams of output are clear of bars."""
        return self._bars[0].external_write_mode(file=sys.stderr) if self._bars else nullcontext()

    def close(self) -> None:
        """Take all away, the lowest first."""
        for bar in reversed(self._bars):
            bar.close()
        self._bars.clear()


class Progress:
    """One progress bar. Lines of results go through its `print_line` and messages through its `say`, clear of it."""

    def __init__(self, label: str, total: int | None, unit: str, quiet: bool) -> None:
        self._bars = Bars(quiet)
        self._bar = self._bars.add(label, total, unit)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self._bars.close()

    def advance(self) -> None:
        """One more is done."""
        self._bars.advance(self._bar, 1)

    def print_line(self, text: str) -> None:
        """One line of results on standard output."""
        with self._bars.away():
            print_line(text)

    def fail(self, text: str) -> None:
        """A message of something that went wrong."""
        with self._bars.away():
            fail(text)


@contextmanager
def native_messages_muted() -> Iterator[None]:
    """Keep what FFmpeg, libpng, LiteRT and their like print by themselves off standard error.

    They write to file descriptor 2 behind Python's back, and every one of their complaints comes back as
    a failed call that is reported in one clear line anyway. Within this block `sys.stderr` has the
    terminal for itself. Where `sys.stderr` is not that descriptor (a notebook, a test), nothing is done.
    """
    original = sys.stderr
    if not _is_descriptor(original, 2):
        yield
        return
    original.flush()
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)
    sys.stderr = open(  # noqa: SIM115 - closed below, together with `kept`
        kept, "w", encoding=original.encoding, errors="backslashreplace", buffering=1
    )
    try:
        yield
    finally:
        muted, sys.stderr = sys.stderr, original
        muted.flush()
        os.dup2(kept, 2)
        muted.close()


def _shortened(label: str) -> str:
    """The end of a long name: a bar beside the whole of it would have no room."""
    return label if len(label) <= MAX_LABEL else "..." + label[3 - MAX_LABEL :]


def drop_output() -> None:
    """Send standard output nowhere, after its reader has gone: else Python complains at exit."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _is_descriptor(stream: IO[str] | None, number: int) -> bool:
    try:
        return stream is not None and stream.fileno() == number
    except (OSError, ValueError, AttributeError):
        return False
