"""Signs that were shown and not read.

Hands that pass from one sign to the next are unread for a moment; a sign that nobody could read makes the moment
longer by its own hold. A sentence that went on after it would lack a word: "STOP HOVER 35 GO" without its digits is
another instruction, and a valid one.
"""

from lightgesture.fsm.events import Pair


class UnreadSigning:
    """Adds up how long hands were seen since the last word without saying one.

    longest: how much of it may be, in the dwell's unit (frames or seconds). The hold that is growing does not count, as
    long as it may still become a word.
    """

    __slots__ = ("_amount", "_growing", "_longest", "_pair")

    def __init__(self, longest: float) -> None:
        self._longest = longest
        self.reset()

    def reset(self) -> None:
        """A word was read: what comes now is new."""
        self._amount = 0.0
        self.pass_over()

    def pass_over(self) -> None:
        """The growing hold was long enough, and the diver was told what is wrong with it."""
        self._growing = 0.0
        self._pair: Pair | None = None

    def process(self, pair: Pair | None, growing: Pair | None, step: float) -> bool:
        """Take in a frame in which hands are seen; whether a sign has been missed.

        pair: what they show. growing: the pair whose hold is growing. step: what the frame stands for.
        """
        if growing != self._pair:
            self._amount += self._growing
            self._growing = 0.0
            self._pair = growing
        if pair is not None and pair == growing:
            self._growing += step
        else:
            self._amount += step
        return self._amount > self._longest
