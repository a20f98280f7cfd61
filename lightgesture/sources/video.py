"""A video file, read from its first frame to its last."""

import multiprocessing
import os
import re
from collections.abc import Iterator
from contextlib import suppress
from datetime import datetime
from typing import TYPE_CHECKING, Final

from lightgesture.config import DEFAULT_FPS
from lightgesture.console import warn
from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources.clock import RecordingClock, creation_time
from lightgesture.sources.decoding import MAX_PIXELS, REORDERED, Picture, StreamDecoder
from lightgesture.sources.file_size import is_cut_off
from lightgesture.sources.pictures import is_picture_name
from lightgesture.sources.types import Source

if TYPE_CHECKING:
    from av.container import InputContainer
    from av.video.codeccontext import VideoCodecContext
    from av.video.stream import VideoStream

DAMAGE_S: Final = 0.2
"""Seconds in which frames were lost that are told as a gap: less than half of a hold hides no sign."""

USUAL_STEPS: Final = 1.5
"""Times that between two frames which is longer than usual, near a lost one."""

SNIFFED_BYTES: Final = 4096
"""Bytes at the start of a file looked at to tell text from video."""

SMALL_PIXELS: Final = 640 * 480
"""Pixels of a frame up to which one thread decodes: handing frames between threads takes as long as they save, and each
thread holds memory of its own and a frame back."""

ROOM: Final = 64 << 20
"""Bytes that are enough to open any video: several times what was seen."""

SPARE_S: Final = 0.1
"""Seconds that a duration may promise beyond the last frame of a file that was cut off, and all frames be there."""

_NO_TIME_STAMPS = 0x80
"""FFmpeg's flag of formats without a clock: elementary streams of H.264, HEVC, MJPEG and others."""

_PICTURE_FORMATS = "_pipe"
"""End of FFmpeg's names of pictures one after the other, which have no clock either."""

_MICROSECONDS = 1e6
_DURATION = re.compile(r"(\d+):(\d+):(\d+(?:\.\d+)?)")
_RAW_VIDEO = b"YUV4MPEG2 "  # whose header is text
_TEXT_CONTROLS = frozenset(b"\t\n\r\f\x1b")


class VideoFile(Source):
    """A video in any container and codec that FFmpeg reads, by way of PyAV.

    Frames are read in sequence, never by seeking. The time of each is the container's stamp, counted from the start of
    the file, which may be that of its sound; of a stream without a clock it is index / `fps`, and the user is told.
    Interlaced frames are deinterlaced. Damaged places are read over: a frame that comes after one says so (`gap`) and
    has the index that it would have without.

    start_utc: when the recording began, where the container tells. InputError when opened: no video, or no frame of it
    can be decoded or shown; at the end of the iteration: the file was cut off, or is still being written.
    """

    def __init__(self, path: str, fps: float = DEFAULT_FPS) -> None:
        self.name = path
        _refuse_no_video(path, _read_start(path))
        self._size = os.path.getsize(path)
        self._container = _open(path)
        try:
            self._begin(fps)
        except BaseException:
            self._container.close()
            raise

    def _begin(self, fps: float) -> None:
        container = self._container
        stream = self._stream = _choose(container, self.name)
        kind = container.format
        has_clock = not (kind.flags & _NO_TIME_STAMPS or kind.name.endswith(_PICTURE_FORMATS))
        rate = self._rate = float(stream.average_rate or stream.guessed_rate or fps) if has_clock else fps
        self._period_s = 1 / rate
        self._duration_s = _seconds(stream, container) if has_clock else None
        self._counted = stream.frames
        estimate = 0 if self._duration_s is None else round(self._duration_s * rate)
        self.frame_count: int | None = self._counted or estimate or None
        self.start_utc: datetime | None = creation_time({**stream.metadata, **container.metadata})
        start = container.start_time
        is_known = has_clock and start is not None
        self._clock = RecordingClock(start / _MICROSECONDS if is_known else None, self._period_s)
        # Not by way of `self`: in a circle all that FFmpeg holds would wait for Python's collection, megabytes a video.
        name = self.name
        self._decoder = StreamDecoder(container, stream, lambda text: warn(f"{name}: {text}"))
        self._pictures = self._decoder.pictures()
        self._has_clock, self._lost = has_clock, 0
        self._lost_at: int | None = None
        self._next = self._read(None)
        if self._next is None:
            raise InputError(f"{self.name}: {self._why_nothing()}")
        if not has_clock:
            warn(f"{self.name}: has no clock; taken for {fps:g} frames a second (--fps)")

    def close(self) -> None:
        """Close the file."""
        self._pictures.close()
        self._container.close()

    def __iter__(self) -> Iterator[Frame]:
        while self._next is not None:
            frame = self._next
            yield frame
            self._next = self._read(frame)
            if self._next is None:
                self._check_end(frame)

    def _read(self, last: Frame | None) -> Frame | None:
        import av
        import av.error

        try:
            picture = next((one for one in self._pictures if one is not None), None)
        except MemoryError:
            raise
        except av.error.FFmpegError as error:
            raise InputError(f"{self.name}: cannot be read on ({error.strerror}); copy it again") from None
        return None if picture is None else self._frame(picture, last)

    def _frame(self, picture: Picture, last: Frame | None) -> Frame:
        before = -1 if last is None else last.index
        index = before + picture.lost + 1
        stamp_s = picture.stamp_s if self._has_clock else index * self._period_s
        time_s = self._clock.read(stamp_s, index - before)
        self._lost += picture.lost
        if picture.lost:
            self._lost_at = index
        gap = None
        if last is not None:
            gap = self._find_gap(picture, last, index, time_s)
        return Frame(picture.image, index, time_s, gap)

    def _find_gap(self, picture: Picture, last: Frame, index: int, time_s: float) -> str | None:
        if self._clock.jump_s:
            return f"the time stamps jump back by {self._clock.jump_s:g} s"
        if last.image.shape != picture.image.shape:
            return f"the picture changes from {_size(last)} to {_size(picture)}"
        # A frame that was kept back to be shown later may come between the error and the hole.
        is_damaged = self._lost_at is not None and index - self._lost_at <= REORDERED
        if is_damaged and time_s - last.time_s >= max(DAMAGE_S, USUAL_STEPS * self._period_s):
            return f"damaged from {last.time_s:.2f} to {time_s:.2f} s"
        if picture.lost and not self._has_clock:
            return f"damaged before {time_s:.2f} s; without a clock how much is missing is not known"
        return None

    def _check_end(self, last: Frame) -> None:
        lost, read = self._decoder.lost, last.index + 1
        self._lost += lost
        if self._lost:
            warn(f"{self.name}: left out {self._lost} damaged frame{'s' * (self._lost > 1)}")
        if self._decoder.objection:
            unshown = f"{self._decoder.unshown} of its frames cannot be shown"
            raise InputError(f"{self.name}: {unshown}: {self._decoder.objection}; convert it")
        if os.path.getsize(self.name) > self._size:
            raise InputError(f"{self.name}: is still being written; decode it again when it is done")
        is_damaged = lost * self._period_s >= DAMAGE_S
        if is_damaged or (self._is_cut() and not self._has_all(read + lost, last.time_s)):
            promised = f"{read} of {self.frame_count}" if (self.frame_count or 0) > read else str(read)
            raise InputError(
                f"{self.name}: the video ends early, after {promised} frames; copy or record it again"
            )

    def _is_cut(self) -> bool:
        """Whether the container or the codec says so."""
        with suppress(OSError):
            return self._decoder.is_cut or is_cut_off(self.name)
        return False

    def _has_all(self, read: int, last_s: float) -> bool:
        """Whether a file that was cut off lost no frame, but its index, say."""
        if self._counted and read >= self._counted:
            return True
        # Of a file that was cut off FFmpeg guesses the duration, but the count is in its header.
        promised_s = self._counted / self._rate if self._counted else self._duration_s
        return promised_s is not None and last_s + self._period_s >= promised_s - SPARE_S

    def _why_nothing(self) -> str:
        codec = self._stream.codec_context.name
        if self._decoder.objection:
            return f"no frame of this video ({codec}) can be shown: {self._decoder.objection}; convert it"
        return f"no frame of this video ({codec}) can be decoded; copy or convert it again"


def _open(path: str) -> "InputContainer":
    import av
    import av.error

    try:
        # An absolute path, for FFmpeg would take the "take:1.mp4" of a relative one for a protocol.
        return av.open(
            os.path.abspath(path), options={"protocol_whitelist": "file"}, metadata_errors="replace"
        )
    except MemoryError:
        if not _has_room():
            raise
        raise InputError(
            f"{path}: wants more memory to be opened than any video does, so it is damaged; copy it again"
        ) from None
    except (av.error.FFmpegError, ValueError, UnicodeError):
        raise InputError(
            f"{path}: is no video that can be read, or is cut off; copy it again or convert it"
        ) from None


def _has_room() -> bool:
    """Whether there is memory to open a video: FFmpeg says of a size that a damaged header names what it says where
    there is none."""
    try:
        bytearray(ROOM)
    except MemoryError:
        return False
    return True


def _choose(container: "InputContainer", path: str) -> "VideoStream":
    """The video stream; the others are not read. InputError: there is none, or of an unknown codec."""
    from av.stream import Discard
    from av.video.stream import VideoStream

    stream = container.streams.best("video")
    # PyAV gives a stream of a codec that FFmpeg does not know without a context.
    context: VideoCodecContext | None = stream.codec_context if isinstance(stream, VideoStream) else None
    if not isinstance(stream, VideoStream) or context is None:
        is_unknown = bool(container.streams.video)
        reason = "its codec is not known here" if is_unknown else "holds no pictures"
        raise InputError(f"{path}: {reason}; convert it or name a video")
    if context.width * context.height > MAX_PIXELS:
        size = f"{context.width} x {context.height}"
        raise InputError(
            f"{path}: promises frames of {size} pixels, more than {MAX_PIXELS:,}; make it smaller"
        )
    for other in container.streams:
        if other.index != stream.index:
            other.discard = Discard.all
    # One of several processes, a video each: threads would cost a third more in all.
    is_one_of_many = multiprocessing.parent_process() is not None
    if is_one_of_many or context.width * context.height <= SMALL_PIXELS:
        context.thread_count = 1
    else:
        context.thread_type = "AUTO"
    return stream


def _seconds(stream: "VideoStream", container: "InputContainer") -> float | None:
    """How long the pictures last by the container, a hint: that of a file counts its sound too."""
    if stream.duration is not None and stream.time_base is not None:
        return float(stream.duration * stream.time_base)
    match = _DURATION.match(stream.metadata.get("DURATION", ""))
    if match is not None:
        return int(match[1]) * 3600 + int(match[2]) * 60 + float(match[3])
    return None if container.duration is None else container.duration / _MICROSECONDS


def _size(picture: Frame | Picture) -> str:
    height, width = picture.image.shape[:2]
    return f"{width} x {height}"


def _read_start(path: str) -> bytes:
    try:
        with open(path, "rb") as stream:
            return stream.read(SNIFFED_BYTES)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name a readable file") from None


def _refuse_no_video(path: str, start: bytes) -> None:
    """Refuse what FFmpeg takes for a video: pictures, and text as a screen."""
    if not start:
        raise InputError(f"{path}: is empty (0 bytes); copy or record it again")
    if is_picture_name(path):
        raise InputError(
            f"{path}: is a single picture, no video; name its folder to decode all frames in it, "
            "or use `lightgesture recognize`"
        )
    if not start.startswith(_RAW_VIDEO) and all(byte >= 0x20 or byte in _TEXT_CONTROLS for byte in start):
        raise InputError(f"{path}: is text, no video; name a video or a folder of frames")
