"""What is kept of every hand and of every frame: flat rows, of which all tables are made, and which CSV files hold.

Rows of several runs, each of nets that were trained without the dives that it shows, make one table together.
"""

import csv
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from lightgesture.errors import InputError
from lightgesture.results.atomic import replacing
from lightgesture.training.tables import table_rows

HANDS_FILE, FRAMES_FILE = "divers_hands.csv", "divers_frames.csv"


@dataclass(frozen=True, slots=True)
class HandRow:
    """One labelled hand, and what a method made of it.

    x, y, w, h: as labelled, pixels. shape, glove, view: of the label, "" where unknown. side: as it was read in its
    box. size: side of the square of its area in a picture 640 pixels wide. contrast: see `measures.contrast`.
    iou: of the box that was found on it, 0 where none was; found_token: what was read there, "" for nothing. In its
    given box: named, the likeliest token; p_named, its probability; p_none, of `none`, None for a model without it;
    given_token, what the product reads, "" for nothing.
    """

    method: str
    file: str
    place: str
    dive: str
    x: int
    y: int
    w: int
    h: int
    shape: str
    glove: str
    view: str
    side: str
    size: float
    contrast: float
    iou: float
    found_token: str
    named: str
    p_named: float
    p_none: float | None
    given_token: str


@dataclass(frozen=True, slots=True)
class FrameRow:
    """One frame, and what a method found in all of it.

    hands, signs: labelled ones, and those of them that show a token. found: boxes, two at most. tokens: read, with a
    space between them. stray: of these, on nothing that may be a sign: elsewhere, or on a hand that shows none.
    """

    method: str
    file: str
    place: str
    dive: str
    hands: int
    signs: int
    found: int
    tokens: str
    stray: int


Row = TypeVar("Row", HandRow, FrameRow)


def write_rows(path: Path, rows: Sequence[Row]) -> None:
    """Write at least one row as CSV with a header, whole or not at all."""
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, [field.name for field in fields(rows[0])])
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


def read_rows(path: Path, kind: type[Row]) -> list[Row]:
    """Rows that `write_rows` wrote. InputError: they are not such."""
    remedy = "name a folder that `evaluate divers --out` wrote"
    columns = [field.name for field in fields(kind)]
    rows = []
    for line, cells in table_rows(path, (), remedy):
        try:
            rows.append(kind(**{name: _value(kind, name, cells[name]) for name in columns}))
        except (KeyError, ValueError):
            raise InputError(f"{path}, line {line}: is no row of an evaluation of divers; {remedy}") from None
    return rows


def _value(kind: type[Any], name: str, cell: str) -> Any:
    wanted = kind.__annotations__[name]
    if wanted in (str, int, float):
        return wanted(cell)
    return float(cell) if cell else None


def by_method(rows: Iterable[Row]) -> dict[str, list[Row]]:
    """Rows by method, in the order of first appearance."""
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.method, []).append(row)
    return groups
