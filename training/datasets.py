"""Readers of the data folder: labelled hands, whole frames, and frames in which nothing may be found.

The folder is described in its own README.md; its rules that decide what a figure is worth are built in here:
boxes of `hands/` go round landmarks and are grown to the outline; crops of `hands/` are read as left hands;
in an unmirrored picture of a diver with two hands the image-left hand is the diver's right one; the shapes
`3b` and `x` are outside the language and are not scored; where not every visible hand is labelled, a box
beside the labels is not counted as wrong.
"""

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError
from lightgesture.features.types import Box
from lightgesture.training.tables import table_rows

DATA_FOLDER = Path("shared") / "data"
"""Where the data lie beside the checkout, or beside the current directory."""

LANDMARK_MARGIN = 0.09
"""What lies between the box round the 21 landmarks and the hand's outline, as a share of the box's side."""

UNSCORED = frozenset({"3b", "x"})
"""Labels that are no token and no `none` either: shapes of another project."""

SIDES = {"image-left": "right", "image-right": "left"}
"""A diver faces the camera: the hand at image left is the diver's right one."""


@dataclass(frozen=True, slots=True)
class Label:
    """Truth of one hand.

    side: the diver's own side, None where unknown. token: one of the ten, "none" for another clear hand
    shape, None where unknown or outside what is scored.
    """

    box: Box
    side: str | None
    token: str | None


@dataclass(frozen=True, slots=True)
class Sample:
    """One picture and its truth.

    source: the person, room and camera it comes from. group: the row of a table it belongs to.
    order: place in an ordered sequence, None for a single picture. complete: every visible hand is labelled.
    doubtful: a trained net disagrees strongly with the label. faces: boxes of the faces, where they are known.
    """

    path: Path
    labels: tuple[Label, ...]
    source: str
    group: str
    order: int | None = None
    complete: bool = False
    doubtful: bool = False
    faces: tuple[Box, ...] = ()


def find_data(folder: str | Path | None = None) -> Path:
    """The data folder: the one named, else `../shared/data` beside the checkout or the current directory."""
    if folder is not None:
        if Path(folder).is_dir():
            return Path(folder)
        raise InputError(f"{folder}: no such folder; --data must name the one that holds hands/ and frames/")
    checkout = Path(__file__).resolve().parents[1]
    places = [checkout.parent / DATA_FOLDER, Path.cwd().parent / DATA_FOLDER]
    for place in places:
        if place.is_dir():
            return place
    raise InputError(f"no data folder at {places[0]} or {places[1]}; name it with --data DIR")


def read_table(data: Path, name: str) -> list[dict[str, str]]:
    """Rows of a CSV table with a header, by its path under the data folder."""
    remedy = "--data must name a complete data folder"
    rows = [row for _, row in table_rows(data / name, (), remedy)]
    if not rows:
        raise InputError(f"{data / name}: holds no rows; {remedy}")
    return rows


def grow_box(x0: float, y0: float, x1: float, y1: float, margin: float) -> Box:
    """Box with corners (x0, y0) and (x1, y1), grown by `margin` of its side on each side, in
    whole pixels, at least one."""
    grow_x, grow_y = margin * (x1 - x0), margin * (y1 - y0)
    left, top = round(x0 - grow_x), round(y0 - grow_y)
    return left, top, max(1, round(x1 + grow_x) - left), max(1, round(y1 + grow_y) - top)


def read_hands(data: Path, split: str = "val") -> list[Sample]:
    """Crops with one hand each, all read as left hands; group and source are the set."""
    return [_hand_sample(data, row) for row in read_table(data, f"hands/{split}.csv")]


def _hand_sample(data: Path, row: dict[str, str]) -> Sample:
    x0, y0, x1, y1 = (_number(row, name) for name in ("hx0", "hy0", "hx1", "hy1"))
    box = grow_box(x0, y0, x1, y1, LANDMARK_MARGIN)
    label = Label(box, "left", row["token"])
    path = data / "hands" / row["path"]
    return Sample(path, (label,), row["set"], row["set"], doubtful="doubtful" in row["note"].split())


def read_landmarks(row: dict[str, str]) -> NDArray[np.float32]:
    """The 21 landmarks of a row of `hands/*.csv`, float32 (21, 2), crop pixels, wrist first."""
    numbers = [float(number) for number in row["lm"].split(";")]
    return np.asarray(numbers, dtype=np.float32).reshape(-1, 2)


def read_webcam(data: Path, split: str = "val") -> list[Sample]:
    """Whole frames of a person in a room; the boxes already go round the outline.

    A second hand may have been missed, so the labels are not complete. Sides are not known: some of these
    cameras mirror their picture.
    """
    rows = read_table(data, f"webcam/{split}.csv")
    return [
        Sample(
            path=data / "webcam" / file,
            labels=tuple(_box_label(row, None) for row in hands),
            source=hands[0]["set"],
            group=f"webcam {split}",
            faces=_face_boxes(hands[0]["face_boxes"]),
        )
        for file, hands in _by_file(rows)
    ]


def _face_boxes(listed: str) -> tuple[Box, ...]:
    """Boxes written as `x,y,w,h` and joined by `;`."""
    rows = [[round(float(number)) for number in item.split(",")] for item in listed.split(";") if item]
    return tuple((x, y, width, height) for x, y, width, height in rows)


def read_frames(data: Path) -> list[Sample]:
    """The frames labelled by hand, sequences in their order."""
    samples = [
        _frame_sample(data, file, hands) for file, hands in _by_file(read_table(data, "frames/labels.csv"))
    ]
    return sorted(samples, key=lambda sample: (sample.group, sample.order or 0))


def _frame_sample(data: Path, file: str, rows: Sequence[dict[str, str]]) -> Sample:
    folders = Path(file).parts[1:-1]
    sequence = rows[0]["sequence"]
    return Sample(
        path=data / file,
        labels=tuple(_box_label(row, SIDES[row["hand"]]) for row in rows),
        source=folders[0],
        group=sequence or folders[-1],
        order=int(rows[0]["order"]) if sequence else None,
        complete=len(rows) == 2,
    )


def read_negatives(data: Path) -> list[Sample]:
    """Frames without a gesturing diver; group is the ordered sequence, else the set."""
    samples = [
        Sample(
            path=data / row["file"],
            labels=(),
            source=row["set"],
            group=row["sequence"] or row["set"],
            order=int(row["order"]) if row["sequence"] else None,
            complete=True,
        )
        for row in read_table(data, "negatives/negatives.csv")
    ]
    return sorted(samples, key=lambda sample: (sample.group, sample.order or 0))


def group_samples(samples: Iterable[Sample]) -> dict[str, list[Sample]]:
    """Samples by group, in order of first appearance."""
    groups: dict[str, list[Sample]] = {}
    for sample in samples:
        groups.setdefault(sample.group, []).append(sample)
    return groups


def fold_of(source: str, folds: int) -> int:
    """Number of the fold, 0 to `folds` - 1, in which a source is held out: by a hash of its name, so that it stays
    there when other sources come or go."""
    return int(hashlib.sha256(source.encode()).hexdigest(), 16) % folds


def is_sequence(samples: Sequence[Sample]) -> bool:
    """Whether the samples of a group are frames in order."""
    return bool(samples) and all(sample.order is not None for sample in samples)


def _by_file(rows: Iterable[dict[str, str]]) -> list[tuple[str, list[dict[str, str]]]]:
    ordered = sorted(rows, key=lambda row: row["file"])
    return [(file, list(hands)) for file, hands in groupby(ordered, key=lambda row: row["file"])]


def _box_label(row: dict[str, str], side: str | None) -> Label:
    x, y, width, height = (_number(row, name) for name in ("x", "y", "w", "h"))
    token = row["token"]
    known = token if token and token not in UNSCORED else None
    return Label(grow_box(x, y, x + width, y + height, margin=0.0), side, known)


def _number(row: dict[str, Any], name: str) -> float:
    try:
        return float(row[name])
    except (KeyError, TypeError, ValueError) as error:
        place = row.get("path") or row.get("file")
        raise InputError(f"{place}: column {name} is missing or no number; restore the table") from error
