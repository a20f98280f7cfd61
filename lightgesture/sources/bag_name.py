"""Which files and folders are bags, told by their names: asked of every input, and so apart from what reads bags."""

import os
import re
from pathlib import Path

FILE_SUFFIXES = (".bag", ".mcap", ".db3", ".bag.active")
"""Endings of the files of bags; a recorder of ROS 1 that was killed leaves the last one."""

METADATA = "metadata.yaml"
"""The file in a folder that makes it a bag of ROS 2."""

_METADATA_KEY, _METADATA_BYTES = b"rosbag2_bagfile_information", 4096
_PART = re.compile(r"(?P<bag>.+?)(_\d+)?\.(db3|mcap)(-wal|-shm)?")


def is_bag(path: str) -> bool:
    """Whether the name is that of a bag: a file's by its ending, a folder's by what lies in it.

    The folder of a recorder that was killed has no metadata, but the parts of one bag of ROS 2 and nothing else.
    """
    if os.path.isdir(path):
        return _is_metadata(os.path.join(path, METADATA)) or _has_only_parts(Path(path))
    return os.path.isfile(path) and path.lower().endswith(FILE_SUFFIXES)


def _has_only_parts(folder: Path) -> bool:
    try:
        names = [one.name for one in folder.iterdir() if not one.name.startswith(".")]
    except OSError:
        return False
    parts = [match for name in names if (match := _PART.fullmatch(name))]
    return bool(parts) and len(parts) == len(names) and len({match["bag"] for match in parts}) == 1


def _is_metadata(path: str) -> bool:
    """Whether it is the metadata of a bag; other programs have files of that name too."""
    try:
        with open(path, "rb") as stream:
            return _METADATA_KEY in stream.read(_METADATA_BYTES)
    except OSError:
        return False
