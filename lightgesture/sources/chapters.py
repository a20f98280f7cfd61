"""Chapters: the files into which a camera cuts one recording, because a card's file system ends at 4 GB or so."""

import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from lightgesture.errors import InputError
from lightgesture.frames import Frame
from lightgesture.sources.folder import natural_key
from lightgesture.sources.types import Source

_GOPRO = re.compile(r"(?P<kind>G[A-Z])(?P<chapter>\d{2})(?P<number>\d{4})", re.IGNORECASE)
_GOPRO_FIRST = re.compile(r"GOPR(?P<number>\d{4})", re.IGNORECASE)
"""GX010042, GX020042 are chapters 1 and 2 of recording 42; older cameras call them GOPR0042, GP010042."""

_DIGITS = re.compile(r"\d+")
USUAL_STEP_S: Final = 1 / 30
"""Seconds from the last frame of a chapter with one frame to the first of the next."""


def group_chapters(paths: Sequence[str]) -> list[tuple[str, ...]]:
    """Paths of videos as groups of one recording, each in order, groups in that of their first.

    GoPro's names tell which chapter is of which recording. Of others those of one folder are chapters of one recording
    whose names differ in numbers alone (DJI_0001, DJI_0002; dive_2024-05-01_10-00-00, ..._10-30-00).
    """
    groups: dict[tuple[str, str, str], list[str]] = {}
    for path in paths:
        groups.setdefault(_recording(path), []).append(path)
    return [tuple(sorted(group, key=_order)) for group in groups.values()]


def _recording(path: str) -> tuple[str, str, str]:
    """Folder, suffix and what the names of all chapters have in common."""
    stem, suffix = os.path.splitext(os.path.basename(path))
    if match := _GOPRO.fullmatch(stem):
        kind = match["kind"].upper()
        name = f"GOPR {match['number']}" if kind == "GP" else f"{kind} {match['number']}"
    elif match := _GOPRO_FIRST.fullmatch(stem):
        name = f"GOPR {match['number']}"
    else:
        name = _DIGITS.sub("#", stem)
    return os.path.dirname(path), suffix.lower(), name


def _order(path: str) -> tuple[int, tuple[list[tuple[int, str]], str]]:
    stem = os.path.splitext(os.path.basename(path))[0]
    match = _GOPRO.fullmatch(stem)
    return int(match["chapter"]) if match else 0, natural_key(path)


class JoinedVideos(Source):
    """The chapters of one recording as one source: time and index go on from one to the next.

    paths: of the chapters, in order. open_one: what opens one of them. A chapter that cannot be read is left out, and
    one that breaks off ends there; the others go on, after a gap, and after the last one InputError tells it.
    start_utc: that of the first.
    """

    def __init__(self, paths: Sequence[str], open_one: Callable[[str], Source]) -> None:
        self.name = paths[0]
        self._rest = list(paths[1:])
        self._open_one = open_one
        self._source = open_one(paths[0])
        self.start_utc = self._source.start_utc
        count = self._source.frame_count
        self.frame_count = (
            None if count is None else count * len(paths)
        )  # a guess, for all but the last are as long

    def close(self) -> None:
        """Close the chapter that is open."""
        self._source.__exit__(None, None, None)

    def __iter__(self) -> Iterator[Frame]:
        failures: list[str] = []
        index, start_s, told = 0, 0.0, 0
        while True:
            first: Frame | None = None
            last: Frame | None = None
            try:
                for frame in self._source:
                    gap = frame.gap or (failures[-1] if len(failures) > told else None)
                    first, last, told = first or frame, frame, len(failures)
                    time_s = round(start_s + frame.time_s, 6)
                    yield replace(frame, index=index + frame.index, time_s=time_s, gap=gap)
            except InputError as error:
                failures.append(str(error))
            if first is not None and last is not None:
                steps = last.index - first.index
                step_s = (last.time_s - first.time_s) / steps if steps else USUAL_STEP_S
                index, start_s = index + last.index + 1, start_s + last.time_s + step_s
            if not self._open_next(failures):
                break
        if failures:
            raise InputError(
                failures[0] if len(failures) == 1 else f"{failures[0]}; and {len(failures) - 1} more"
            )

    def _open_next(self, failures: list[str]) -> bool:
        """Open the next chapter that can be; whether there is one."""
        self.close()
        while self._rest:
            try:
                self._source = self._open_one(self._rest.pop(0))
                self._source.__enter__()
            except InputError as error:
                failures.append(str(error))
            else:
                return True
        return False
