"""Reading a hand over some frames: what is shorter than a part of a hold can be no sign."""

import math
from collections import deque
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.hands.looks import LastLooks

HOLD_SHARE: Final = 1 / 3
"""Of the hold that is looked at: long enough to bridge a bad frame or two, and too short to make or hide a sign."""
SENTENCE_SHARE: Final = 1 / 2
"""The same of the least length of a sign, for a reader of sentences, to whom a bad moment looks like a sign."""
TOLERANCE_S: Final = 0.001
"""Containers round time stamps to milliseconds."""
MOST_FRAMES: Final = 31
"""Of a hold that is given in seconds: bounds the time of a fast camera's frames."""
FEWEST_FOR_A_MEDIAN: Final = 3
"""Frames of which one can be bad; of two the median is the mean, which is neither sign."""


class ReadingMemory:
    """What was read of each hand in the last frames, so that one bad frame does not break a sign that is held.

    frames: how many frames are looked at, this one included, at least 1. seconds: for how long one is, infinite where
    frames alone count. The median of each class's probability stands for the frame: it bridges fewer bad frames than
    half of what is looked at, and goes from one sign to the next in one step.

    looks: the last readings, which may stand for a moment; None where each frame is to be read, and one alone counts.
    """

    def __init__(self, frames: int = 1, seconds: float = math.inf) -> None:
        self._frames, self._seconds = frames, seconds
        self.looks = LastLooks() if frames > 1 else None
        self._rows: dict[int, deque[tuple[float, NDArray[np.float32]]]] = {}

    def keep_only(self, tracks: Sequence[int | None]) -> None:
        """Forget the hands that are not among these: one that comes back may show another sign."""
        for number in self._rows.keys() - set(tracks):
            del self._rows[number]
        if self.looks is not None:
            self.looks.keep_only(tracks)

    def steady(self, track: int | None, row: NDArray[np.float32], time_s: float) -> NDArray[np.float32]:
        """The probabilities (classes,) of a hand now, from those of its last frames; of no track: as they are."""
        if track is None or self._frames == 1:
            return row
        rows = self._rows.setdefault(track, deque(maxlen=self._frames))
        rows.append((time_s, row))
        while time_s - rows[0][0] > self._seconds or rows[0][0] > time_s:
            rows.popleft()
        if len(rows) < FEWEST_FOR_A_MEDIAN:
            return row
        return middle(np.array([one for _, one in rows]))


def middle(rows: NDArray[np.float32]) -> NDArray[np.float32]:
    """The median of each column of rows (n, k), n being 1 or more: `numpy.median`, which takes ten times as long for a
    few rows."""
    ordered, half = np.sort(rows, axis=0), len(rows) // 2
    if len(rows) % 2:
        return np.asarray(ordered[half])
    return np.asarray((ordered[half - 1] + ordered[half]) / np.float32(2.0))


NO_MEMORY: Final = ReadingMemory(1)
"""Takes each picture on its own, and so remembers nothing."""


def memory_for_hold(frames: int | None, seconds: float | None) -> ReadingMemory:
    """The memory for signs that are held for so many frames, or for so many seconds."""
    if frames is not None:
        return ReadingMemory(max(1, int(frames * HOLD_SHARE)))
    return ReadingMemory(MOST_FRAMES, (seconds or 0.0) * HOLD_SHARE)


def memory_for_sentences(hold_s: float) -> ReadingMemory:
    """The memory for sentences whose signs last `hold_s` seconds at least."""
    return ReadingMemory(MOST_FRAMES, hold_s * SENTENCE_SHARE + TOLERANCE_S)
