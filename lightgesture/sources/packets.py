"""Pieces of a video, as topics of bags have them, to pictures."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import reason_of
from lightgesture.features.types import Image
from lightgesture.sources.conversion import Converter
from lightgesture.sources.decoding import bound

if TYPE_CHECKING:
    from av.video.frame import VideoFrame

MAX_REORDERED: Final = 16
"""By how many packets a codec may put a frame off: H.264 and H.265 allow no more."""

_CODECS = {
    "264": "h264",
    "265": "hevc",
    **{name: name for name in ("hevc", "av1", "vp9", "vp8", "mpeg4", "mjpeg", "ffv1")},
}
"""Part of what messages call a codec, which may be that of an encoder, to FFmpeg's name of it."""


class PacketDecoder:
    """Decodes the packets of one video, each with a number and a time.

    format: of the messages, such as "h264" or "hevc_nvenc". tell: takes remarks on its colours. ValueError: a codec
    that is not known here.
    """

    def __init__(self, format: str, tell: Callable[[str], None]) -> None:  # noqa: A002 - what messages call it
        import av
        import av.error
        from av.video.codeccontext import VideoCodecContext

        name = next((codec for part, codec in _CODECS.items() if part in format.lower()), None)
        if name is None:
            raise ValueError(f"is coded as {format!r}, which is not known here; record H.264 or H.265")
        context = av.CodecContext.create(name, "r")
        assert isinstance(context, VideoCodecContext)
        bound(context)
        context.thread_count = 1  # more would keep pictures back
        self._context, self._converter = context, Converter(tell)
        self._pending: dict[int, int] = {}

    def feed(self, number: int, time_ns: int, data: NDArray[np.uint8]) -> list[tuple[Image, int]]:
        """The pictures that are whole now, in order, and their times. ValueError: the packet cannot be decoded."""
        import av
        import av.error

        packet = av.Packet(data.tobytes())
        packet.pts = packet.dts = number
        self._pending[number] = time_ns
        try:
            return self._timed(self._context.decode(packet))
        except (av.error.FFmpegError, ValueError) as error:
            self._pending.pop(number, None)
            raise ValueError(f"cannot be decoded ({reason_of(error)})") from None

    def flush(self) -> list[tuple[Image, int]]:
        """The pictures that the decoder still holds."""
        import av
        import av.error

        try:
            return self._timed(self._context.decode(None))
        except (av.error.FFmpegError, ValueError):
            return []

    def _timed(self, frames: list["VideoFrame"]) -> list[tuple[Image, int]]:
        whole = [(frame, self._time_of(frame)) for frame in frames]
        return [
            (self._converter.bgr8(frame), time_ns)
            for frame, time_ns in whole
            if time_ns is not None and not frame.is_corrupt
        ]

    def _time_of(self, frame: "VideoFrame") -> int | None:
        """That of its packet; of a codec that reorders, whose packets have the times of their sending, the earliest
        that no frame has had."""
        pending, number = self._pending, frame.pts
        if not pending or number is None:
            return None
        is_reordered = self._context.has_b_frames or number not in pending
        time_ns = pending.pop(min(pending, key=pending.__getitem__) if is_reordered else number)
        oldest = number - MAX_REORDERED if is_reordered else number
        for lost in [one for one in pending if one < oldest]:
            del pending[lost]
        return time_ns
