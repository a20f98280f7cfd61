"""From the inputs of the command line to tasks, one for each stream of frames, and what is told of each: small frozen
values that cross processes."""

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from lightgesture.config.settings import DecodeSettings
from lightgesture.results.stems import output_stems
from lightgesture.sources import Source, is_picture_name, natural_key, open_source
from lightgesture.sources.folder import FrameFolder
from lightgesture.sources.standard_input import STANDARD_INPUT

Status = Literal["ok", "failed", "done before"]


@dataclass(frozen=True, slots=True)
class Task:
    """One input.

    place: position among the inputs, 0-based. path: where it lies. name: what its records call it. stem: of its
    output files. pictures: names of the frames in the folder `path`, where the user named pictures; empty for all.
    """

    place: int
    path: str
    name: str
    stem: str
    pictures: tuple[str, ...] = ()

    @property
    def is_standard_input(self) -> bool:
        """Whether its frames come through this process alone."""
        return self.path == STANDARD_INPUT and not os.path.lexists(self.path)

    def open(self, settings: DecodeSettings) -> Source:
        """The open source of its frames. InputError: one line."""
        if self.pictures:
            return FrameFolder(self.path, settings.fps, self.pictures)
        return open_source(self.path, settings.source_options)

    def absolute(self) -> "Task":
        """The same for a process that runs in another folder."""
        return replace(self, path=os.path.abspath(self.path))


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one input.

    message: the error line of a failed one. seconds: spent on it. files: names of the files written.
    """

    status: Status
    message: str | None = None
    frames: int = 0
    instructions: int = 0
    rejected: int = 0
    seconds: float = 0.0
    files: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Opened:
    """The input at `place` was opened and promises `frames`; None where it does not say."""

    place: int
    frames: int | None


@dataclass(frozen=True, slots=True)
class Advanced:
    """So many more frames of an input are done."""

    place: int
    frames: int


@dataclass(frozen=True, slots=True)
class Printed:
    """Lines of results of an input, for standard output."""

    place: int
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Done:
    """An input is finished; nothing comes after."""

    place: int
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class Remarked:
    """Something to be told once, whichever inputs it comes with."""

    place: int
    text: str


Message = Opened | Advanced | Printed | Remarked | Done
Hear = Callable[[Message], None]
"""Takes the messages of all inputs, in the order in which they come about."""


def make_tasks(inputs: Sequence[str]) -> list[Task]:
    """A task for each input, in the order given.

    Several pictures of one folder, which is what a glob of frames gives, are the frames of one input that is
    named like the folder; a single picture stays alone. Its place is that of the first of them.
    """
    groups = _picture_groups(inputs)
    paths: dict[str, tuple[str, ...]] = {}
    for name in inputs:
        folder = os.path.dirname(name)
        if os.path.basename(name) in groups.get(folder, ()):
            paths.setdefault(folder or os.curdir, groups[folder])
        else:
            paths.setdefault(name, ())
    stems = output_stems(list(paths))
    return [
        Task(place, path, path, stem, pictures)
        for place, ((path, pictures), stem) in enumerate(zip(paths.items(), stems, strict=True))
    ]


def _picture_groups(inputs: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Folder to the pictures named in it, natural order, where there are at least two."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in inputs:
        if is_picture_name(name) and os.path.isfile(name):
            found[os.path.dirname(name)].append(os.path.basename(name))
    return {
        folder: tuple(sorted(names, key=natural_key)) for folder, names in found.items() if len(names) > 1
    }
