"""The thread that reads a stream into the mailbox and opens it again when it breaks off."""

import threading
from collections.abc import Callable

from lightgesture.backoff import Backoff
from lightgesture.errors import InputError
from lightgesture.live.mailbox import Mailbox, Snapshot
from lightgesture.live.settings import LiveSettings
from lightgesture.sources import LiveSource

Report = Callable[[str], None]
"""Takes one message for the user, from any thread."""


class Reader:
    """Reads `source` in a thread of its own, from `start` until `stop`.

    Each picture is stamped with `clock()` (seconds) as it comes. A stream that cannot be opened, breaks off or ends is
    reported once and opened again with growing waits; one that cannot be opened again, such as standard input, closes
    the mailbox when it ends.
    """

    def __init__(
        self,
        source: LiveSource,
        mailbox: Mailbox,
        clock: Callable[[], float],
        report: Report,
        settings: LiveSettings,
    ) -> None:
        self._source, self._mailbox, self._clock, self._report = source, mailbox, clock, report
        self._backoff = Backoff(settings.reconnect)
        self._stop_s = settings.stop_s
        self._stopping = threading.Event()
        self._index = 0
        self._is_broken = False
        # A daemon, for a driver or a pipe that never answers must not keep the program from ending.
        self._thread = threading.Thread(target=self._run, name="reader", daemon=True)

    def start(self) -> None:
        """Begin to read."""
        self._thread.start()

    def stop(self) -> None:
        """Ask the thread to end and wait for it for a while."""
        self._stopping.set()
        self._thread.join(self._stop_s)

    def _run(self) -> None:
        try:
            while not self._stopping.is_set():
                reason = self._read_once()
                if not self._source.is_reopened:
                    if reason is not None:
                        self._report(reason)
                    break
                self._wait(reason or f"{self._source.name}: the stream ended")
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
        if not self._is_broken:
            self._is_broken = True
            self._report(f"{reason}; trying again until it works")
        self._stopping.wait(self._backoff.next_wait())
