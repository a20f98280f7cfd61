"""Records on standard output, as JSON Lines or in plain words."""

import os
import sys

from lightgesture.console import ReaderGoneError, print_line
from lightgesture.errors import UsageError
from lightgesture.records import Record
from lightgesture.results import Writer
from lightgesture.sinks.outbox import Sink, SinkError, SinkGoneError


class PrinterSink(Sink):
    """Gives the records to a printer; a reader that has gone is told by SinkGoneError."""

    def __init__(self, printer: Writer) -> None:
        self.name = "standard output"
        self.keeps_old = True
        self._printer = printer

    def send(self, record: Record) -> None:
        """Print one record."""
        try:
            self._printer.write(record)
        except (ReaderGoneError, BrokenPipeError):
            raise SinkGoneError from None
        except UsageError as error:  # a full disk, which may be emptied
            raise SinkError(str(error)) from None


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
    try:
        while content:
            content = content[os.write(descriptor, content) :]
    except BrokenPipeError as error:
        raise ReaderGoneError from error
    except OSError as error:
        raise UsageError(
            f"standard output: cannot be written ({error.strerror}); send it elsewhere"
        ) from error
