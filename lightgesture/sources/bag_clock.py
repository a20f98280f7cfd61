"""One clock for a bag: the stamps in the headers of its messages, or the times at which they were recorded."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from lightgesture.sources.bag_messages import NANOSECONDS

LOOKED_AT: Final = 10
"""Messages at the start of a topic by which its clock is chosen."""

JUMP_NS: Final = 10 * NANOSECONDS
"""How much further than the recording a stamp may get on from one message to the next before it counts as a clock that
was set; a simulation may well get on slower, but hardly faster by so much."""


def has_stamps(stamps_ns: Sequence[int]) -> bool:
    """Whether the headers have a clock, by the stamps of the first messages: most are there and get on."""
    there = [stamp for stamp in stamps_ns if stamp > 0]
    steps = [after - before for before, after in pairwise(there)]
    return 2 * len(there) > len(stamps_ns) and 2 * sum(step > 0 for step in steps) > len(steps)


class BagClock:
    """Nanoseconds of message after message since the first, never less than before.

    by_header: the clock is that of the headers; where a message has no stamp, or one from a clock that was set, the
    time goes on by that of the recording.
    """

    def __init__(self, by_header: bool) -> None:
        self._by_header = by_header
        self._time_ns = self._start_ns = self._recorded_ns = 0

    def start(self, stamp_ns: int, recorded_ns: int) -> None:
        """Begin at a message; what `read` takes. Without it the clock begins at 0."""
        self._start_ns = stamp_ns if self._by_header else recorded_ns
        self._recorded_ns = recorded_ns

    def read(self, stamp_ns: int, recorded_ns: int) -> int:
        """The time of the next message; stamp_ns: 0 where it has none."""
        step_ns = max(0, recorded_ns - self._recorded_ns)
        self._recorded_ns = recorded_ns
        self._time_ns = self._next(stamp_ns if self._by_header else recorded_ns, step_ns)
        return self._time_ns

    def _next(self, stamp_ns: int, step_ns: int) -> int:
        if stamp_ns <= 0:
            return self._time_ns + step_ns
        time_ns = stamp_ns - self._start_ns
        if self._time_ns - NANOSECONDS < time_ns <= self._time_ns + step_ns + JUMP_NS:
            return max(time_ns, self._time_ns)  # some drivers swap neighbours
        self._start_ns = stamp_ns - self._time_ns - step_ns
        return self._time_ns + step_ns
