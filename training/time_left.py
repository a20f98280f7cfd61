"""How long a training still takes, told from what it has done so far."""

import threading
import time
from collections.abc import Callable
from typing import Self

MINUTE_S = 60.0
HOUR_S = 3600.0
UNKNOWN_S = 30.0
"""Between two lines about a step of unknown length."""
FIRST_S = 20.0
"""After which a step is told of for the first time, whatever is done of it."""
SILENT_S = 50.0
"""Longest time without a line."""


class TimeLeft:
    """Of work in equal parts, from the pace since it was made."""

    def __init__(self, total: int, done: int = 0, clock: Callable[[], float] = time.monotonic) -> None:
        """total: parts in all. done: those that were there before, which tell nothing of the pace."""
        self._total, self._first, self._clock = total, done, clock
        self._start = clock()

    def told(self, done: int) -> str:
        """Such as "12 min left", from all parts done so far; "done" where none are left."""
        if done >= self._total:
            return "done"
        if done <= self._first:
            return "time left unknown"
        seconds = (self._clock() - self._start) * (self._total - done) / (done - self._first)
        if seconds >= HOUR_S:
            return f"{seconds / HOUR_S:.1f} h left"
        return f"{seconds / MINUTE_S:.0f} min left" if seconds >= MINUTE_S else f"{seconds:.0f} s left"


class Pace:
    """Which parts of a step are told of: every tenth, the first after 20 s at the latest, and one a minute."""

    def __init__(self, total: int, done: int = 0, clock: Callable[[], float] = time.monotonic) -> None:
        """total, done: as of `TimeLeft`."""
        self._total, self._clock = total, clock
        self._left = TimeLeft(total, done, clock)
        self._due_s = clock() + FIRST_S

    def line(self, done: int) -> str | None:
        """The time that is left, where this part is told of."""
        is_tenth = done * 10 // self._total > (done - 1) * 10 // self._total
        if not is_tenth and self._clock() < self._due_s:
            return None
        self._due_s = self._clock() + SILENT_S
        return self._left.told(done)


def tenths(
    progress: Callable[[str], None], clock: Callable[[], float] = time.monotonic
) -> Callable[[str, int, int], None]:
    """Tells the parts of a step that `Pace` chooses as lines, with the time left; of a step of unknown length (0), what
    is done by each half a minute."""
    paces: dict[str, Pace] = {}
    told: dict[str, float] = {}

    def show(step: str, done: int, total: int) -> None:
        if not total:
            now = clock()
            if now - told.setdefault(step, now) >= UNKNOWN_S:
                told[step] = now
                progress(f"{step}: {done} so far")
            return
        pace = paces.setdefault(step, Pace(total, done, clock))
        if (left := pace.line(done)) is not None:
            progress(f"{step}: {done} of {total}, {left}")

    return show


class NeverSilent:
    """Passes lines on, and where none comes for a minute says what is at work still: some steps have no parts.

    Use it in a `with` block and call it with each line.
    """

    def __init__(self, progress: Callable[[str], None], silent_s: float = SILENT_S + FIRST_S / 2) -> None:
        self._progress, self._silent_s = progress, silent_s
        self._lock = threading.Lock()
        self._over = threading.Event()
        self._last = "begins"
        self._last_s = self._told_s = time.monotonic()

    def __enter__(self) -> Self:
        self._thread = threading.Thread(target=self._watch, name="never silent", daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *reason: object) -> None:
        self._over.set()
        self._thread.join()

    def __call__(self, line: str) -> None:
        """A line of progress."""
        with self._lock:
            self._last = line
            self._last_s = self._told_s = time.monotonic()
            self._progress(line)

    def _watch(self) -> None:
        while not self._over.wait(self._silent_s / 10):
            with self._lock:
                now = time.monotonic()
                if now - self._told_s >= self._silent_s:
                    self._told_s = now
                    self._progress(f"still at work, {_length(now - self._last_s)} after: {self._last}")


def _length(seconds: float) -> str:
    return f"{seconds / MINUTE_S:.0f} min" if seconds >= 1.5 * MINUTE_S else f"{seconds:.0f} s"
