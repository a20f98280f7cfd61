"""Real divers for a classifier: their hands, whole pictures, and what their hands look like.

The table has a row for each box: `file`, `sequence` (the dive), `kind`, `x`, `y`, `w`, `h`, and for a hand its `shape`,
a token or the name of another shape. What is no token is `none`; `bad` hands, which nobody could name, teach nothing.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from lightgesture.errors import InputError
from lightgesture.features.types import Box
from lightgesture.models import NONE
from lightgesture.sources import read_picture
from lightgesture.training.pictures.sea import SeaLook, measure_look
from lightgesture.training.pool.negatives import Scene, box_of, boxed_scene
from lightgesture.training.pool.samples import HandRow, LabelledHand, cut_hand
from lightgesture.training.tables import picture_path, table_rows

HAND, FACE = "hand", "head"
"""Kinds of boxes that matter here."""
UNNAMED: Final = "bad"
"""Shape of hands that nobody could name."""
SOURCE: Final = "divers"
"""Beginning of the sources' names; the dive's follows."""


@dataclass(frozen=True, slots=True, eq=False)
class Divers:
    """shown: hands with a token. resting: hands of other shapes. scenes: whole pictures. looks: of the hands."""

    shown: Sequence[LabelledHand] = ()
    resting: Sequence[LabelledHand] = ()
    scenes: Sequence[Scene] = ()
    looks: Sequence[SeaLook] = ()


@dataclass(slots=True)
class _Picture:
    """Boxes of one picture. hands: with their shapes."""

    sequence: str
    hands: list[tuple[Box, str]] = field(default_factory=list)
    faces: list[Box] = field(default_factory=list)


def read_divers(table: Path, tokens: Collection[str], without: Collection[str] = ()) -> Divers:
    """All divers of a table, less the dives of `without`; shapes beside `tokens` are `none`. Raises InputError."""
    shown: list[LabelledHand] = []
    resting: list[LabelledHand] = []
    scenes, looks = [], []
    for path, picture in _pictures(table).items():
        if picture.sequence in without:
            continue
        image, source = read_picture(path), f"{SOURCE} {picture.sequence}"
        scenes.append(boxed_scene(image, [box for box, _ in picture.hands], picture.faces, source))
        for box, shape in picture.hands:
            looks.append(measure_look(image, box))
            if shape != UNNAMED:
                token = shape if shape in tokens else NONE
                hand = cut_hand(image, HandRow(path, token, source, box=box))
                (resting if token == NONE else shown).append(hand)
    return Divers(shown, resting, scenes, looks)


def _pictures(table: Path) -> dict[Path, _Picture]:
    found: dict[Path, _Picture] = {}
    for line, row in table_rows(table, ("file",), "see --divers"):
        path = picture_path(table.parent, row["file"])
        picture = found.setdefault(path, _Picture(row.get("sequence") or path.parent.name))
        kind = row.get("kind")
        if kind not in (HAND, FACE):
            continue
        try:
            box = box_of([row.get(name) or "" for name in ("x", "y", "w", "h")])
        except (ValueError, OverflowError) as error:
            raise InputError(f"{table}, line {line}: holds no box ({error}); correct it") from None
        if kind == HAND:
            picture.hands.append((box, row.get("shape") or UNNAMED))
        else:
            picture.faces.append(box)
    return found
