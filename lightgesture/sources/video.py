"""A video file, read from its first frame to its last."""

import os
from collections.abc import Iterator
from typing import Final

import cv2

from lightgesture.errors import InputError
from lightgesture.features.image import as_bgr8
from lightgesture.frames import Frame
from lightgesture.sources.pictures import is_picture_name
from lightgesture.sources.types import Source

# A video counts as cut off when both more frames and more seconds are missing than are spared.

SPARE_FRAMES: Final = 2
"""Missing frames that are forgiven, for some encoders count one or two that hold no picture."""

SPARE_S: Final = 0.1
"""Seconds from the end of the last frame to the promised end that are forgiven where the container stores the number
of frames."""

SPARE_S_ESTIMATED: Final = 0.5
"""Likewise where the number comes from the duration, which an audio track may stretch."""

SNIFFED_BYTES: Final = 4096
"""Bytes at the start of a file looked at to tell text from video."""

_MP4_BOXES = (b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip")
"""Types of the box that opens an MP4 or QuickTime file, after its size of four bytes."""

_TEXT_CONTROLS = frozenset(b"\t\n\r\f\x1b")


class VideoFile(Source):
    """A video in any container that OpenCV's FFmpeg reads.

    Frames are read in sequence, never by seeking, and the time of each is the container's own time stamp
    (CAP_PROP_POS_MSEC after the frame was read): exact at a variable frame rate, where index / rate is
    seconds off. InputError when opened: no video, or no frame of it can be decoded; at the end of the
    iteration: the video ended early.
    """

    def __init__(self, path: str) -> None:
        self.name = path
        start = _read_start(path)
        _refuse_no_video(path, start)
        is_counted = start[:4] == b"RIFF" or start[4:8] in _MP4_BOXES
        self._spare_s = SPARE_S if is_counted else SPARE_S_ESTIMATED
        # An absolute path, for FFmpeg would take the "take:1.mp4" of a relative one for a protocol.
        self._capture = cv2.VideoCapture(os.path.abspath(path))
        if not self._capture.isOpened():
            raise InputError(
                f"{path}: is no video that can be read, or is cut off; copy it again or convert it"
            )
        promised = self._capture.get(cv2.CAP_PROP_FRAME_COUNT)
        self.frame_count = int(promised) if promised >= 1 else None
        self._rate = self._capture.get(cv2.CAP_PROP_FPS)
        self._next = self._read(0)
        if self._next is None:
            self._capture.release()
            raise InputError(f"{path}: no frame of this video can be decoded; copy or convert it again")

    def close(self) -> None:
        """Close the file."""
        self._capture.release()

    def __iter__(self) -> Iterator[Frame]:
        while self._next is not None:
            frame = self._next
            yield frame
            self._next = self._read(frame.index + 1)
            if self._next is None:
                self._check_end(frame)

    def _read(self, index: int) -> Frame | None:
        is_read, image = self._capture.read()
        if not is_read:
            return None
        # Microseconds are finer than any container's clock and hide the rounding of the division.
        time_s = round(self._capture.get(cv2.CAP_PROP_POS_MSEC) / 1000.0, 6)
        return Frame(as_bgr8(image), index, time_s)

    def _check_end(self, last: Frame) -> None:
        if self.frame_count is None or self._rate <= 0:
            return
        decoded = last.index + 1
        missing_s = self.frame_count / self._rate - (last.time_s + 1.0 / self._rate)
        if self.frame_count - decoded > SPARE_FRAMES and missing_s > self._spare_s:
            raise InputError(
                f"{self.name}: the video ends early, after {decoded} of {self.frame_count} frames; "
                "copy or record it again"
            )


def _read_start(path: str) -> bytes:
    try:
        with open(path, "rb") as stream:
            return stream.read(SNIFFED_BYTES)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name a readable file") from None


def _refuse_no_video(path: str, start: bytes) -> None:
    """Refuse what would crash OpenCV, and what FFmpeg takes for a video: pictures, and text as a screen."""
    if not start:
        raise InputError(f"{path}: is empty (0 bytes); copy or record it again")
    if not _is_utf8(os.path.abspath(path)):  # OpenCV crashes on such names
        raise InputError(f"{path}: the name is not UTF-8; rename the file or its folder")
    if is_picture_name(path):
        raise InputError(
            f"{path}: is a single picture, no video; name its folder to decode all frames in it, "
            "or use `lightgesture recognize`"
        )
    if all(byte >= 0x20 or byte in _TEXT_CONTROLS for byte in start):
        raise InputError(f"{path}: is text, no video; name a video or a folder of frames")


def _is_utf8(name: str) -> bool:
    try:
        name.encode("utf-8")
    except UnicodeEncodeError:
        return False
    return True
