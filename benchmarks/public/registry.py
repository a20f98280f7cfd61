"""The public sets that can be read, by the name of their format."""

from collections.abc import Callable
from pathlib import Path
from typing import Final

from lightgesture.benchmarks.divers.pictures import DiverFrame
from lightgesture.benchmarks.public.caddy import read_caddy
from lightgesture.benchmarks.public.hagrid import read_hagrid
from lightgesture.benchmarks.public.scubanet import read_scubanet
from lightgesture.errors import InputError

Read = Callable[[Path], list[DiverFrame]]

FORMATS: Final[dict[str, Read]] = {"scubanet": read_scubanet, "caddy": read_caddy, "hagrid": read_hagrid}
"""Name -> what reads the frames of a folder. Raises InputError."""


def read_public(folder: Path, name: str, warn: Callable[[str], None]) -> list[DiverFrame]:
    """The pictures of a set that are there; how many are not is told.

    InputError: there is no such folder, it is no set of this format, or not one of its pictures is there.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; name the one that holds the set")
    frames = FORMATS[name](folder)
    there = [frame for frame in frames if frame.path.is_file()]
    if not there:
        raise InputError(
            f"{folder}: holds none of the {len(frames)} pictures of its {name} labels; unpack them there"
        )
    if len(there) < len(frames):
        warn(
            f"{folder}: {len(frames) - len(there)} of {len(frames)} labelled pictures are missing and left out"
        )
    return there
