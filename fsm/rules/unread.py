"""Signs that were shown and not read.

Hands that pass from one sign to the next are unread for a moment; a sign that nobody could read makes the moment
longer by its own hold. A sentence that went on after it would lack a word: "STOP HOVER 35 GO" without its digits is
another instruction, and a valid one.
"""

from lightgesture.fsm.signs import Shown


class UnreadSigning:
    """Adds up how long hands were seen since the last word without saying one.

    longest: how much of it may be, in the dwell's unit (frames or seconds). passage_s: seconds that it may last in any
    case, so that a short hold leaves the time to go from sign to sign; where time stands still, frames alone tell.
    release: how long a pair must be absent to be another sign when it comes again, in the dwell's unit. What a pair has
    been shown does not count as long as it is there, for it may still become a word; once it is gone for `release`, it
    was a sign that nobody read.
    """

    def __init__(self, longest: float, release: float, passage_s: float) -> None:
        self._longest = longest
        self._passage_s = passage_s
        self._release = release
        self.reset()

    def reset(self) -> None:
        """A word was read: what comes now is new."""
        self._amount = 0.0
        self._seconds = 0.0
        self.pass_over()

    def pass_over(self) -> None:
        """What was shown was long enough, and the diver was told what is wrong with it."""
        self._pair: Shown | None = None
        self._shown = 0.0
        self._shown_s = 0.0
        self._absent = 0.0

    def process(self, pair: Shown | None, step: float, step_s: float) -> bool:
        """Take in a frame in which hands show `pair`; whether a sign has been missed.

        step, step_s: what the frame stands for, in the dwell's unit and in seconds.
        """
        if pair is None or pair != self._pair:
            self._absent += step
            if self._pair is None or self._absent >= self._release:
                self._amount += self._shown
                self._seconds += self._shown_s
                self._pair = pair
                self._shown = self._shown_s = 0.0
        if pair is not None and pair == self._pair:
            self._shown += step
            self._shown_s += step_s
            self._absent = 0.0
        else:
            self._amount += step
            self._seconds += step_s
        return self._amount > self._longest and not 0.0 < self._seconds <= self._passage_s
