"""How long a video file should be by its own headers, so that one that was cut off is known from a whole one.

Counts of frames and durations are hints: edit lists, longer sound and dropped frames make them wrong. The sizes that a
container writes around its contents are not. Layouts: RIFF (AVI), ISO/IEC 14496-12 (MP4, QuickTime), RFC 8794
(Matroska, WebM).
"""

import os
from typing import IO

MP4_BOXES = (b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip", b"styp")
"""Types of the box that opens an MP4 or QuickTime file, after its size of four bytes."""

_EBML, _SEGMENT = b"\x1aE\xdf\xa3", b"\x18S\x80g"
_WIDE_BOX = 1


def is_cut_off(path: str) -> bool:
    """Whether the headers of a video promise more bytes than the file has; False where they promise nothing."""
    with open(path, "rb") as stream:
        size = os.fstat(stream.fileno()).st_size
        start = stream.read(8)
        stream.seek(0)
        if start[:4] == b"RIFF":
            return _end_of_riff(stream, size) > size
        if start[4:] in MP4_BOXES:
            return _end_of_boxes(stream, size) > size
        if start[:4] == _EBML:
            return _end_of_segment(stream) > size
    return False


def _end_of_riff(stream: IO[bytes], size: int) -> int:
    """Where the last of the RIFF chunks ends, of which a long AVI has several."""
    end = 0
    while end < size:
        stream.seek(end)
        head = stream.read(8)
        length = int.from_bytes(head[4:8], "little")
        if head[:4] != b"RIFF" or length in (0, 0xFFFFFFFF):  # not written yet when the recorder stopped
            break
        end += 8 + length
    return end


def _end_of_boxes(stream: IO[bytes], size: int) -> int:
    """Where the last of the boxes ends."""
    end = 0
    while end < size:
        stream.seek(end)
        head = stream.read(16)
        length = int.from_bytes(head[:4], "big")
        if length == _WIDE_BOX:
            length = int.from_bytes(head[8:16], "big")
        if length < 8 or not head[4:8].isalnum():  # up to the end of the file, or no box
            break
        end += length
    return end


def _end_of_segment(stream: IO[bytes]) -> int:
    """Where the Matroska segment ends; 0 where its length was not written."""
    end = 0
    for wanted in (_EBML, _SEGMENT):
        stream.seek(end)
        head = stream.read(12)
        width = 9 - head[4].bit_length() if len(head) == 12 and head[:4] == wanted else 9
        if width > 8:
            return 0
        length = int.from_bytes(head[4 : 4 + width], "big") & ((1 << 7 * width) - 1)
        if length == (1 << 7 * width) - 1:
            return 0
        end += 4 + width + length
    return end
