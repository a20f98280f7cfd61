"""Time stamps made to run forwards."""

import math


class Timeline:
    """Seconds that never run back, whatever stamps come in: a loop or a reset of the source adds nothing.

    now_s: the time so far. time_s: the last stamp that was finite.
    """

    __slots__ = ("_offset_s", "now_s", "time_s")

    def __init__(self) -> None:
        self.now_s = 0.0
        self.time_s = 0.0
        self._offset_s = 0.0

    def advance(self, time_s: float) -> float:
        """The time after a frame stamped `time_s`: stands still where a stamp runs back or is not finite."""
        now_s = time_s + self._offset_s
        if self.now_s <= now_s < math.inf:  # never true of a stamp that is no number
            self.now_s = now_s
            self.time_s = time_s
        elif math.isfinite(time_s):
            self._offset_s = self.now_s - time_s
            self.time_s = time_s
        return self.now_s
