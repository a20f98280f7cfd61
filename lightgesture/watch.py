"""Looks at the frames of any source for holes that no source tells of: a camera that stalled or gives its last picture
again and again, pictures of nothing."""

import math
from collections import deque
from statistics import median
from typing import Final

import numpy as np

from lightgesture.features.types import Image
from lightgesture.repeats import LastFrame

STALL_S: Final = 1.0
"""Seconds between two frames that are a hole, for a whole sign may have been made in them"""

STALL_INTERVALS: Final = 5
"""Usual intervals that a hole is longer than, so that a camera that gives a frame a second has none."""

USUAL: Final = 15
"""Last intervals whose median is the usual one."""

BLANK_S: Final = 2.0
"""Seconds of frames of one value after which they are told: a decoder's or a camera's failure, a cap on the lens."""

BLINK_S: Final = 0.25
"""Seconds of frames of one value that are a hole when they end: a sign that is held on meanwhile would count twice."""

BLANK_SPREAD: Final = 2
"""Largest difference of a channel within a frame that counts as one value, of 255: compression leaves so much."""

SPARSE: Final = 16
"""Rows and columns of which one is looked at, before the whole frame is."""


class _Pace:
    """The times of what comes again and again. repeats: how often it came since its time last went on."""

    def __init__(self) -> None:
        self.last_s: float | None = None
        self.repeats = 0
        self._intervals: deque[float] = deque(maxlen=USUAL)

    @property
    def usual_s(self) -> float:
        """The usual interval, seconds; infinite where none is known."""
        return median(self._intervals) if self._intervals else math.inf

    @property
    def stands_still(self) -> bool:
        """Whether it came so often since its time last went on that it should have been far later."""
        missed_s = self.repeats * self.usual_s if self.repeats > STALL_INTERVALS else 0.0
        return STALL_S <= missed_s < math.inf

    def is_late(self, time_s: float) -> bool:
        """Whether at this time far more than the usual interval has passed, and long enough for a whole sign."""
        if self.last_s is None:
            return False
        return max(STALL_S, STALL_INTERVALS * self.usual_s) < time_s - self.last_s < math.inf

    def note(self, time_s: float) -> None:
        """It came."""
        step_s = math.inf if self.last_s is None else time_s - self.last_s
        self.repeats = self.repeats + 1 if step_s <= 0 else 0
        if 0 < step_s < math.inf:
            self._intervals.append(step_s)
        self.last_s = time_s


class Watch:
    """Takes frame after frame of one stream."""

    def __init__(self) -> None:
        self._frames_come, self._pictures_change = _Pace(), _Pace()
        self._last = LastFrame()
        self._is_frozen_told = False
        self._blank_since_s: float | None = None
        self._is_told = False
        self._frames = self._blank = 0
        self._blank_s = 0.0

    def look(self, image: Image, time_s: float) -> str | None:
        """The hole before or at the next frame, in words; None: none, or one that was told already.

        image: uint8 (height, width, 3). time_s: its time stamp, seconds.
        """
        is_blank = _is_blank(image)
        holes = (
            self._look_at_time(time_s),
            self._look_at_change(image, time_s, is_blank),
            self._look_at_pixels(time_s, is_blank),
        )
        return next((hole for hole in holes if hole is not None), None)

    @property
    def is_blank(self) -> bool:
        """Whether most frames so far, and seconds of them in a row, showed nothing."""
        return self._blank_s >= BLANK_S and 2 * self._blank > self._frames

    def _look_at_time(self, time_s: float) -> str | None:
        """Whether the camera stalled, or its clock did for so many frames that a sign may have been made in them."""
        pace = self._frames_come
        last_s, is_late, stood = pace.last_s, pace.is_late(time_s), pace.stands_still
        pace.note(time_s)
        if is_late:
            return f"no frame from {last_s:.2f} to {time_s:.2f} s"
        if pace.stands_still and not stood:
            return f"time stands still at {time_s:.2f} s: {pace.repeats} frames came with no later stamp"
        return None

    def _look_at_change(self, image: Image, time_s: float, is_blank: bool) -> str | None:
        """Whether the camera gives its last picture again, or nothing, for so long that a sign may have been made.

        It is told while it lasts, and once more when it ends: what was read of a picture that stood still is no sign.
        Frames of nothing are told by themselves after a while, and then nothing is open when they end.
        """
        pace, is_same = self._pictures_change, self._last.equals(image)
        since_s, is_late = pace.last_s, pace.is_late(time_s)
        if is_blank or is_same:
            if not is_late or is_blank or self._is_frozen_told:
                return None
            self._is_frozen_told = True
            return f"the picture stands still from {since_s:.2f} s on: all frames are the same"
        pace.note(time_s)
        self._is_frozen_told = False
        blank_s = self._blank_since_s
        if blank_s is not None and time_s - blank_s > BLINK_S and not self._is_told:
            return f"nothing was shown from {blank_s:.2f} to {time_s:.2f} s"
        return (
            f"no new picture from {since_s:.2f} to {time_s:.2f} s" if is_late and not self._is_told else None
        )

    def _look_at_pixels(self, time_s: float, is_blank: bool) -> str | None:
        self._frames += 1
        if not is_blank:
            self._blank_since_s, self._is_told = None, False
            return None
        self._blank += 1
        if self._blank_since_s is None or time_s < self._blank_since_s:
            self._blank_since_s = time_s
        lasted_s = time_s - self._blank_since_s
        self._blank_s = max(self._blank_s, lasted_s)
        if lasted_s < BLANK_S or self._is_told:
            return None
        self._is_told = True
        return f"frames show nothing from {self._blank_since_s:.2f} s on: all pixels are the same"


def _is_blank(image: Image) -> bool:
    """Whether all pixels have nearly the same value."""
    return all(_spread(part) <= BLANK_SPREAD for part in (image[::SPARSE, ::SPARSE], image))


def _spread(image: Image) -> int:
    """The largest difference of a channel's values within the frame."""
    pixels = image.reshape(-1, image.shape[-1]) if image.ndim == 3 else image.reshape(-1, 1)
    return int(np.max(pixels.max(axis=0).astype(int) - pixels.min(axis=0)))
