"""A bounded queue and a thread before each sink."""

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from lightgesture.backoff import Backoff, BackoffSettings
from lightgesture.records import Record
from lightgesture.sinks.types import RecordError, Sink, SinkError, SinkGoneError


@dataclass(frozen=True, slots=True)
class OutboxSettings:
    """How long records wait for their sink.

    capacity: records in the queue, at least 1; where one more comes, the oldest is dropped. max_age_s: seconds after
    which a waiting record is dropped, above 0, except for sinks that keep old ones: longer gets more through a link
    that breaks, and lets an instruction arrive later than it was signed. drain_s: seconds that the end waits for what
    is still queued. retry: waits between tries to open the sink again.
    """

    capacity: int = 256
    max_age_s: float = 5.0
    drain_s: float = 2.0
    retry: BackoffSettings = field(default_factory=lambda: BackoffSettings(longest_s=30.0))


class Outbox:
    """Sends records to `sink` from a thread of its own, from `start` until `stop`.

    A sink that fails is reported once, until it has worked again, and opened again with growing waits.
    """

    def __init__(
        self, sink: Sink, report: Callable[[str], None], settings: OutboxSettings | None = None
    ) -> None:
        self._sink, self._report, self._settings = sink, report, settings or OutboxSettings()
        self._changed = threading.Condition()
        self._queue: deque[tuple[float, Record]] = deque()
        self._is_stopping = self._is_gone = self._is_failing = False
        self._dropped = 0
        self._backoff = Backoff(self._settings.retry)
        # A daemon, for a pipe that nobody empties must not keep the program from ending.
        self._thread = threading.Thread(target=self._run, name=sink.name, daemon=True)

    @property
    def is_gone(self) -> bool:
        """Whether nobody takes the records any more."""
        return self._is_gone

    @property
    def dropped(self) -> int:
        """Records that were never sent, because the queue was full or they became too old."""
        return self._dropped

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
            if len(self._queue) == self._settings.capacity:
                self._queue.popleft()
                self._dropped += 1
            self._queue.append((time.monotonic(), record))
            self._changed.notify()

    def stop(self) -> None:
        """Send what is queued, for a while, and end."""
        with self._changed:
            self._is_stopping = True
            self._changed.notify()
        self._thread.join(self._settings.drain_s)
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
                self._send(item)
        except SinkError as error:
            self._sink.close()
            self._note_failure(f"{error}; trying again until it works")
            # At the end there is one try more, not a wait for better times.
            return not self._is_stopping
        return False

    def _next(self) -> tuple[float, Record] | None:
        """The oldest record that is still of use, once there is one; None at the end."""
        with self._changed:
            while True:
                while self._queue and self._is_too_old(self._queue[0][0]):
                    self._queue.popleft()
                    self._dropped += 1
                if self._queue:
                    return self._queue.popleft()
                if self._is_stopping:
                    return None
                self._changed.wait()

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
        return not self._sink.keeps_old and time.monotonic() - queued_s > self._settings.max_age_s

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
