"""How many pixels a picture file promises, read without decoding it: some hundred bytes can ask for gigabytes."""

import re
import struct
from typing import Final

_JPEG_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_JPEG_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
_START_OF_SCAN, _FILL = 0xDA, 0xFF

_PNM: Final = re.compile(rb"P[1-6](?:\s|#[^\n]*\n)+(\d{1,9})(?:\s|#[^\n]*\n)+(\d{1,9})")
_PNM_BYTES: Final = 4096
"""In which the numbers of a portable pixmap must stand, comments included."""

_TIFF_WIDTH, _TIFF_HEIGHT = 256, 257
_TIFF_SHORT = 3
_TIFF_ENTRIES: Final = 512
"""Entries of a TIFF directory that are looked at."""

_CODESTREAM = b"\xff\x4f\xff\x51"
"""How a JPEG 2000 picture begins, in whatever file it lies."""

Size = tuple[int, int]
"""Width and height."""


def picture_size(content: bytes) -> Size | None:
    """Width and height that a file of a known format promises, the larger where it promises two; None: it is none.

    Known are those of `pictures.PICTURE_SUFFIXES`: BMP, JPEG, JPEG 2000, PNG, portable pixmaps, TIFF, WebP.
    """
    try:
        for start, read in _FORMATS:
            if content.startswith(start):
                return read(content)
    except (struct.error, IndexError, OverflowError, ValueError):  # a place beyond what Python can count
        pass
    return None


def _png(content: bytes) -> Size | None:
    """The largest of the picture and of the frames of an animation; None where a chunk goes beyond the file's end.

    OpenCV makes room for a chunk by the word of its length, again and again: 73 bytes took it four gigabytes.
    """
    sizes = [struct.unpack_from(">II", content, 16)]
    place = 8
    while place < len(content):
        length, name = struct.unpack_from(">I4s", content, place)
        if place + 12 + length > len(content):
            return None
        if name == b"fcTL":
            sizes.append(struct.unpack_from(">II", content, place + 12))
        if name == b"IEND":
            break
        place += 12 + length
    width, height = max(sizes, key=lambda size: size[0] * size[1])
    return width, height


def _jpeg(content: bytes) -> Size | None:
    """The size in the last segment of a frame before the scan; a thumbnail lies within another segment."""
    place, found = 2, None
    while place + 4 <= len(content) and content[place] == _FILL:
        kind = content[place + 1]
        if kind == _START_OF_SCAN:
            break
        if kind == _FILL or kind in _JPEG_ALONE:
            place += 1 if kind == _FILL else 2
            continue
        if kind in _JPEG_FRAMES:
            height, width = struct.unpack_from(">HH", content, place + 5)
            found = width, height
        place += 2 + struct.unpack_from(">H", content, place + 2)[0]
    return found


def _bmp(content: bytes) -> Size:
    (head,) = struct.unpack_from("<I", content, 14)
    width, height = struct.unpack_from("<HH" if head == 12 else "<ii", content, 18)
    return abs(width), abs(height)


def _pnm(content: bytes) -> Size | None:
    match = _PNM.match(content[:_PNM_BYTES])
    return None if match is None else (int(match[1]), int(match[2]))


def _tiff(content: bytes) -> Size:
    """Of the first picture; the larger where a tag stands twice."""
    order = "<" if content[:2] == b"II" else ">"
    (kind,) = struct.unpack_from(f"{order}H", content, 2)
    is_big = kind == 43
    (place,) = struct.unpack_from(order + ("Q" if is_big else "I"), content, 8 if is_big else 4)
    (entries,) = struct.unpack_from(order + ("Q" if is_big else "H"), content, place)
    place, step, value_at = place + (8 if is_big else 2), 20 if is_big else 12, 12 if is_big else 8
    sides = {_TIFF_WIDTH: 0, _TIFF_HEIGHT: 0}
    for number in range(min(entries, _TIFF_ENTRIES)):
        tag, of = struct.unpack_from(f"{order}HH", content, place + number * step)
        if tag in sides:
            code = "H" if of == _TIFF_SHORT else "I"
            (side,) = struct.unpack_from(order + code, content, place + number * step + value_at)
            sides[tag] = max(sides[tag], side)
    return sides[_TIFF_WIDTH], sides[_TIFF_HEIGHT]


def _webp(content: bytes) -> Size | None:
    kind = content[12:16]
    if kind == b"VP8X":
        return 1 + int.from_bytes(content[24:27], "little"), 1 + int.from_bytes(content[27:30], "little")
    if kind == b"VP8L":
        (bits,) = struct.unpack_from("<I", content, 21)
        return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
    if kind == b"VP8 ":
        width, height = struct.unpack_from("<HH", content, 26)
        return width & 0x3FFF, height & 0x3FFF
    return None


def _jpeg2000(content: bytes) -> Size | None:
    """The larger of what the file and the picture in it say."""
    sizes = []
    box, stream = content.find(b"ihdr"), content.find(_CODESTREAM)
    if box >= 0:
        height, width = struct.unpack_from(">II", content, box + 4)
        sizes.append((width, height))
    if stream >= 0:
        right, below = struct.unpack_from(">II", content, stream + 8)
        sizes.append((right, below))
    return max(sizes, key=lambda size: size[0] * size[1], default=None)


_FORMATS: Final = (
    (b"\x89PNG\r\n\x1a\n", _png),
    (b"\xff\xd8\xff", _jpeg),
    (b"BM", _bmp),
    *((b"P%d" % number, _pnm) for number in range(1, 7)),
    *((start, _tiff) for start in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")),
    (b"RIFF", _webp),
    *((start, _jpeg2000) for start in (b"\0\0\0\x0cjP  ", _CODESTREAM)),
)
"""How files begin, and what reads their size."""
