"""Which files this program wrote: nothing else is ever replaced."""

import os
from pathlib import Path
from typing import Final

ANNOTATED: Final = "_annotated.mp4"
"""What is put to the stem of an input for the copy with everything drawn in."""

MARK: Final = "annotated by lightgesture"
"""Stands in the metadata of such a copy."""

SOFTWARE: Final = "lightgesture"
"""Likewise in those of a plot."""

_BYTES = 1 << 16
"""Bytes at the start or the end of a file that are looked at."""

_STARTS = {
    ".jsonl": b'{"type":"',
    ".csv": b"type,source,frame,time_s",
    ".vtt": b"WEBVTT\n\nNOTE Instructions read from",
}
"""How files of records begin."""


def is_ours(path: Path) -> bool:
    """Whether a file has what files of results have in them."""
    try:
        if path.suffix == ".mp4":
            return is_annotated_copy(path)
        with path.open("rb") as stream:
            start = stream.read(_BYTES)
    except OSError:
        return False
    if path.suffix == ".png":
        return start.startswith(b"\x89PNG") and f"Software\0{SOFTWARE}".encode("ascii") in start
    return path.suffix in _STARTS and start.startswith(_STARTS[path.suffix])


def is_annotated_copy(path: str | os.PathLike[str]) -> bool:
    """Whether it is a video that this program drew in; its metadata stand at its end."""
    if not os.fspath(path).endswith(ANNOTATED):
        return False
    try:
        with open(path, "rb") as stream:
            stream.seek(max(0, os.fstat(stream.fileno()).st_size - _BYTES))
            return MARK.encode("ascii") in stream.read()
    except OSError:
        return False
