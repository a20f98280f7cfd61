"""From the inputs of the command line to tasks, one for each stream of frames, and what is told of each: small frozen
values that cross processes."""

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import InputError
from lightgesture.results.ownership import is_annotated_copy
from lightgesture.results.stems import output_stems
from lightgesture.sources import Source, is_picture_name, natural_key, open_source
from lightgesture.sources.address import hide_login
from lightgesture.sources.bag_name import is_bag
from lightgesture.sources.chapters import JoinedVideos, group_chapters
from lightgesture.sources.contents import look_into
from lightgesture.sources.folder import FrameFolder
from lightgesture.sources.standard_input import STANDARD_INPUT

Status = Literal["ok", "failed", "done before"]


@dataclass(frozen=True, slots=True)
class Task:
    """One input.

    place: position among the inputs, 0-based. path: where it lies. name: what its records call it. stem: of its
    output files. pictures: names of the frames in the folder `path`, where the user named pictures; empty for all.
    chapters: paths of all files of a recording, where it has several; the first is `path`.
    """

    place: int
    path: str
    name: str
    stem: str
    pictures: tuple[str, ...] = ()
    chapters: tuple[str, ...] = ()

    @property
    def is_standard_input(self) -> bool:
        """Whether its frames come through this process alone."""
        return self.path == STANDARD_INPUT and not os.path.lexists(self.path)

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it is read from: of a recording with chapters all, of a folder or standard input none."""
        return self.chapters or ((self.path,) if os.path.isfile(self.path) else ())

    def open(self, settings: DecodeSettings) -> Source:
        """The open source of its frames. InputError: one line."""
        if self.pictures:
            return FrameFolder(self.path, settings.fps, self.pictures)
        if is_annotated_copy(self.path):
            raise InputError(f"{self.name}: is an annotated copy; decode the video that it was made of")

        def open_one(path: str) -> Source:
            return open_source(path, settings.source_options)

        return JoinedVideos(self.chapters, open_one) if self.chapters else open_one(self.path)

    def absolute(self) -> "Task":
        """The same for a process that runs in another folder."""
        chapters = tuple(os.path.abspath(path) for path in self.chapters)
        return replace(self, path=os.path.abspath(self.path), chapters=chapters)


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


def make_tasks(
    inputs: Sequence[str],
    *,
    recursive: bool = False,
    join: bool = False,
    tell: Callable[[str], object] = str,
) -> list[Task]:
    """A task for each input, in the order given.

    A folder with videos or bags in it stands for these, recursive: also those in its folders; one with pictures alone
    for the frames of one input. Several pictures of one folder, which is what a glob of frames gives, are the frames of
    one input that is named like the folder; a single picture stays alone. Its place is that of the first of them. Our
    own annotated copies among other inputs are passed over. join: the chapters of a recording are one input. tell:
    takes remarks.
    """
    names = _without_copies(_expand_folders(inputs, recursive, tell), tell)
    groups = _picture_groups(names)
    paths: dict[str, tuple[str, ...]] = {}
    for name in names:
        folder = os.path.dirname(name)
        if os.path.basename(name) in groups.get(folder, ()):
            paths.setdefault(folder or os.curdir, groups[folder])
        else:
            paths.setdefault(name, ())
    chapters = _join(paths, tell) if join else {}
    firsts = [path for path in paths if path not in chapters or chapters[path][0] == path]
    stems = output_stems(firsts)
    return [
        Task(
            place,
            path,
            path if os.path.lexists(path) else hide_login(path),
            stem,
            paths[path],
            chapters.get(path, ()),
        )
        for place, (path, stem) in enumerate(zip(firsts, stems, strict=True))
    ]


def _shown(path: str) -> str:
    """What records call it: an address, which `decode` does not read, without its login."""
    return path if os.path.lexists(path) else hide_login(path)


def _expand_folders(inputs: Sequence[str], recursive: bool, tell: Callable[[str], object]) -> list[str]:
    """Each folder that holds recordings replaced by them, each input once."""
    names: dict[str, None] = {}
    for name in inputs:
        if not os.path.isdir(name) or is_bag(name):
            names.setdefault(name)
            continue
        try:
            found = look_into(name, recursive)
        except InputError:  # told when it is opened
            names.setdefault(name)
            continue
        if found.recordings and found.pictures:
            count = "1 picture" if found.pictures == 1 else f"{found.pictures} pictures"
            tell(f"{name}: holds videos; {count} beside them passed over")
        if found.copies:
            tell(f"{name}: {found.copies} annotated copies passed over")
        folders = [name] if not recursive else found.picture_folders or [name]
        names |= dict.fromkeys(found.recordings or folders)
    return list(names)


def _without_copies(names: list[str], tell: Callable[[str], object]) -> list[str]:
    kept = [name for name in names if not is_annotated_copy(name)]
    if not kept or len(kept) == len(names):
        return names
    tell(f"{len(names) - len(kept)} annotated copies among the inputs passed over")
    return kept


def _join(paths: Iterable[str], tell: Callable[[str], object]) -> dict[str, tuple[str, ...]]:
    """Path to all chapters of its recording, for those that have several."""
    files = [
        path for path in paths if os.path.isfile(path) and not is_picture_name(path) and not is_bag(path)
    ]
    groups = [group for group in group_chapters(files) if len(group) > 1]
    for group in groups:
        tell(f"{group[0]}: joined with {', '.join(map(os.path.basename, group[1:]))}")
    if not groups:
        tell("--join: no two inputs are chapters of one recording by their names")
    return {path: group for group in groups for path in group}


def _picture_groups(inputs: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Folder to the pictures named in it, natural order, where there are at least two."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in inputs:
        if is_picture_name(name) and os.path.isfile(name):
            found[os.path.dirname(name)].append(os.path.basename(name))
    return {
        folder: tuple(sorted(names, key=natural_key)) for folder, names in found.items() if len(names) > 1
    }
