"""The thread that reads a stream and opens it again when it breaks off, and the box with one slot where it leaves
each picture for the thread that decodes."""

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from lightgesture.backoff import Backoff
from lightgesture.errors import InputError
from lightgesture.sources import Content, LiveSource

Report = Callable[[str], None]
"""Takes one message for the user, from any thread."""

STOP_S: Final = 1.0
"""Seconds that the end waits for the thread that reads; a camera driver that does not return is left to the system."""


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """A picture as it came, perhaps still encoded; `index` counts all that came, also those passed over.

    time_s: seconds of the loop's clock when it came.
    """

    content: Content
    index: int
    time_s: float


class Mailbox:
    """Holds the newest snapshot only: a newer one takes the place of one that nobody took, which counts as dropped."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._newest: Snapshot | None = None
        self._failure: BaseException | None = None
        self._is_closed = False
        self._dropped = 0

    @property
    def dropped(self) -> int:
        """How many snapshots were replaced before anybody took them."""
        return self._dropped

    @property
    def is_closed(self) -> bool:
        """Whether nothing more comes and nothing is left."""
        with self._changed:
            return self._is_closed and self._newest is None

    @property
    def is_empty(self) -> bool:
        """Whether the last snapshot was taken."""
        return self._newest is None

    def put(self, snapshot: Snapshot) -> None:
        """Leave a snapshot, at once."""
        with self._changed:
            self._dropped += self._newest is not None
            self._newest = snapshot
            self._changed.notify()

    def take(self, timeout_s: float) -> Snapshot | None:
        """The newest snapshot, None where none came in time or none comes any more.

        Raises what the thread that reads failed with, if that was no fault of the stream.
        """
        with self._changed:
            if self._newest is None and not self._is_closed:
                self._changed.wait(timeout_s)
            if self._failure is not None:
                raise self._failure
            snapshot, self._newest = self._newest, None
            return snapshot

    def close(self, failure: BaseException | None = None) -> None:
        """Nothing more comes; `failure`: why, where that was no fault of the stream."""
        with self._changed:
            self._is_closed, self._failure = True, failure
            self._changed.notify()


class Reader:
    """Reads `source` in a thread of its own, from `start` until `stop`.

    Each picture is stamped with `clock()` (seconds) as it comes. A stream that cannot be opened, breaks off or ends is
    reported once and opened again with growing waits; one that cannot be opened again, such as standard input, closes
    the mailbox when it ends. backoff: waits between tries to open the source again. give_up_s: seconds
    without a picture after which it is not opened again, and `has_given_up`; None: never.
    """

    def __init__(
        self,
        source: LiveSource,
        mailbox: Mailbox,
        clock: Callable[[], float],
        report: Report,
        backoff: Backoff | None = None,
        give_up_s: float | None = None,
    ) -> None:
        self._source, self._mailbox, self._clock, self._report = source, mailbox, clock, report
        self._give_up_s = math.inf if give_up_s is None else give_up_s
        self._seen_s = 0.0
        self.has_given_up = False
        self._backoff = backoff or Backoff()
        self._stopping = threading.Event()
        self._index = 0
        self._is_broken = False
        # A daemon, for a driver or a pipe that never answers must not keep the program from ending.
        self._thread = threading.Thread(target=self._run, name="reader", daemon=True)

    def start(self) -> None:
        """Begin to read."""
        self._seen_s = time.monotonic()
        self._thread.start()

    def stop(self) -> None:
        """Ask the thread to end and wait for it for a while."""
        self._stopping.set()
        self._thread.join(STOP_S)

    def _run(self) -> None:
        try:
            while not self._stopping.is_set():
                reason = self._read_once()
                if not self._source.is_reopened:
                    if reason is not None:
                        self._report(reason)
                    break
                self._wait(reason or f"{self._source.name}: the stream ended")
                if time.monotonic() - self._seen_s >= self._give_up_s:
                    self.has_given_up = True
                    self._report(f"{self._source.name}: no picture for {self._give_up_s:g} s; given up")
                    break
        except BaseException as error:  # the thread that decodes shall end by it too
            self._mailbox.close(error)
        else:
            self._mailbox.close()

    def _read_once(self) -> str | None:
        """Read until the stream breaks off, and say why; None where it ended."""
        try:
            with self._source as stream:
                for content in stream:
                    if self._stopping.is_set():
                        break
                    self._seen_s = time.monotonic()
                    self._mailbox.put(Snapshot(content, self._index, self._clock()))
                    self._index += 1
                    self._note_success()
        except InputError as error:
            return str(error)
        return None

    def _note_success(self) -> None:
        self._backoff.reset()
        if self._is_broken:
            self._is_broken = False
            self._report(f"{self._source.name}: pictures again")

    def _wait(self, reason: str) -> None:
        if self._stopping.is_set():
            return
        left_s = self._give_up_s - (time.monotonic() - self._seen_s)
        if not self._is_broken:
            self._is_broken = True
            until = "until it works" if left_s == math.inf else f"for {max(0.0, left_s):.0f} s"
            self._report(f"{reason}; trying again {until}")
        self._stopping.wait(max(0.0, min(self._backoff.next_wait(), left_s)))
