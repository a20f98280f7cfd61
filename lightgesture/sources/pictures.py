"""Single pictures: whatever they hold becomes uint8 (height, width, 3), BGR."""

import os
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError

PICTURE_SUFFIXES = frozenset(
    {
        *(".bmp", ".dib", ".jpe", ".jpeg", ".jpg", ".jp2", ".pbm", ".pgm"),
        *(".png", ".pnm", ".ppm", ".tif", ".tiff", ".webp"),
    }
)
"""File names that are taken for pictures, in small letters."""

SENSOR_BITS = (10, 12, 14, 16)
"""Bits that cameras fill of a 16-bit picture: the least that holds the brightest pixel is full scale."""

# A depth beyond 8 bits is kept, to be scaled here; everything else is OpenCV's plain reading to BGR,
# turned upright where the picture says so.
_FLAGS = cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH

_START_OF_SCAN = 0xDA
_END_OF_IMAGE = b"\xff\xd9"


def is_picture_name(path: str | os.PathLike[str]) -> bool:
    """Whether the file's name is that of a picture; hidden files (thumbnails, resource forks) are none."""
    name = os.path.basename(os.fspath(path))
    return not name.startswith(".") and os.path.splitext(name)[1].lower() in PICTURE_SUFFIXES


def read_picture(path: str | os.PathLike[str]) -> NDArray[np.uint8]:
    """Read a picture to uint8 (height, width, 3), BGR; any name that the system can open will do.

    Grey, 16-bit and four-channel pictures are converted; transparency is dropped. InputError: no such
    file, empty, cut off, or nothing that OpenCV reads.
    """
    content = _read_bytes(os.fspath(path))
    if _is_cut_jpeg(content):
        raise InputError(f"{os.fspath(path)}: the picture is cut off; copy it again or leave it out")
    image = _decode(content)
    if image is None:
        raise InputError(
            f"{os.fspath(path)}: is no picture that can be read; convert it to PNG or JPEG, or leave it out"
        )
    try:
        return to_bgr8(image)
    except ValueError as error:
        raise InputError(f"{os.fspath(path)}: {error}; save it with 8 or 16 bits a channel") from error


def to_image(content: bytes | NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture of a stream, uint8 (height, width, 3), BGR. InputError: the JPEG file is none that can be decoded."""
    if not isinstance(content, bytes):
        return content
    image = _decode(content)
    if image is None:
        raise InputError("is damaged")
    return to_bgr8(image)


def to_bgr8(image: NDArray[Any]) -> NDArray[np.uint8]:
    """Convert uint8 or uint16, (height, width) or (height, width, 1, 3 or 4), to uint8 (height, width, 3).

    Four channels are BGR and transparency, which is dropped. ValueError: another type or shape.
    """
    channels = 1 if image.ndim == 2 else image.shape[-1]
    if image.ndim not in (2, 3) or channels not in (1, 3, 4) or image.size == 0:
        raise ValueError(f"shape {image.shape} is no grey or colour picture")
    if image.dtype == np.uint16:
        image = _scale_16_bit(image)
    elif image.dtype != np.uint8:
        raise ValueError(f"holds {image.dtype} values")
    if channels == 1:
        image = cv2.cvtColor(image.reshape(image.shape[:2]), cv2.COLOR_GRAY2BGR)
    elif channels == 4:
        image = cv2.cvtColor(image, cv2.COLOR_BGRA2BGR)
    return np.ascontiguousarray(image, dtype=np.uint8)


def _scale_16_bit(image: NDArray[np.uint16]) -> NDArray[np.uint8]:
    """Full scale of the sensor to 255; divided by 257 where all 16 bits are used."""
    brightest = int(image.max())
    full_scale = next(2**bits - 1 for bits in SENSOR_BITS if brightest < 2**bits)
    return np.asarray(cv2.convertScaleAbs(image, alpha=255.0 / full_scale), dtype=np.uint8)


def _read_bytes(path: str) -> bytes:
    try:
        content = Path(path).read_bytes()
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


def _decode(content: bytes) -> NDArray[Any] | None:
    # imdecode and not imread, which cannot open every name on every system
    try:
        image: NDArray[Any] | None = cv2.imdecode(np.frombuffer(content, np.uint8), _FLAGS)
    except cv2.error:  # a header that promises more pixels than OpenCV takes
        return None
    return image


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
