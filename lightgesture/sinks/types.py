"""What every sink offers, and how it tells that something went wrong."""

from typing import Protocol

from lightgesture.records import Record


class SinkError(Exception):
    """The way out is blocked: open the sink again and repeat the record. The text: what, why, in one line."""


class RecordError(Exception):
    """This record cannot be sent and must not be repeated; the next one may do. The text: what, why, in one line."""


class SinkGoneError(Exception):
    """Nobody takes the records of this sink any more."""


class Sink(Protocol):
    """Takes records, in order; all calls come from one thread and may take their time.

    name: for messages. keeps_old: whether a record that waited for long is still of use, as in a log. To a vehicle
    it is not: an instruction that arrives late may meet another situation.
    """

    name: str
    keeps_old: bool

    def wants(self, record: Record) -> bool:
        """Whether to send the record at all; called from any thread, quick."""
        ...

    def open(self) -> None:
        """Make ready to send, also again after an error. SinkError: it cannot be."""
        ...

    def send(self, record: Record) -> None:
        """Send one record. SinkError, RecordError, SinkGoneError: as they say."""
        ...

    def close(self) -> None:
        """Give back what `open` took; also after a failed `open`, and twice."""
        ...
