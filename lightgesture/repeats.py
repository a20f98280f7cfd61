"""Frames that equal the last one: a slow camera in a fast stream, a stream that stands still."""

from typing import Final

import cv2
import numpy as np

from lightgesture.features.types import Image

ROWS: Final = 16
"""Rows of a frame that are kept."""


class LastFrame:
    """Remembers the last frame of one stream.

    It is not copied, which would take longer than the rest of a frame where frames are large. A program may write its
    next frame over the last one, so a frame in the same place counts as another, and some rows are kept besides.
    """

    def __init__(self) -> None:
        self._frame: Image | None = None
        self._rows: Image | None = None
        self._start = 0

    def equals(self, frame: Image) -> bool:
        """Whether a frame, uint8 (height, width, 3), is the same as the one before, whose place it takes."""
        rows = frame[:: max(len(frame) // ROWS, 1)].copy()
        before, kept, before_start = self._frame, self._rows, self._start
        self._frame, self._rows, self._start = frame, rows, _start(frame)
        if before is None or kept is None or before.shape != frame.shape or before_start == self._start:
            return False
        # The middle row alone tells nearly every frame of a camera from the one before.
        middle = len(rows) // 2
        return (
            bool(np.array_equal(rows[middle], kept[middle]))
            and bool(np.array_equal(rows, kept))
            and cv2.norm(frame, before, cv2.NORM_INF) == 0.0
        )


def _start(frame: Image) -> int:
    place: int = frame.__array_interface__["data"][0]
    return place
