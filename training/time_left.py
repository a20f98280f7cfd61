"""How long a training still takes, told from what it has done so far."""

import time
from collections.abc import Callable

MINUTE_S = 60.0
HOUR_S = 3600.0
UNKNOWN_S = 30.0
"""Between two lines about a step of unknown length."""


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


def tenths(
    progress: Callable[[str], None], clock: Callable[[], float] = time.monotonic
) -> Callable[[str, int, int], None]:
    """Tells every tenth of a step as a line, with the time left; of a step of unknown length (0), what is done by each
    half a minute."""
    clocks: dict[str, TimeLeft] = {}
    told: dict[str, float] = {}

    def show(step: str, done: int, total: int) -> None:
        if not total:
            now = clock()
            if now - told.setdefault(step, now) >= UNKNOWN_S:
                told[step] = now
                progress(f"{step}: {done} so far")
            return
        left = clocks.setdefault(step, TimeLeft(total, done, clock))
        if done * 10 // total > (done - 1) * 10 // total:
            progress(f"{step}: {done} of {total}, {left.told(done)}")

    return show
