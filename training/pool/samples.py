"""Labelled hands from a manifest, or from folders named after their classes.

A class may have any name that a grammar takes for a token. Of the names, `none` stands for what is no sign, and `left`
and `right` for two signs that are each other's mirror image; no other name has a meaning.

In a folder, the folder below the class's in which a picture lies is its source: `five/anna/1.jpg` is Anna's.

A manifest is a CSV table with a header. `path` is relative to its folder, `token` a class name. The box is the
outline `x`, `y`, `w`, `h` in pixels, or goes round the landmarks, `hx0` to `hy1`, and is grown to the outline; without
either the whole picture is the hand. Optional: `set` (the person, room and camera; else the picture's folder), `side`
(else left), `lm` (21 landmarks `x;y`), `licence`.
"""

import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from hashlib import sha256
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.console import warn
from lightgesture.errors import InputError, UsageError
from lightgesture.features.types import Box, Image
from lightgesture.fsm.language.schema import TOKEN
from lightgesture.sources import is_picture_name, read_picture
from lightgesture.training.datasets import LANDMARK_MARGIN, grow_box
from lightgesture.training.pool.joints import Joints, read_joints
from lightgesture.training.tables import picture_path, table_rows

KEPT_REACH = 2.2
"""Side of what is kept of a picture over the longer side of the hand's box: enough for any altered copy."""

COPYLEFT = re.compile(r"(?<!L)GPL", re.IGNORECASE)
"""In what a manifest says of a licence: the GPL and the AGPL, not the LGPL."""

DOUBTFUL = "doubtful"
"""In the note of a hand that is not sure to show its token: nobody else is posed like it."""

KEPT_PIXELS = 160
"""Longest side of what is kept, in pixels: larger ones only fill the memory, a patch being far smaller."""


@dataclass(frozen=True, slots=True)
class HandRow:
    """One row of truth. box: outline, pixels, None for the whole picture. landmarks: (21, 2) or None. joints: in
    space, where known and trusted."""

    path: Path
    token: str
    source: str
    side: str = "left"
    box: Box | None = None
    landmarks: NDArray[np.float32] | None = field(default=None, compare=False)
    licence: str = "none stated"
    joints: Joints | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True, eq=False)
class LabelledHand:
    """A hand cut out of its picture with something around it. box, landmarks: pixels of `image`."""

    image: Image
    box: Box
    side: str
    token: str
    source: str
    landmarks: NDArray[np.float32] | None


def landmark_box(landmarks: NDArray[np.float32]) -> Box:
    """Outline of the hand from its landmarks (21, 2), pixels."""
    (x0, y0), (x1, y1) = landmarks.min(axis=0).tolist(), landmarks.max(axis=0).tolist()
    return grow_box(x0, y0, x1, y1, LANDMARK_MARGIN)


def read_rows(data: Path, without: Collection[str] = ()) -> list[HandRow]:
    """Rows of a manifest, or of a folder with one folder a class.

    without: sources that are left out, as pictures under the GPL always are. Raises InputError for what cannot be read
    or is missing, UsageError for names that are no token, for a class without pictures, and for fewer than two classes.
    """
    rows = _folder_rows(data) if data.is_dir() else _manifest_rows(data)
    missing = [row.path for row in rows if not row.path.is_file()]
    if missing:
        raise InputError(
            f"{data}: {len(missing)} of {len(rows)} pictures are missing, first {missing[0]}; restore them"
        )
    kept = _without_copyleft(data, [row for row in rows if row.source not in without])
    counts = Counter(row.token for row in kept)
    if len(counts) < 2:
        found = f"the class {next(iter(counts))!r} alone" if counts else "no class"
        raise UsageError(f"{data}: holds {found}; a classifier needs pictures of at least two classes")
    return kept


def _without_copyleft(data: Path, rows: list[HandRow]) -> list[HandRow]:
    """The rows without those under the GPL, whose terms could reach what is learnt from them; they are told."""
    kept = [row for row in rows if COPYLEFT.search(row.licence) is None]
    if len(kept) < len(rows):
        warn(f"{data}: {len(rows) - len(kept)} of {len(rows)} pictures are under the GPL and left out")
    return kept


def rows_digest(rows: Sequence[HandRow]) -> str:
    """Other for other hands: by the names and sizes of their pictures and what the rows say of them."""
    known = [
        (str(row.path), row.path.stat().st_size, row.token, row.source, row.side, row.box) for row in rows
    ]
    digest = sha256(repr(known).encode())
    for row in rows:
        if row.joints is not None:
            digest.update(row.joints.world.tobytes())
    return digest.hexdigest()


def load_hand(row: HandRow) -> LabelledHand:
    """Read a row's picture and keep the hand with what stands around it, at most `KEPT_PIXELS` wide."""
    return cut_hand(read_picture(row.path), row)


def cut_hand(image: Image, row: HandRow) -> LabelledHand:
    """A row's hand in its picture, likewise."""
    rows, columns = image.shape[:2]
    x, y, width, height = row.box or (0, 0, columns, rows)
    if x >= columns or y >= rows or x + width <= 0 or y + height <= 0:
        raise InputError(
            f"{row.path}: box {(x, y, width, height)} lies outside its {columns} × {rows} pixels; correct it"
        )
    reach = 0.5 * KEPT_REACH * max(width, height)
    centre_x, centre_y = x + width / 2, y + height / 2
    left, top = max(0, int(centre_x - reach)), max(0, int(centre_y - reach))
    kept = image[top : int(centre_y + reach) + 1, left : int(centre_x + reach) + 1]
    scale = min(1.0, KEPT_PIXELS / max(kept.shape[:2]))
    if scale < 1.0:
        kept = np.asarray(cv2.resize(kept, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)
    box = (
        round((x - left) * scale),
        round((y - top) * scale),
        max(1, round(width * scale)),
        max(1, round(height * scale)),
    )
    landmarks = None if row.landmarks is None else ((row.landmarks - (left, top)) * scale).astype(np.float32)
    return LabelledHand(kept, box, row.side, row.token, row.source, landmarks)


def _check_class(place: str, name: str, remedy: str) -> None:
    if re.fullmatch(TOKEN, name) is None:
        raise UsageError(
            f"{place}: {name[:40]!r} cannot be a token of a grammar; {remedy} with letters a-z, digits and _, "
            "at most 32"
        )


def _folder_rows(folder: Path) -> list[HandRow]:
    # Hidden folders are not the user's: tools and systems keep theirs beside pictures.
    own = sorted(entry for entry in folder.iterdir() if entry.is_dir() and not entry.name.startswith("."))
    rows: list[HandRow] = []
    for entry in own:
        _check_class(str(folder), entry.name, "name the folder")
        pictures = [path for path in sorted(entry.rglob("*")) if is_picture_name(path)]
        if not pictures:
            raise UsageError(f"{entry}: holds no pictures; add some of this class or remove the folder")
        rows += [
            HandRow(path, entry.name, source=str(folder.name / path.parent.relative_to(entry)))
            for path in pictures
        ]
    return rows


def _manifest_rows(manifest: Path) -> list[HandRow]:
    table = list(table_rows(manifest, ("path", "token"), "give a manifest or a folder"))
    joints = read_joints(manifest, len(table))
    rows = []
    for (line, cells), known in zip(table, joints, strict=True):
        row = _manifest_row(manifest, line, cells)
        if known is not None and DOUBTFUL not in cells.get("note", ""):
            # Tokens are those of right hands that were mirrored.
            row = replace(row, joints=known.mirrored() if row.side == "right" else known)
        rows.append(row)
    return rows


def _manifest_row(manifest: Path, line: int, row: dict[str, str]) -> HandRow:
    place = f"{manifest}, line {line}"
    _check_class(place, row["token"], "name the token")
    side = row.get("side") or "left"
    if side not in ("left", "right"):
        raise InputError(f"{place}: side {side!r}; it must be left or right")
    landmarks = _numbers(place, "lm", row["lm"].split(";"), 42) if row.get("lm") else None
    path = picture_path(manifest.parent, row["path"])
    return HandRow(
        path=path,
        token=row["token"],
        source=row.get("set") or path.parent.name,
        side=side,
        box=_box(place, row),
        landmarks=None if landmarks is None else np.asarray(landmarks, np.float32).reshape(21, 2),
        licence=row.get("licence") or "none stated",
    )


def _box(place: str, row: dict[str, str]) -> Box | None:
    if row.get("x"):
        x, y, width, height = _numbers(
            place, "x, y, w, h", [row.get(name) or "" for name in ("x", "y", "w", "h")], 4
        )
        box = round(x), round(y), round(width), round(height)
    elif row.get("hx0"):
        names = ("hx0", "hy0", "hx1", "hy1")
        x0, y0, x1, y1 = _numbers(place, ", ".join(names), [row.get(name) or "" for name in names], 4)
        box = grow_box(x0, y0, x1, y1, LANDMARK_MARGIN) if x1 > x0 and y1 > y0 else (0, 0, 0, 0)
    else:
        return None
    if box[2] <= 0 or box[3] <= 0:
        raise InputError(f"{place}: the box has no area; correct it")
    return box


def _numbers(place: str, name: str, texts: Sequence[str], count: int) -> list[float]:
    try:
        numbers = [float(text) for text in texts]
    except ValueError as error:
        raise InputError(f"{place}: column {name} holds no number ({error}); correct it") from error
    if len(numbers) != count or not np.isfinite(numbers).all():
        raise InputError(f"{place}: column {name} needs {count} finite numbers; correct it")
    return numbers
