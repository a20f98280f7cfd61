"""Network streams that FFmpeg reads, such as RTSP and H.264 over UDP, by way of PyAV."""

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final, Self

from lightgesture.console import warn
from lightgesture.errors import InputError
from lightgesture.features.types import Image
from lightgesture.sources import types
from lightgesture.sources.address import split_address
from lightgesture.sources.decoding import StreamDecoder
from lightgesture.sources.types import LiveSource

if TYPE_CHECKING:
    from av.container import InputContainer
    from av.video.codeccontext import VideoCodecContext
    from av.video.stream import VideoStream

NETWORK_SCHEMES = ("rtsp", "rtsps", "rtmp", "udp", "tcp")
"""Beginnings of the addresses that FFmpeg opens."""

OPTIONS: Final = {"rtsp_flags": "prefer_tcp"}
"""FFmpeg's: pictures over UDP lose packets where the connection itself would do."""


class NetworkStream(LiveSource):
    """The pictures of a stream as they come; damaged ones are passed over, interlaced ones deinterlaced."""

    def __init__(self, address: str, name: str | None = None) -> None:
        """name: what may be shown; None: the address without its login."""
        self.name = name or split_address(address).name
        self.is_reopened = True
        self._address = address
        self._container: InputContainer | None = None
        self._is_told = False

    def __enter__(self) -> Self:
        import av
        import av.error

        start_s = time.monotonic()
        try:
            self._container = self.open()
        except (av.error.FFmpegError, ValueError) as error:
            # An interrupted FFmpeg gives many reasons, and this one never.
            reason = "timed out" if time.monotonic() - start_s >= types.TIMEOUT_S else _reason(error)
            raise InputError(
                f"{self.name}: cannot be opened ({reason}); is it there, and used by nobody else?"
            ) from None
        return self

    def open(self) -> "InputContainer":
        """The container of the stream; av.error.FFmpegError or ValueError: it cannot be opened."""
        import av
        import av.error

        return av.open(self._address, timeout=types.TIMEOUT_S, options=OPTIONS, metadata_errors="replace")

    def close(self) -> None:
        """Let go of the connection."""
        if self._container is not None:
            self._container.close()
            self._container = None

    def __iter__(self) -> Iterator[Image]:
        import av
        import av.error

        assert self._container is not None
        decoder = StreamDecoder(self._container, self._choose(self._container), self._tell)
        seen_s = time.monotonic()
        try:
            for picture in decoder.pictures():
                now_s = time.monotonic()
                if picture is not None:
                    seen_s = now_s
                    yield picture.image
                elif now_s - seen_s > types.NO_PICTURE_S:
                    reason = decoder.objection or "none that can be decoded"
                    raise InputError(
                        f"{self.name}: sends data, but no picture for {types.NO_PICTURE_S:g} s: {reason}"
                    )
        except av.error.FFmpegError as error:
            raise InputError(f"{self.name}: broke off, or sends nothing more ({_reason(error)})") from None
        raise InputError(f"{self.name}: broke off, or sends nothing more")

    def _choose(self, container: "InputContainer") -> "VideoStream":
        from av.stream import Discard
        from av.video.stream import VideoStream

        stream = container.streams.best("video")
        context: VideoCodecContext | None = stream.codec_context if isinstance(stream, VideoStream) else None
        if not isinstance(stream, VideoStream) or context is None:
            raise InputError(
                f"{self.name}: sends no pictures that can be decoded; look at what the camera sends"
            )
        for other in container.streams:
            if other.index != stream.index:
                other.discard = Discard.all
        return stream

    def _tell(self, text: str) -> None:
        if not self._is_told:
            self._is_told = True
            warn(f"{self.name}: {text}")


def _reason(error: Exception) -> str:
    """FFmpeg's reason, never its text, which names the address with its login."""
    if type(error).__name__ == "ExitError":  # what it gives when its time is up
        return "timed out"
    return str(getattr(error, "strerror", None) or "an unknown fault")
