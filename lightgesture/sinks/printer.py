"""Records on standard output, as JSON Lines or in plain words."""

from lightgesture.console import ReaderGoneError
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
