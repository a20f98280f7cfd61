"""What a folder holds: recordings, which are inputs of their own, or the frames of one."""

import os
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Final

from lightgesture.errors import InputError
from lightgesture.results.ownership import is_annotated_copy
from lightgesture.sources.bag_name import is_bag
from lightgesture.sources.folder import natural_key
from lightgesture.sources.pictures import is_picture_name

VIDEO_SUFFIXES: Final = frozenset(
    {
        *(".3g2", ".3gp", ".asf", ".avi", ".divx", ".dv", ".f4v", ".flv", ".m2t", ".m2ts", ".m2v", ".m4v"),
        *(".mkv", ".mod", ".mov", ".mp4", ".mpeg", ".mpg", ".mts", ".mxf", ".ogv", ".qt", ".tod", ".ts"),
        *(".vob", ".webm", ".wmv", ".264", ".265", ".h264", ".h265", ".hevc", ".mjpeg", ".mjpg"),
    }
)
"""File names that are taken for videos in a folder, in small letters; one that is named itself may have any."""


@dataclass(slots=True)
class Contents:
    """What lies in a folder, in natural order; paths begin with its own.

    recordings: videos and bags. pictures: how many lie there. picture_folders: in which folders. copies: annotated
    copies of ours, which are passed over. folders: how many were not looked into.
    """

    recordings: list[str] = field(default_factory=list)
    pictures: int = 0
    picture_folders: list[str] = field(default_factory=list)
    copies: int = 0
    folders: int = 0


def look_into(path: str, recursive: bool) -> Contents:
    """The contents of a folder. recursive: and of the folders in it. InputError: it cannot be read."""
    found = Contents()
    _look(path, recursive, found)
    return found


def _look(path: str, recursive: bool, found: Contents) -> None:
    try:
        with os.scandir(path) as entries:
            shown = [entry for entry in entries if not entry.name.startswith(".")]
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); name a readable folder") from None
    pictures = 0
    for entry in sorted(shown, key=lambda entry: natural_key(entry.name)):
        place = os.path.join(path, entry.name)
        if entry.is_dir(follow_symlinks=False):
            if is_bag(place):
                found.recordings.append(place)
            elif recursive:
                with suppress(InputError):  # a system's folder on a card, which nobody may read
                    _look(place, recursive, found)
            else:
                found.folders += 1
        elif is_annotated_copy(place):
            found.copies += 1
        elif entry.is_file() and (_has_video_name(place) or is_bag(place)):
            found.recordings.append(place)
        else:
            pictures += is_picture_name(place) and entry.is_file()
    if pictures:
        found.pictures += pictures
        found.picture_folders.append(path)


def _has_video_name(path: str) -> bool:
    return os.path.splitext(path)[1].lower() in VIDEO_SUFFIXES
