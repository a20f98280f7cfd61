"""CADDY underwater gestures (Gomez Chavez and others, JMSE 2019): tables of stereo pictures of a gloved diver.

Every CSV table of the folder with the columns `scenario` and `stereo left` is read: those of gestures name one a row
(`label name`) and box the hand, or both, in `roi left` as [x, y, w, h]; those of pictures without one have neither.
Only left pictures count, and of the published ones those that are as recorded (`synthetic` 0).
"""

import re
from pathlib import Path
from typing import Final

from lightgesture.benchmarks.divers.pictures import DiverFrame, DiverHand
from lightgesture.errors import InputError
from lightgesture.training.tables import table_rows

SHAPES: Final = {
    **{name: str(number) for number, name in enumerate(("one", "two", "three", "four", "five"), 1)},
    "up": "thumb_up",
    "down": "thumb_down",
}
"""Gestures whose shape has a name here. The other nine stand under their own: none of them is a sign of ours."""

COLUMNS: Final = ("scenario", "stereo left")
REMEDY: Final = "name the folder of CADDY with its CSV tables"


def read_caddy(folder: Path) -> list[DiverFrame]:
    """The left pictures of all tables, in their order; the dive is the scenario, the place what it begins with.

    InputError: there is no such table, or a row is damaged.
    """
    frames: list[DiverFrame] = []
    for table in sorted(folder.glob("*.csv")):
        if _is_of_pictures(table):
            frames += _frames(folder, table)
    if not frames:
        raise InputError(f"{folder}: holds no table with the columns {', '.join(COLUMNS)}; {REMEDY}")
    return frames


def _is_of_pictures(table: Path) -> bool:
    with table.open("rb") as stream:
        header = stream.readline(10_000).decode("utf-8", "replace").lower()
    return all(name in header for name in COLUMNS)


def _frames(folder: Path, table: Path) -> list[DiverFrame]:
    frames = []
    for line, row in table_rows(table, COLUMNS, REMEDY):
        if row.get("synthetic", "0") not in ("", "0"):
            continue
        scenario, file = row["scenario"], row["stereo left"].lstrip("/")
        hands = _hands(f"{table}, line {line}", row)
        frames.append(DiverFrame(folder / file, file, scenario.partition("-")[0], scenario, hands))
    return frames


def _hands(place: str, row: dict[str, str]) -> tuple[DiverHand, ...]:
    """One hand a box; both show the gesture of the row."""
    text, name = row.get("roi left", ""), row.get("label name", "")
    if not text:
        return ()
    numbers = [int(number) for number in re.findall(r"-?\d+", text)]
    boxes = [numbers[start : start + 4] for start in range(0, len(numbers), 4)]
    if not name or not boxes or any(len(box) != 4 or min(box[2:]) <= 0 for box in boxes):
        raise InputError(f"{place}: {text!r} is no [x, y, w, h] of a gesture; restore the table")
    shape = SHAPES.get(name, name)
    return tuple(DiverHand((x, y, w, h), shape, "glove", margin=0.0) for x, y, w, h in boxes)
