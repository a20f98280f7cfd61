"""JPEG files found in a stream of bytes, whatever stands between them."""

import re
from typing import Final

_START, _END = b"\xff\xd8\xff", b"\xff\xd9"
_SCAN_END = re.compile(rb"\xff[^\x00\xd0-\xd7\xff]", re.DOTALL)
"""The next marker after compressed data: neither a stuffed byte, nor a restart, nor a fill."""

_IMAGE_START, _IMAGE_END, _SCAN, _FILL = 0xD8, 0xD9, 0xDA, 0xFF
_ALONE = frozenset({0x01, *range(0xD0, 0xD8)})
"""Markers without a length."""

_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""Markers of segments that tell the picture's size."""


MAX_BYTES: Final = 16 << 20
"""Longest file; a longer one is no picture."""

ENDLESS: Final = 3
"""Files one after the other without the mark of their end, and none with it, after which the camera is taken for one
that never sends it; any other such file was cut off."""

MAX_PIXELS: Final = 40_000_000
"""Most pixels of a picture, against files that promise more than fits the memory."""


class JpegSplitter:
    """Cuts whole JPEG files out of bytes that come in pieces.

    The segments of a file are stepped over by their lengths, so that a thumbnail inside is no picture of its own.
    Anything between the files, such as the headers of a multipart stream, is passed over, and so are files that are
    damaged, longer than `max_bytes`, or larger than `max_pixels`.

    passed_over: of each file that `feed` gave last, how many bytes, zeros apart, were passed over before it.
    """

    def __init__(self, max_bytes: int = MAX_BYTES, max_pixels: int = MAX_PIXELS) -> None:
        self._max_bytes, self._max_pixels = max_bytes, max_pixels
        self._buffer = bytearray()
        self._is_begun = self._is_in_scan = self._has_scan = False
        self._endless: int | None = 0
        self._place = self._passed_over = 0
        self.passed_over: list[int] = []

    @property
    def held(self) -> int:
        """Bytes that wait for the rest of their picture."""
        return len(self._buffer)

    def feed(self, data: bytes) -> list[bytes]:
        """The files that are whole now, in order."""
        self._buffer += data
        found: list[bytes] = []
        self.passed_over.clear()
        while self._step(found):
            pass
        if len(self._buffer) > self._max_bytes:
            self._discard(len(self._buffer))
        return found

    def _step(self, found: list[bytes]) -> bool:
        """Get on by one marker; False: more bytes are needed."""
        if not self._is_begun:
            return self._find_start()
        return self._leave_scan() if self._is_in_scan else self._read_marker(found)

    def _find_start(self) -> bool:
        start = self._buffer.find(_START)
        if start < 0:
            self._pass_over(max(0, len(self._buffer) - len(_START) + 1))
            return False
        self._pass_over(start)
        self._is_begun, self._is_in_scan, self._has_scan, self._place = True, False, False, 2
        return True

    def _leave_scan(self) -> bool:
        match = _SCAN_END.search(self._buffer, self._place)
        # The last byte may be the first half of a marker.
        self._place = match.start() if match else max(self._place, len(self._buffer) - 1)
        self._is_in_scan = match is None
        return match is not None

    def _read_marker(self, found: list[bytes]) -> bool:
        buffer, place = self._buffer, self._place
        if len(buffer) < place + 2:
            return False
        kind = buffer[place + 1]
        if buffer[place] == _FILL and kind == _IMAGE_START and self._is_whole():
            found.append(bytes(buffer[:place]) + _END)
            self._take(place)
        elif buffer[place] != _FILL or kind in (0x00, _IMAGE_START):  # damaged, or cut off by the next one
            self._discard(place)
        elif kind == _FILL:
            self._place += 1
        elif kind == _IMAGE_END:
            found.append(bytes(buffer[: place + 2]))
            self._endless = None
            self._take(place + 2)
        elif kind in _ALONE:
            self._place += 2
        else:
            return self._skip_segment(kind)
        return True

    def _skip_segment(self, kind: int) -> bool:
        buffer, place = self._buffer, self._place
        if len(buffer) < place + 9:  # enough for a size; no segment stands so near the end of a file
            return False
        length = int.from_bytes(buffer[place + 2 : place + 4], "big")
        if length < 2 or (kind in _FRAMES and not self._is_fair(bytes(buffer[place + 5 : place + 9]))):
            self._discard(2)
        else:
            self._place += 2 + length
            self._is_in_scan = kind == _SCAN
            self._has_scan = self._has_scan or self._is_in_scan
        return True

    def _is_fair(self, size: bytes) -> bool:
        height, width = int.from_bytes(size[:2], "big"), int.from_bytes(size[2:], "big")
        return 0 < height * width <= self._max_pixels

    def _is_whole(self) -> bool:
        """Whether a file that the next one ends is all that its camera sends."""
        if self._endless is None or not self._has_scan:
            return False
        self._endless += 1
        return self._endless > ENDLESS

    def _take(self, length: int) -> None:
        self.passed_over.append(self._passed_over)
        self._passed_over, self._is_begun = 0, False
        del self._buffer[:length]

    def _discard(self, length: int) -> None:
        self._pass_over(length)
        self._is_begun = False

    def _pass_over(self, length: int) -> None:
        if length:
            self._passed_over += length - self._buffer.count(0, 0, length)
            del self._buffer[:length]
