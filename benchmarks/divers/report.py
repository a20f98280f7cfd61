"""`evaluate divers`: tables, a sheet of every miss and of every stray token, and the rows behind them as CSV."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from lightgesture.benchmarks.accuracy import Failure, Report, sheet_name
from lightgesture.benchmarks.contact_sheet import MAX_TILES
from lightgesture.benchmarks.divers.pictures import TOKENS, DiverFrame
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
from lightgesture.benchmarks.divers.tables import diver_tables
from lightgesture.benchmarks.progress import Progress
from lightgesture.benchmarks.scorer import Reading
from lightgesture.errors import InputError
from lightgesture.training.datasets import Label

JOINED = "joined"
"""Method of the tables of several runs together."""


def evaluate_divers(
    methods: Sequence[DiverMethod], frames: Sequence[DiverFrame], progress: Progress
) -> tuple[Report, Scored]:
    """Every method on every frame. InputError: a picture cannot be read."""
    scored = score_divers(methods, progress(frames, "divers"))
    return report_of(scored, frames), scored


def report_of(scored: Scored, frames: Sequence[DiverFrame]) -> Report:
    """Tables, and every failure by sheet: signs that were not read in whole pictures, and not in given boxes; tokens
    where none is shown.
    """
    by_file = {frame.file: frame for frame in frames}
    failures: dict[str, list[Failure]] = {}
    for method, hands in by_method(scored.hands).items():
        signs = [row for row in hands if row.shape in TOKENS]
        whole = [row for row in signs if row.found_token != row.shape]
        given = [row for row in signs if row.given_token != row.shape]
        failures |= _sheets("missed", method, [_missed(row, by_file[row.file], scored) for row in whole])
        failures |= _sheets("given", method, [_given(row, by_file[row.file]) for row in given])
    labels: dict[tuple[str, str], list[Label]] = {}
    for row in scored.hands:
        labels.setdefault((row.method, row.file), []).append(_label(row))
    for method, rows in by_method(scored.frames).items():
        stray = [
            Failure(
                by_file[row.file].path,
                tuple(labels.get((method, row.file), ())),
                scored.readings[method, row.file],
                Path(row.file).name,
            )
            for row in rows
            if row.stray
        ]
        failures |= _sheets("stray", method, stray)
    return Report(tuple(diver_tables(scored.hands, scored.frames)), failures)


def _sheets(kind: str, method: str, failures: Sequence[Failure]) -> dict[str, list[Failure]]:
    """As many sheets as it takes to show all."""
    starts = range(0, len(failures), MAX_TILES)
    return {
        sheet_name("divers", kind, method, str(number)): list(failures[start : start + MAX_TILES])
        for number, start in enumerate(starts, 1)
    }


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


def _missed(row: HandRow, frame: DiverFrame, scored: Scored) -> Failure:
    return Failure(frame.path, (_label(row),), scored.readings[row.method, row.file], _caption(row))


def _given(row: HandRow, frame: DiverFrame) -> Failure:
    """What a classifier said of the hand in its box: the likeliest token and its probability."""
    x, y, width, height = row.x, row.y, row.w, row.h
    text = f"{row.named} {row.p_named:.2f}"
    return Failure(
        frame.path, (_label(row),), (Reading((x, y, width, height), row.side, text),), _caption(row)
    )


def _label(row: HandRow) -> Label:
    return Label((row.x, row.y, row.w, row.h), None, row.shape)


def _caption(row: HandRow) -> str:
    return f"{row.glove} {row.view} {Path(row.file).stem}"
