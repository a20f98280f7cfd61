"""The sound of a video, copied beside the pictures of another."""

import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from av.audio.stream import AudioStream
    from av.container import InputContainer, OutputContainer
    from av.packet import Packet

COPIED: Final = frozenset({"aac", "ac3", "alac", "eac3", "flac", "mp2", "mp3", "opus"})
"""Codecs that an .mp4 file may have as they are; others are coded anew."""

ENCODER: Final = "aac"

_MICROSECONDS = 1_000_000
_KEPT_METADATA = frozenset(
    {
        *(
            "album",
            "artist",
            "comment",
            "copyright",
            "creation_time",
            "date",
            "description",
            "genre",
            "location",
        ),
        *("make", "model", "synopsis", "title"),
    }
)
"""What an .mp4 file may say about itself and a video may have told."""


class SoundTrack:
    """The first sound of a video, or of its chapters one after the other, on the clock of their pictures.

    paths: of videos; what is none has no sound, nor does one that cannot be read.
    """

    def __init__(self, paths: Sequence[str]) -> None:
        self._paths = list(paths)
        self._first = _open(self._paths[0]) if self._paths else None
        self._output: AudioStream | None = None
        self._container: OutputContainer | None = None
        self._packets: Iterator[tuple[float, Packet[Any]]] = iter(())
        self._waiting: tuple[float, Packet[Any]] | None = None

    @property
    def metadata(self) -> dict[str, str]:
        """What the video says about itself and an .mp4 file can keep."""
        found = self._first.metadata if self._first is not None else {}
        return {name.lower(): value for name, value in found.items() if name.lower() in _KEPT_METADATA}

    def add_to(self, container: "OutputContainer") -> None:
        """Begin a stream of sound in a file, if there is any. Before the first packet of it is written."""
        import av
        import av.error

        if self._first is None or not self._first.streams.audio:
            return
        original, self._container = self._first.streams.audio[0], container
        codec = original.codec_context
        with suppress(av.error.FFmpegError, ValueError, TypeError):
            if codec.codec.canonical_name in COPIED:
                self._output = container.add_stream_from_template(original)
                self._packets = self._copied()
            else:
                self._output = container.add_stream(ENCODER, codec.rate, layout=codec.layout.name)
                self._packets = self._encoded()

    def write_until(self, time_s: float) -> None:
        """Write what sounds before a moment of the video."""
        if self._container is None or self._output is None:
            return
        while (packet := self._waiting or next(self._packets, None)) is not None:
            self._waiting = packet
            if packet[0] > time_s:
                return
            self._waiting = None
            with suppress(ValueError):  # a packet that the file cannot have, not a disk that is full
                self._container.mux(packet[1])

    def close(self) -> None:
        """Close the video."""
        if self._first is not None:
            self._first.close()

    def _parts(self) -> Iterator[tuple["InputContainer", float]]:
        """Each file, and the seconds at which its own clock begins on that of the first."""
        start_s = 0.0
        for path in self._paths:
            container = self._first if path == self._paths[0] else _open(path)
            if container is None or not container.streams.audio:
                return
            yield container, start_s - (container.start_time or 0) / _MICROSECONDS
            start_s += (container.duration or 0) / _MICROSECONDS
            if container is not self._first:
                container.close()

    def _copied(self) -> Iterator[tuple[float, "Packet[Any]"]]:
        import av
        import av.error

        last: int | None = None
        output: Any = self._output
        for container, shift_s in self._parts():
            with suppress(av.error.FFmpegError):  # the sound ends where it is damaged
                for packet in container.demux(container.streams.audio[0]):
                    if packet.dts is None or packet.pts is None or packet.time_base is None:
                        continue
                    shift = round(shift_s / packet.time_base)
                    packet.pts, packet.dts = packet.pts + shift, packet.dts + shift
                    if (
                        last is not None and packet.dts <= last
                    ):  # where two chapters meet, or a clock ran back
                        continue
                    last, packet.stream = packet.dts, output
                    yield float(packet.pts * packet.time_base), packet

    def _encoded(self) -> Iterator[tuple[float, "Packet[Any]"]]:
        import av
        import av.error

        output: Any = self._output
        encoder = output.codec_context
        rate = encoder.rate
        resampler = av.AudioResampler(encoder.format, encoder.layout, rate, frame_size=1024)
        for container, shift_s in self._parts():
            with suppress(av.error.FFmpegError):
                for frame in container.decode(container.streams.audio[0]):
                    if frame.pts is None or frame.time_base is None:
                        continue
                    frame.pts += round(shift_s / frame.time_base)
                    for part in resampler.resample(frame):
                        yield from _timed(encoder.encode(part), output, rate)
        with suppress(av.error.FFmpegError, ValueError):
            for part in resampler.resample(None):
                yield from _timed(encoder.encode(part), output, rate)
            yield from _timed(encoder.encode(None), output, rate)


def _timed(packets: Sequence["Packet[Any]"], output: Any, rate: int) -> Iterator[tuple[float, "Packet[Any]"]]:
    for packet in packets:
        packet.stream = output
        yield float((packet.pts or 0) * (packet.time_base or Fraction(1, rate))), packet


def _open(path: str) -> "InputContainer | None":
    import av
    import av.error

    if not os.path.isfile(path):
        return None
    try:
        return av.open(
            os.path.abspath(path), options={"protocol_whitelist": "file"}, metadata_errors="replace"
        )
    except (av.error.FFmpegError, ValueError, UnicodeError):
        return None
