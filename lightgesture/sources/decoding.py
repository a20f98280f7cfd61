"""The pictures of a video stream that PyAV has opened, and what was lost between them."""

import heapq
from collections import deque
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from lightgesture.features.types import Image
from lightgesture.sources.conversion import Converter, Deinterlacer

if TYPE_CHECKING:
    from av.container import InputContainer
    from av.packet import Packet
    from av.video.codeccontext import VideoCodecContext
    from av.video.frame import VideoFrame
    from av.video.stream import VideoStream

MAX_FAILURES: Final = 100
"""Reads in a row that may fail before the rest of a container counts as unreadable."""

ONLY_DECODING_ORDER: Final = ("avi",)
"""FFmpeg's names of containers that have no stamps for showing, which differ from those for decoding where a codec
reorders frames."""

CHUNK_HEAD_BYTES: Final = 8
"""Of AVI, before the content of a frame."""

REORDERED: Final = 16
"""Most frames that a codec keeps back to show them in another order."""

ONE_FRAME_A_PACKET: Final = ("hevc",)
"""Codecs that drop frames without an error where others are lost; each of their packets is a frame."""


MAX_PIXELS: Final = 40_000_000
"""Most pixels of a frame, against files that promise more than fits the memory; 8K has 33 million."""


def bound(context: "VideoCodecContext") -> None:
    """Have a decoder refuse frames of more than MAX_PIXELS, before it makes room for them."""
    context.options = {**context.options, "max_pixels": str(MAX_PIXELS)}


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture of a stream.

    image: uint8 (height, width, 3), BGR. stamp_s: the container's time stamp, seconds; None: it has none. lost: frames
    between the last picture and this one that could not be decoded or shown.
    """

    image: Image
    stamp_s: float | None
    lost: int


class StreamDecoder:
    """Decodes a stream from where its container stands to the end, over damaged places.

    Frames are lost that the decoder refuses, that it marks as corrupt, or that cannot be shown. objection: why one
    could not be shown; unshown: how many. is_cut: whether the container or its last packet is damaged where it ends.
    tell: takes remarks for the user.
    """

    def __init__(
        self, container: "InputContainer", stream: "VideoStream", tell: Callable[[str], None]
    ) -> None:
        self._container, self._stream = container, stream
        bound(stream.codec_context)
        self._converter, self._deinterlacer = Converter(tell), Deinterlacer()
        self._in_filter: deque[int] = deque()
        self._lacks_order = container.format.name in ONLY_DECODING_ORDER
        self._stamps: list[int] = []
        self._index: dict[int, int] = {}
        if self._lacks_order:
            # Chunks are counted as they are read, so that a damaged place would shift all times after it.
            self._index = {entry.pos + CHUNK_HEAD_BYTES: entry.timestamp for entry in stream.index_entries}
        self._owed: set[int] = set()
        self._sent = 0
        self._is_counted = stream.codec_context.name in ONE_FRAME_A_PACKET
        if self._is_counted:
            stream.codec_context.copy_opaque = True
        self._undecoded = self._held_back = 0
        self.objection: str | None = None
        self.unshown = 0
        self.is_cut = False

    @property
    def lost(self) -> int:
        """Frames lost since the last picture."""
        return self._undecoded + self._held_back

    def pictures(self) -> Generator[Picture | None, None, None]:
        """All pictures; None after a packet that gave none, for callers who wait no longer than they want to.

        av.error.FFmpegError: the container cannot be read on, by more than damage.
        """
        for packet in self._packets():
            for frame in self.decode(packet):
                yield from self._show(frame)
            yield None
        for done in self._deinterlacer.flush():
            yield from self._convert(done)

    def _packets(self) -> Iterator["Packet[VideoStream] | None"]:
        """The packets with something in them; None last."""
        import av
        import av.error

        failures = 0
        while True:
            try:
                for packet in self._container.demux(self._stream):
                    if packet.size:  # a recorder that dropped a frame writes an empty one; the end does too
                        failures, self.is_cut = 0, packet.is_corrupt
                        yield packet
                break
            except av.error.InvalidDataError:
                failures, self.is_cut = failures + 1, True
                if failures == MAX_FAILURES:
                    break
        yield None

    def decode(self, packet: "Packet[VideoStream] | None") -> list["VideoFrame"]:
        """The frames that a packet completes; None: the end. What the decoder refuses is counted."""
        import av
        import av.error

        decoder = self._stream.codec_context
        if self._lacks_order and packet is not None and packet.dts is not None:
            heapq.heappush(self._stamps, self._index.get(packet.pos or 0, packet.dts))
        if self._is_counted and packet is not None:
            packet.opaque = self._sent
            self._owed.add(self._sent)
            self._sent += 1
        try:
            return decoder.decode(packet)
        except av.error.EOFError:
            decoder.flush_buffers()
        except MemoryError:  # no damage of the frame, and the next one would fare no better
            raise
        except av.error.BlockingIOError:
            if not decoder.is_open:
                raise MemoryError("a decoder of videos gets no thread") from None
            self._note_refused(packet)
        except (av.error.FFmpegError, ValueError):
            self._note_refused(packet)
        return []

    def _note_refused(self, packet: "Packet[VideoStream] | None") -> None:
        """A packet came to nothing."""
        if packet is not None:
            self._undecoded += 1
            self._next_stamp()
            self._owed.discard(self._sent - 1)

    def _show(self, frame: "VideoFrame") -> Iterator[Picture]:
        if self._stream.time_base is not None:
            frame.time_base = self._stream.time_base  # which those that come last lack
        if self._lacks_order:
            frame.pts = self._next_stamp()
        if self._is_counted:
            self._undecoded += self._count_missing(frame)
        if frame.is_corrupt:
            self._undecoded += 1
            return
        self._in_filter.append(self._undecoded)
        self._undecoded = 0
        for done in self._deinterlacer.feed(frame):
            yield from self._convert(done)

    def _convert(self, frame: "VideoFrame") -> Iterator[Picture]:
        lost = self._held_back + (self._in_filter.popleft() if self._in_filter else 0)
        try:
            image = self._converter.bgr8(frame)
        except ValueError as error:
            self.objection, self._held_back = str(error), lost + 1
            self.unshown += 1
            return
        self._held_back = 0
        yield Picture(image, frame.time, lost)

    def _count_missing(self, frame: "VideoFrame") -> int:
        """How many packets before that of the frame have become none, and are too far back to become one."""
        place = frame.opaque
        if not isinstance(place, int):
            return 0
        self._owed.discard(place)
        missing = {owed for owed in self._owed if owed < place - REORDERED}
        self._owed -= missing
        return len(missing)

    def _next_stamp(self) -> int | None:
        """The earliest time that no frame has had, of a container that tells only when each is to be decoded."""
        return heapq.heappop(self._stamps) if self._stamps else None
