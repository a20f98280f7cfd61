"""Waiting longer after each failure in a row, for what is tried again until it works."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class BackoffSettings:
    """How long to wait before something that failed is tried again.

    first_s: seconds before the first new try, above 0; smaller ones find a peer that is back sooner and knock more
    often. factor: by what the wait grows after each failure in a row, at least 1. longest_s: seconds that it never
    exceeds, at least `first_s`; it is also how late a peer that was away for long is found again.
    """

    first_s: float = 0.5
    factor: float = 2.0
    longest_s: float = 10.0


class Backoff:
    """The next wait, which grows until something worked."""

    def __init__(self, settings: BackoffSettings) -> None:
        self._settings = settings
        self._wait_s = settings.first_s

    def next_wait(self) -> float:
        """Seconds to wait after one more failure."""
        wait_s = self._wait_s
        self._wait_s = min(wait_s * self._settings.factor, self._settings.longest_s)
        return wait_s

    def reset(self) -> None:
        """It worked: the next wait is the first one again."""
        self._wait_s = self._settings.first_s
