"""Dwell: a pair counts once it was seen in enough consecutive frames, and once per hold."""

from typing import NamedTuple

from lightgesture.fsm.events import Pair


class Hold(NamedTuple):
    """A pair seen in `frames` consecutive frames; `confidence_sum` adds one confidence (0 to 1) a frame."""

    pair: Pair
    frames: int
    confidence_sum: float
    first_frame: int
    first_time_s: float

    @property
    def confidence(self) -> float:
        """Mean over the hold, 0 to 1."""
        return self.confidence_sum / self.frames


def grow(hold: Hold | None, pair: Pair, confidence: float, frame: int, time_s: float) -> Hold:
    """The hold after one more sighting: one frame longer, or begun anew by another pair."""
    if hold is None or hold.pair != pair:
        return Hold(pair, 1, confidence, frame, time_s)
    return Hold(pair, hold.frames + 1, hold.confidence_sum + confidence, hold.first_frame, hold.first_time_s)


def release_frames(hold: int, fraction: float) -> int:
    """Frames of absence that end a hold of `hold` frames: `fraction` of it, rounded, at least one."""
    return max(1, round(hold * fraction))


class Dwell:
    """Turns one pair (or None) per frame into held pairs.

    hold: consecutive frames that make a held pair. release: frames that a held pair must be absent
    before the same pair counts again, at most `hold`: then any other held pair has released it too,
    and one pair is all there is to remember.
    """

    __slots__ = ("_absent", "_growing", "_spent", "hold", "release")

    def __init__(self, hold: int, release: int) -> None:
        self.hold = hold
        self.release = min(release, hold)
        self._growing: Hold | None = None
        self._spent: Pair | None = None
        self._absent = 0

    @property
    def growing(self) -> Hold | None:
        """The hold that has begun and is not yet long enough."""
        return self._growing

    def process(self, pair: Pair | None, confidence: float, frame: int, time_s: float) -> Hold | None:
        """The hold that became long enough in this frame, else None."""
        if self._spent is not None:
            if pair == self._spent:
                self._absent = 0
                self._growing = None
                return None
            self._absent += 1
            if self._absent >= self.release:
                self._spent = None
        if pair is None:
            self._growing = None
            return None
        hold = grow(self._growing, pair, confidence, frame, time_s)
        if hold.frames < self.hold:
            self._growing = hold
            return None
        self._spend(pair)
        return hold

    def discard(self) -> None:
        """Let the growing hold come to nothing: its pair needs a release like one that was read.

        A pair that is still unreleased keeps its place: the other one has then only just begun.
        """
        if self._growing is not None and self._spent is None:
            self._spend(self._growing.pair)
        self._growing = None

    def reset(self) -> None:
        """Forget everything, as at the start of a stream."""
        self._growing = None
        self._spent = None
        self._absent = 0

    def _spend(self, pair: Pair) -> None:
        self._growing = None
        self._spent = pair
        self._absent = 0
