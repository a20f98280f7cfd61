"""Seconds since the start of a recording, from its time stamps."""

from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Final

JUMP_S: Final = 1.0
"""A stamp this much before the last one, seconds, is another beginning and no frame out of order."""

FIRST_YEAR: Final = 1980
"""Clocks that were never set say 1904 or 1970."""


class RecordingClock:
    """Makes seconds since `start_s` of stamps that may be missing or jump back.

    start_s: the stamp of the start; None: the first one. period_s: of a frame, for frames without a stamp.
    After a jump back time goes on from the last frame, and stamps count from there: `jump_s` tells how far it was, 0
    for the frames between.
    """

    def __init__(self, start_s: float | None, period_s: float) -> None:
        self._start_s, self._period_s = start_s, period_s
        self._time_s: float | None = None
        self.jump_s = 0.0

    def read(self, stamp_s: float | None, steps: int = 1) -> float:
        """The time of the next frame, at least 0, to the microsecond; steps: frames since the last one."""
        self.jump_s = 0.0
        expected_s = 0.0 if self._time_s is None else self._time_s + steps * self._period_s
        if stamp_s is None:
            time_s = expected_s
        else:
            if self._start_s is None or (self._time_s is None and stamp_s < self._start_s):
                self._start_s = stamp_s
            time_s = stamp_s - self._start_s
            if self._time_s is not None and time_s < self._time_s - JUMP_S:
                self.jump_s = self._time_s - time_s
                self._start_s = stamp_s - expected_s
                time_s = expected_s
        # Microseconds are finer than any container's clock and hide the rounding of the division.
        self._time_s = max(0.0, round(time_s, 6))
        return self._time_s


def creation_time(metadata: Mapping[str, str]) -> datetime | None:
    """When a recording began by its container, UTC; None where that is not told, or by a clock that was never set."""
    text = next((value for key, value in metadata.items() if key.lower() == "creation_time"), None)
    if text is None:
        return None
    try:
        moment = datetime.fromisoformat(text.strip())
    except ValueError:
        return None
    moment = moment.replace(tzinfo=UTC) if moment.tzinfo is None else moment.astimezone(UTC)
    return moment if moment.year >= FIRST_YEAR else None
