"""Pictures of the stages, for `--debug-dir`."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing

INTERVAL_S: Final = 1.0
"""Seconds of the source from one saved frame to the next: enough to follow a video, few enough to look at."""


class DebugPictures:
    """Saves `<folder>/<stage>-<index>.png` for the frames that `select` chose.

    Of a stream these are the first frame and then one a second of the source's own time. tell: takes a line where a
    picture cannot be written any more, after which there are none, for a stream that goes on does not end by them;
    None: the error is raised. Where the first picture of all cannot be written, it is raised in any case.
    """

    def __init__(self, folder: Path, tell: Callable[[str], None] | None = None) -> None:
        self.folder = folder
        self._tell = tell
        self._has_written = self._is_over = False
        self._due_s: float | None = None
        self.is_selected = False

    def select(self, time_s: float) -> None:
        """Decide whether the pictures of the frame at `time_s`, about to be processed, are saved."""
        self.is_selected = not self._is_over and (self._due_s is None or time_s >= self._due_s)
        if self.is_selected:
            self._due_s = time_s + INTERVAL_S

    def start(self, folder: Path) -> None:
        """Save the pictures of the next input, a single picture, in `folder`."""
        self.folder = folder
        self.is_selected = True

    def write(self, stage: str, index: int, image_bgr: NDArray[np.uint8]) -> None:
        """Save a picture of a stage. UsageError: the folder cannot be written."""
        if not self.is_selected or self._is_over:
            return
        content = cv2.imencode(".png", image_bgr)[1].tobytes()
        try:
            with replacing(self.folder / f"{stage}-{index:06d}.png") as temporary:
                temporary.write_bytes(content)
        except UsageError as error:
            if self._tell is None or not self._has_written:
                raise
            self._is_over = True
            self._tell(f"{error}; decoding goes on without pictures of the stages")
        self._has_written = True
