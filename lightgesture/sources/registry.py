"""Which class reads which kind of input."""

import glob
import os
from collections.abc import Callable

from lightgesture.errors import InputError
from lightgesture.sources.folder import FrameFolder
from lightgesture.sources.types import Source
from lightgesture.sources.video import VideoFile

DEFAULT_FPS = 30.0
"""Frames a second of a folder of frames, where the user names no other."""

SOURCES: dict[str, Callable[[str, float], Source]] = {
    "folder": FrameFolder,
    "video": lambda path, fps: VideoFile(path),  # noqa: ARG005 - the container has its own clock
}
"""Kind of input to what opens it, given the path and the rate that is used where there are no time stamps."""


def open_source(path: str | os.PathLike[str], fps: float = DEFAULT_FPS) -> Source:
    """Open a video file or a folder of frames; use the result in a `with` block and iterate it once.

    fps: frames a second of a folder, above 0; a video has its own time stamps. InputError: one line that
    says what is wrong with this input.
    """
    name = os.fspath(path)
    return SOURCES[_kind(name)](name, fps)


def _kind(name: str) -> str:
    if os.path.isdir(name):
        return "folder"
    if os.path.isfile(name):
        return "video"
    if os.path.lexists(name):
        raise InputError(f"{name}: is neither a file nor a folder; name a video or a folder of frames")
    if glob.has_magic(name):
        raise InputError(f"{name}: matches no file; check the pattern")
    raise InputError(f"{name}: no such file or folder; check the name")
