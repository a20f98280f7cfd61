"""Waiting longer after each failure in a row, for what is tried again until it works."""

from typing import Final

FACTOR: Final = 2.0
"""By what the wait grows after each failure in a row."""


class Backoff:
    """The next wait, which grows until something worked.

    first_s: seconds before the first new try, above 0; smaller ones find a peer that is back sooner and knock more
    often. longest_s: seconds that the wait never exceeds; it is also how late a peer that was away for long is found
    again.
    """

    def __init__(self, first_s: float = 0.5, longest_s: float = 10.0) -> None:
        self._first_s, self._longest_s = first_s, longest_s
        self._wait_s = first_s

    def next_wait(self) -> float:
        """Seconds to wait after one more failure."""
        wait_s = self._wait_s
        self._wait_s = min(wait_s * FACTOR, self._longest_s)
        return wait_s

    def reset(self) -> None:
        """It worked: the next wait is the first one again."""
        self._wait_s = self._first_s
