"""A folder of frames, in natural order of their names."""

import os
import re
from collections.abc import Iterator, Sequence

from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources.pictures import depth_of, is_picture_name, read_picture
from lightgesture.sources.types import Source

_NUMBER = re.compile(r"(\d+)")


class FrameFolder(Source):
    """The pictures of one folder, or those that `files` names; other files and folders in it are passed over.

    A folder has no container's time stamps: the time of a frame is its index divided by `fps`. A picture
    that cannot be read is left out and its index and time with it; after the last one InputError tells
    how many were left out and which was the first.
    """

    def __init__(self, path: str, fps: float, files: Sequence[str] = ()) -> None:
        self.name = path
        self._fps = fps
        self._files = list(files) or _list_pictures(path)
        self.frame_count = len(self._files)

    def __iter__(self) -> Iterator[Frame]:
        left_out: list[InputError] = []
        depth = depth_of(self.name)
        for index, file in enumerate(self._files):
            try:
                image = read_picture(os.path.join(self.name, file), depth)
            except InputError as error:
                left_out.append(error)
            else:
                yield Frame(image, index, round(index / self._fps, 6))
        if left_out:
            count = f"{len(left_out)} of {len(self._files)} pictures"
            raise InputError(f"{self.name}: {count} left out; the first: {left_out[0]}")


def natural_key(name: str) -> tuple[list[tuple[int, str]], str]:
    """Sort key by which frame 9 comes before frame 10, whatever their zeros and capitals."""
    parts = _NUMBER.split(name)
    key = [(int(part), "") if place % 2 else (0, part.casefold()) for place, part in enumerate(parts)]
    return key, name


def _list_pictures(path: str) -> list[str]:
    try:
        with os.scandir(path) as entries:
            files = [entry.name for entry in entries if is_picture_name(entry.name) and entry.is_file()]
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name a readable folder") from None
    if not files:
        raise InputError(
            f"{path}: no pictures in this folder, and no videos; name a folder of either, or with --recursive one "
            "that has such folders"
        )
    return sorted(files, key=natural_key)
