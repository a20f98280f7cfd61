"""Looks at the frames of any source for holes that no source tells of: a stalled camera, pictures of nothing."""

import math
from collections import deque
from statistics import median
from typing import Final

import numpy as np

from lightgesture.features.types import Image

STALL_S: Final = 1.0
"""Seconds between two frames that are a hole, for a whole sign may have been made in them"""

STALL_INTERVALS: Final = 5
"""Usual intervals that a hole is longer than, so that a camera that gives a frame a second has none."""

USUAL: Final = 15
"""Last intervals whose median is the usual one."""

BLANK_S: Final = 2.0
"""Seconds of frames of one value after which they are told: a decoder's or a camera's failure, a cap on the lens."""

BLANK_SPREAD: Final = 2
"""Largest difference of a channel within a frame that counts as one value, of 255: compression leaves so much."""

SPARSE: Final = 16
"""Rows and columns of which one is looked at, before the whole frame is."""


class Watch:
    """Takes frame after frame of one stream."""

    def __init__(self) -> None:
        self._last_s: float | None = None
        self._intervals: deque[float] = deque(maxlen=USUAL)
        self._blank_since_s: float | None = None
        self._is_told = False
        self._frames = self._blank = 0
        self._blank_s = 0.0

    def look(self, image: Image, time_s: float) -> str | None:
        """The hole before or at the next frame, in words; None: none, or one that was told already.

        image: uint8 (height, width, 3). time_s: its time stamp, seconds.
        """
        holes = self._look_at_time(time_s), self._look_at_pixels(image, time_s)
        return next((hole for hole in holes if hole is not None), None)

    @property
    def is_blank(self) -> bool:
        """Whether most frames so far, and seconds of them in a row, showed nothing."""
        return self._blank_s >= BLANK_S and 2 * self._blank > self._frames

    def _look_at_time(self, time_s: float) -> str | None:
        last_s, self._last_s = self._last_s, time_s
        if last_s is None or not math.isfinite(time_s - last_s):
            return None
        step_s = time_s - last_s
        usual_s = median(self._intervals) if self._intervals else math.inf
        if step_s > 0:
            self._intervals.append(step_s)
        is_long = step_s > max(STALL_S, STALL_INTERVALS * usual_s)
        return f"no frame from {last_s:.2f} to {time_s:.2f} s" if is_long else None

    def _look_at_pixels(self, image: Image, time_s: float) -> str | None:
        self._frames += 1
        if not _is_blank(image):
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
