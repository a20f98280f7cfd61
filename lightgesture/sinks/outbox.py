"""What every sink offers, how it tells that something went wrong, and the bounded queue and thread before each."""

import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from typing import Final

from lightgesture.backoff import Backoff
from lightgesture.records import Record

CAPACITY: Final = 256
"""Records in the queue; where one more comes, the oldest is dropped."""

MAX_AGE_S: Final = 5.0
"""Seconds after which a waiting record is dropped, except for sinks that keep old ones: longer gets more through a link
that breaks, and lets an instruction arrive later than it was signed."""

DRAIN_S: Final = 2.0
"""Seconds that the end waits for what is still queued."""

LONGEST_RETRY_S: Final = 30.0
"""Longest wait between tries to open the sink again, seconds."""


class SinkError(Exception):
    """The way out is blocked: open the sink again and repeat the record. The text: what, why, in one line."""


class RecordError(Exception):
    """This record cannot be sent and must not be repeated; the next one may do. The text: what, why, in one line."""


class SinkGoneError(Exception):
    """Nobody takes the records of this sink any more."""


class Sink(ABC):
    """Takes records, in order; all calls come from one thread and may take their time."""

    name: str
    """For messages."""

    keeps_old = False
    """Whether a record that waited for long is still of use, as in a log. To a vehicle it is not: an instruction that
    arrives late may meet another situation."""

    poll_s: float | None = None
    """Seconds from one call of `poll` to the next while no record waits; None: it is not called."""

    def wants(self, record: Record) -> bool:  # noqa: ARG002 - all of them
        """Whether to send the record at all; called from any thread, quick."""
        return True

    def open(self) -> None:  # noqa: B027 - some need nothing
        """Make ready to send, also again after an error. SinkError: it cannot be."""

    @abstractmethod
    def send(self, record: Record) -> None:
        """Send one record. SinkError, RecordError, SinkGoneError: as they say."""

    def poll(self) -> None:  # noqa: B027 - likewise
        """Do what time brings, such as reading an answer. SinkError: as it says."""

    def close(self) -> None:  # noqa: B027 - likewise
        """Give back what `open` took; also after a failed `open`, and twice."""


class _Idle:
    """Nothing came to be sent."""


class Outbox:
    """Sends records to `sink` from a thread of its own, from `start` until `stop`.

    A sink that fails is reported once, until it has worked again, and opened again with growing waits.
    """

    def __init__(self, sink: Sink, report: Callable[[str], None], backoff: Backoff | None = None) -> None:
        self._sink, self._report = sink, report
        self._changed = threading.Condition()
        self._queue: deque[tuple[float, Record]] = deque()
        self._is_stopping = self._is_gone = self._is_failing = False
        self._dropped = 0
        self._backoff = backoff or Backoff(longest_s=LONGEST_RETRY_S)
        # A daemon, for a pipe that nobody empties must not keep the program from ending.
        self._thread = threading.Thread(target=self._run, name=sink.name, daemon=True)

    @property
    def is_gone(self) -> bool:
        """Whether nobody takes the records any more."""
        return self._is_gone

    @property
    def waiting(self) -> int:
        """Records that are queued."""
        return len(self._queue)

    def start(self) -> None:
        """Open the sink and begin to send."""
        self._thread.start()

    def put(self, record: Record) -> None:
        """Queue a record, if the sink wants it, at once."""
        if not self._sink.wants(record):
            return
        with self._changed:
            if self._is_gone:
                return
            if len(self._queue) == CAPACITY:
                self._queue.popleft()
                self._dropped += 1
            self._queue.append((time.monotonic(), record))
            self._changed.notify()

    def stop(self) -> None:
        """Send what is queued, for a while, and end."""
        with self._changed:
            self._is_stopping = True
            self._changed.notify()
        self._thread.join(DRAIN_S)
        with self._changed:
            self._dropped += len(self._queue)
            self._queue.clear()
        if self._dropped:
            self._report(f"{self._sink.name}: {self._dropped} records were dropped")

    def _run(self) -> None:
        try:
            while self._serve():
                self._wait()
        except SinkGoneError:
            self._note_gone()
        except Exception as error:
            self._report(f"{self._sink.name}: gives up, which is a defect ({type(error).__name__}: {error})")
            self._note_gone()
        finally:
            self._sink.close()

    def _serve(self) -> bool:
        """Open the sink and send until it fails; False: the end was reached."""
        try:
            self._sink.open()
            while (item := self._next()) is not None:
                if isinstance(item, _Idle):
                    self._sink.poll()
                else:
                    self._send(item)
        except SinkError as error:
            self._sink.close()
            self._note_failure(f"{error}; trying again until it works")
            # At the end there is one try more, not a wait for better times.
            return not self._is_stopping
        return False

    def _next(self) -> "tuple[float, Record] | _Idle | None":
        """The oldest record that is still of use, once there is one; _Idle: none for `poll_s`; None: the end."""
        with self._changed:
            while True:
                while self._queue and self._is_too_old(self._queue[0][0]):
                    self._queue.popleft()
                    self._dropped += 1
                if self._queue:
                    return self._queue.popleft()
                if self._is_stopping:
                    return None
                if not self._changed.wait(self._sink.poll_s):
                    return _Idle()

    def _send(self, item: tuple[float, Record]) -> None:
        try:
            self._sink.send(item[1])
        except SinkError:
            with self._changed:  # to be repeated, first of all
                self._queue.appendleft(item)
            raise
        except RecordError as error:
            self._note_failure(str(error))
        else:
            self._backoff.reset()
            if self._is_failing:
                self._is_failing = False
                self._report(f"{self._sink.name}: works again")

    def _is_too_old(self, queued_s: float) -> bool:
        return not self._sink.keeps_old and time.monotonic() - queued_s > MAX_AGE_S

    def _wait(self) -> None:
        deadline_s = time.monotonic() + self._backoff.next_wait()
        with self._changed:
            while not self._is_stopping and (left_s := deadline_s - time.monotonic()) > 0:
                self._changed.wait(left_s)

    def _note_failure(self, reason: str) -> None:
        if not self._is_failing:
            self._is_failing = True
            self._report(reason)

    def _note_gone(self) -> None:
        with self._changed:
            self._is_gone = True
            self._queue.clear()
