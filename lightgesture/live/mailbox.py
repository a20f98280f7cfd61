"""A box with one slot between the thread that reads and the one that decodes."""

import threading
from dataclasses import dataclass

from lightgesture.sources import Content


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
