"""Time stamps made to run forwards."""


class Timeline:
    """Seconds that never run back, whatever stamps come in: a loop or a reset of the source adds nothing."""

    __slots__ = ("_offset_s", "now_s")

    def __init__(self) -> None:
        self.now_s = 0.0
        self._offset_s = 0.0

    def advance(self, time_s: float) -> float:
        """The time after a frame stamped `time_s` (finite): a stamp that runs back stands still."""
        now_s = time_s + self._offset_s
        if now_s < self.now_s:
            self._offset_s = self.now_s - time_s
        else:
            self.now_s = now_s
        return self.now_s
