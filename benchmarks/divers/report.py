"""`evaluate divers`: tables, a sheet of every miss and of every stray token, and the rows behind them as CSV."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from lightgesture.benchmarks.accuracy import Report
from lightgesture.benchmarks.divers.pictures import DiverFrame
from lightgesture.benchmarks.divers.rows import (
    FRAMES_FILE,
    HANDS_FILE,
    FrameRow,
    HandRow,
    by_method,
    read_rows,
    write_rows,
)
from lightgesture.benchmarks.divers.scoring import DiverMethod, Scored, score_divers
from lightgesture.benchmarks.divers.sheets import failures, given_tiles
from lightgesture.benchmarks.divers.tables import diver_tables
from lightgesture.benchmarks.progress import Progress
from lightgesture.errors import InputError

JOINED = "joined"
"""Method of the tables of several runs together."""


def evaluate_divers(
    methods: Sequence[DiverMethod], frames: Sequence[DiverFrame], progress: Progress, is_drawn: bool = False
) -> tuple[Report, Scored]:
    """Every method on every frame; with its failures where they are drawn. InputError: a picture cannot be read."""
    scored = score_divers(methods, progress(frames, "divers"))
    tables = tuple(diver_tables(scored.hands, scored.frames))
    if not is_drawn:
        return Report(tables, {}), scored
    return Report(tables, failures(scored, frames), given_tiles(scored, frames)), scored


def evaluate_folds(
    folds: Sequence[tuple[DiverMethod, Sequence[DiverFrame]]], progress: Progress
) -> tuple[Report, Scored]:
    """Each method on pictures of its own, no picture twice, in tables of one. InputError: a picture cannot be read."""
    hands: list[HandRow] = []
    rows: list[FrameRow] = []
    for method, frames in folds:
        scored = score_divers([method], progress(frames, method.name))
        hands += [replace(row, method=JOINED) for row in scored.hands]
        rows += [replace(row, method=JOINED) for row in scored.frames]
    return Report(tuple(diver_tables(hands, rows)), {}), Scored(tuple(hands), tuple(rows), {})


def save_rows(folder: Path, hands: Sequence[HandRow], frames: Sequence[FrameRow]) -> list[Path]:
    """Write the rows; returns the files written."""
    written = []
    if hands:
        write_rows(folder / HANDS_FILE, hands)
        written.append(folder / HANDS_FILE)
    write_rows(folder / FRAMES_FILE, frames)
    return [*written, folder / FRAMES_FILE]


def joined(folders: Sequence[Path]) -> Report:
    """Tables of the rows in several folders, each of one method, as those of one.

    InputError: a folder has no rows, or those of several methods, or two folders have the same picture.
    """
    hands: list[HandRow] = []
    frames: list[FrameRow] = []
    seen: dict[str, Path] = {}
    for folder in folders:
        own = read_rows(folder / FRAMES_FILE, FrameRow)
        if len(by_method(own)) > 1:
            raise InputError(
                f"{folder}: has rows of several models or selectors; write each to a folder of its own"
            )
        for row in own:
            if row.file in seen:
                raise InputError(
                    f"{row.file}: stands in {seen[row.file]} and in {folder}; join runs on other dives"
                )
            seen[row.file] = folder
        frames += [replace(row, method=JOINED) for row in own]
        if (folder / HANDS_FILE).is_file():
            hands += [replace(row, method=JOINED) for row in read_rows(folder / HANDS_FILE, HandRow)]
    return Report(tuple(diver_tables(hands, frames)), {})
