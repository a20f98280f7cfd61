"""One guarded reader of `.npz` archives: plain arrays and a JSON header, never a pickle, everything bounded.

A model file may come from anybody. So what the zip's directory promises (how many members, how large, of what names) is
checked before a member is opened, and what a member's own header promises before its data are read.
"""

import io
import json
import math
import re
import stat
import zipfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.files import FileRefusedError, read_whole

Arrays = Mapping[str, NDArray[Any]]

HEADER: Final = "header"
"""Name of the array that holds the JSON text."""
LARGEST_FILE: Final = 64 * 2**20
"""Bytes, packed or unpacked, beyond which an archive is not read: no file of ours comes near."""
LARGEST_HEADER: Final = 2**18
"""Bytes of the JSON text."""
MOST_MEMBERS: Final = 256
"""Arrays of one archive; ours have up to 40, those of older versions 150."""
MOST_AXES: Final = 4
LONGEST_LAYOUT: Final = 1024
"""Bytes of the text that tells shape and dtype of an array; NumPy writes 118 of them."""
WRITTEN_AS: Final = ".npy"
"""What follows the name of each member."""

_MAGIC = {b"\x93NUMPY\x01\x00": 2, b"\x93NUMPY\x02\x00": 4}
"""How an array begins in either version, and the bytes in which the length of its text follows."""

_LAYOUT = re.compile(
    rb"\{'descr': '([<>|=]?[iufU][0-9]{1,5})', 'fortran_order': (True|False), "
    rb"'shape': \(((?:[0-9]{1,12}, ?)*(?:[0-9]{1,12})?)\), *\}\s*"
)
"""The text as NumPy writes it: dtypes of whole numbers, floats and text, none of objects, which would be pickles. It
is matched and never evaluated."""

_DAMAGES = (
    ValueError,
    KeyError,
    EOFError,
    NotImplementedError,
    RecursionError,
    RuntimeError,
    SyntaxError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What a file that was cut, altered or made by somebody else may cause, an encrypted one included. What is read of it
is bounded, so that a memory that is too small is no damage."""


class ArchiveError(ValueError):
    """An archive that cannot be read: one line with the file and the reason; the caller adds what to do.

    is_missing: it is not there or may not be opened, so nothing is said about its content.
    """

    def __init__(self, file: Path, reason: str, is_missing: bool = False) -> None:
        super().__init__(" ".join(f"{file}: {reason}".split()))
        self.is_missing = is_missing


def read_archive(
    file: Path, is_wanted: Callable[[str], bool] = lambda _: True
) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """The JSON header and the arrays of a file, read-only.

    is_wanted: whether an array of this name is read; the others are only looked at in the directory. Raises
    ArchiveError.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(read_whole(file, LARGEST_FILE))) as archive:
            members = _members(archive)
            if HEADER not in members:
                raise ArchiveError(file, "has no header, so it is of an older version or no file of ours")
            header = _header(archive, members[HEADER])
            arrays = {
                name: _array(archive, entry)
                for name, entry in members.items()
                if name != HEADER and is_wanted(name)
            }
    except ArchiveError:
        raise
    except FileRefusedError as error:
        raise ArchiveError(file, str(error.strerror)) from error
    except OSError as error:
        raise ArchiveError(file, f"cannot be read ({error.strerror or error})", is_missing=True) from error
    except _DAMAGES as error:
        raise ArchiveError(file, f"is cut off or no archive of arrays ({error})") from error
    return header, arrays


def _members(archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    """The arrays by their names, by the word of the directory alone. Raises ValueError."""
    entries = archive.infolist()
    if len(entries) > MOST_MEMBERS:
        raise ValueError(f"{len(entries)} arrays are more than {MOST_MEMBERS}")
    if sum(entry.file_size for entry in entries) > LARGEST_FILE:
        raise ValueError(f"it unpacks to more than {LARGEST_FILE >> 20} MiB")
    members = {}
    for entry in entries:
        name = entry.filename.removesuffix(WRITTEN_AS)
        if name == entry.filename or not name.isidentifier() or name in members:
            raise ValueError(f"{entry.filename[:64]!r} is no name of an array, or stands twice")
        if stat.S_ISLNK(entry.external_attr >> 16):
            raise ValueError(f"{entry.filename} is a link")
        # Other methods may ask for memory by a number in the data.
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise ValueError(f"{entry.filename} is packed by another method than deflate")
        members[name] = entry
    return members


def _header(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> dict[str, Any]:
    if entry.file_size > LARGEST_HEADER:
        raise ValueError(f"its header has more than {LARGEST_HEADER} bytes")
    header = json.loads(_array(archive, entry).tobytes())
    if not isinstance(header, dict):
        raise ValueError("its header is no JSON object")
    return header


def _array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> NDArray[Any]:
    """One array, after its shape and dtype were found to fit the size that the directory tells. Raises ValueError."""
    with archive.open(entry) as stream:
        shape, is_fortran, dtype = _layout(stream, entry.filename)
        if len(shape) > MOST_AXES:
            raise ValueError(f"{entry.filename} has the shape {shape[:8]}")
        size = math.prod(shape) * dtype.itemsize
        if size != entry.file_size - stream.tell():
            raise ValueError(
                f"{entry.filename} has {entry.file_size} bytes, which do not fit the shape {shape}"
            )
        content = stream.read(size)
        # The end of the stream, where the check sum is compared, comes only with a read beyond the data.
        if len(content) != size or stream.read(1):
            raise ValueError(f"{entry.filename} is cut off")
    return np.frombuffer(content, dtype).reshape(shape, order="F" if is_fortran else "C")


def _layout(stream: IO[bytes], name: str) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Shape, whether it is in column order, dtype. Raises ValueError."""
    width = _MAGIC.get(stream.read(8))
    if width is None:
        raise ValueError(f"{name} is no array of version 1 or 2")
    length = int.from_bytes(stream.read(width), "little")
    if length > LONGEST_LAYOUT:
        raise ValueError(f"{name} describes itself in {length} bytes")
    match = _LAYOUT.fullmatch(stream.read(length))
    if match is None:
        raise ValueError(f"{name} holds something else than numbers or text, a pickle perhaps")
    shape = tuple(int(side) for side in match[3].split(b",") if side.strip())
    try:
        return shape, match[2] == b"True", np.dtype(match[1].decode("ascii"))
    except TypeError as error:  # seven bytes for a whole number
        raise ValueError(f"{name}: {error}") from None


def check_format(file: Path, header: Mapping[str, Any], kind: str, version: int, *older: int) -> None:
    """Refuse a file of another kind, or of a version that is neither this one nor an older one that will do. Raises
    ArchiveError."""
    if header.get("kind") != kind:
        raise ArchiveError(file, f"is no {kind} model")
    if header.get("format") not in (version, *older):
        raise ArchiveError(file, f"has format {header.get('format')!r:.40}, this version reads {version}")
