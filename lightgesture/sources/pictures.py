"""Single pictures: whatever they hold becomes uint8 (height, width, 3), BGR."""

import os
import re
from functools import cache
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.console import warn
from lightgesture.errors import InputError
from lightgesture.features.files import read_whole
from lightgesture.features.image import BitDepth, as_bgr8
from lightgesture.features.types import Image
from lightgesture.sources.picture_size import picture_size

PICTURE_SUFFIXES = frozenset(
    {
        *(".bmp", ".dib", ".jpe", ".jpeg", ".jpg", ".jp2", ".pbm", ".pgm"),
        *(".png", ".pnm", ".ppm", ".tif", ".tiff", ".webp"),
    }
)
"""File names that are taken for pictures, in small letters."""

LARGEST_FILE = 512 << 20
"""Bytes of a picture file that is read."""

MOST_PIXELS = 120_000_000
"""Of a picture that is decoded: 360 MB of memory. Cameras of telephones reach 108 million."""

# A depth beyond 8 bits is kept, to be scaled here; everything else is OpenCV's plain reading to BGR,
# turned upright where the picture says so.
_FLAGS = cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH

_HUFFMAN_TABLES, _START_OF_SCAN = 0xC4, 0xDA
_END_OF_IMAGE = b"\xff\xd9"
# Magic number, width, height and the largest value of a portable pixmap, with comments between.
_PNM_HEADER = re.compile(rb"P[2356]" + rb"(?:\s|#[^\n]*\n)+(\d+)" * 3)


def is_picture_name(path: str | os.PathLike[str]) -> bool:
    """Whether the file's name is that of a picture; hidden files (thumbnails, resource forks) are none."""
    name = os.path.basename(os.fspath(path))
    return not name.startswith(".") and os.path.splitext(name)[1].lower() in PICTURE_SUFFIXES


def read_picture(path: str | os.PathLike[str], depth: BitDepth | None = None) -> Image:
    """Read a picture to uint8 (height, width, 3), BGR; any name that the system can open will do.

    Grey, 16-bit and four-channel pictures are converted; transparency is dropped. depth: of the pictures of a folder,
    which are read alike; None: from this picture alone. InputError: no such file, empty, cut off, or nothing that
    OpenCV reads.
    """
    name = os.fspath(path)
    content = _read_bytes(name)
    if _is_cut_jpeg(content):
        raise InputError(f"{name}: the picture is cut off; copy it again or leave it out")
    size = picture_size(content)
    if size is not None and size[0] * size[1] > MOST_PIXELS:
        raise InputError(
            f"{name}: promises {size[0]} x {size[1]} pixels, more than {MOST_PIXELS:,}; make it smaller"
        )
    image = decode_picture(content)
    if image is None:
        raise InputError(
            f"{name}: is no picture that can be read; convert it to PNG or JPEG, or leave it out"
        )
    depth = depth or depth_of(name)
    if image.dtype == np.uint16 and (header := _PNM_HEADER.match(content)):
        depth.declare(min(int(header[3]), 0xFFFF))
    try:
        return depth.bgr8(image)
    except ValueError as error:
        raise InputError(f"{name}: {error}") from error


def to_image(content: bytes | Image) -> Image:
    """A picture of a stream, uint8 (height, width, 3), BGR. InputError: the JPEG file is none that can be decoded."""
    if not isinstance(content, bytes):
        return content
    image = decode_picture(content)
    if image is None:
        raise InputError("is damaged")
    return as_bgr8(image)


def depth_of(name: str) -> BitDepth:
    """The bit depth of a source that is to be read, which tells the user where it must be raised."""
    return BitDepth(lambda text: warn(f"{name}: {text}"))


def decode_picture(content: bytes | NDArray[np.uint8]) -> NDArray[Any] | None:
    """The pixels of a picture file in any depth, grey as BGR; None: it is none that OpenCV reads, or too large."""
    size = picture_size(bytes(content))
    if size is None or size[0] * size[1] > MOST_PIXELS:
        return None
    # imdecode and not imread, which cannot open every name on every system
    data = np.frombuffer(content, np.uint8)
    place = _scan_without_tables(data)
    if place:
        data = np.concatenate([data[:place], _standard_tables(), data[place:]])
    try:
        image: NDArray[Any] | None = cv2.imdecode(data, _FLAGS) if data.size else None
    except cv2.error:  # a header that promises more pixels than OpenCV takes
        return None
    return image


def _scan_without_tables(data: NDArray[np.uint8]) -> int:
    """Where the scan of a JPEG file without Huffman tables begins, 0 for all others.

    Cameras that send JPEG files as video leave the tables out, which are always the same; without them OpenCV makes
    noise of the file and says nothing.
    """
    if data.size < 4 or bytes(data[:2]) != b"\xff\xd8":
        return 0
    place = 2
    while place + 4 <= data.size and data[place] == 0xFF and data[place + 1] != _HUFFMAN_TABLES:
        if data[place + 1] == _START_OF_SCAN:
            return place
        is_fill = data[place + 1] == 0xFF
        place += 1 if is_fill else 2 + (int(data[place + 2]) << 8 | int(data[place + 3]))
    return 0


@cache
def _standard_tables() -> NDArray[np.uint8]:
    """The segments of Huffman tables by ITU-T T.81, annex K.3, as OpenCV writes them into every file."""
    data = np.asarray(cv2.imencode(".jpg", np.zeros((8, 8, 3), np.uint8))[1], np.uint8).ravel()
    tables: list[NDArray[np.uint8]] = []
    place = 2
    while data[place + 1] != _START_OF_SCAN:
        end = place + 2 + (int(data[place + 2]) << 8 | int(data[place + 3]))
        if data[place + 1] == _HUFFMAN_TABLES:
            tables.append(data[place:end])
        place = end
    return np.concatenate(tables)


def _read_bytes(path: str) -> bytes:
    try:
        content = read_whole(path, LARGEST_FILE)
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder; name the pictures in it, as in '{path}/*.jpg'") from None
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{path}: cannot be read ({reason}); name a readable file") from None
    if not content:
        raise InputError(f"{path}: is empty (0 bytes); copy it again or leave it out")
    return content


def _is_cut_jpeg(content: bytes) -> bool:
    """Whether a JPEG has no end: libjpeg fills what is missing with grey and calls that a success.

    The segments before the scan are stepped over, for they may hold a thumbnail with an end of its own.
    In a scan every 0xFF is followed by a stuffed zero, so that the mark of the end is found by searching.
    """
    if not content.startswith(b"\xff\xd8\xff"):
        return False
    place = 2
    while place + 4 <= len(content) and content[place] == 0xFF and content[place + 1] != _START_OF_SCAN:
        is_fill = content[place + 1] == 0xFF
        place += 1 if is_fill else 2 + int.from_bytes(content[place + 2 : place + 4], "big")
    return content.find(_END_OF_IMAGE, place) < 0
