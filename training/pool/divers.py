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
    """shown: hands with a token. resting: hands of other shapes. scenes: whole pictures. looks: of the resting hands.
    sign_looks: of those with a token."""

    shown: Sequence[LabelledHand] = ()
    resting: Sequence[LabelledHand] = ()
    scenes: Sequence[Scene] = ()
    looks: Sequence[SeaLook] = ()
    sign_looks: Sequence[SeaLook] = ()


@dataclass(frozen=True, slots=True)
class DiverHand:
    """box: of the hand. shape: a token, the name of another shape, or `UNNAMED`. gloved: whether it wears a glove."""

    box: Box
    shape: str
    gloved: bool


@dataclass(slots=True)
class DiverPicture:
    """Boxes of one picture. sequence: the dive."""

    sequence: str
    hands: list[DiverHand] = field(default_factory=list)
    faces: list[Box] = field(default_factory=list)


def read_divers(table: Path, tokens: Collection[str], without: Collection[str] = ()) -> Divers:
    """All divers of a table, less the dives of `without`; shapes beside `tokens` are `none`. Raises InputError."""
    shown: list[LabelledHand] = []
    resting: list[LabelledHand] = []
    scenes = []
    looks: list[SeaLook] = []
    sign_looks: list[SeaLook] = []
    for path, picture in diver_pictures(table).items():
        if picture.sequence in without:
            continue
        image, source = read_picture(path), f"{SOURCE} {picture.sequence}"
        boxes = [one.box for one in picture.hands]
        scenes.append(boxed_scene(image, boxes, picture.faces, source))
        for one in picture.hands:
            if one.shape == UNNAMED:
                continue
            token = one.shape if one.shape in tokens else NONE
            hand, look = (
                cut_hand(image, HandRow(path, token, source, box=one.box)),
                measure_look(image, one.box, one.gloved),
            )
            if token == NONE:
                resting.append(hand)
                looks.append(look)
            else:
                shown.append(hand)
                sign_looks.append(look)
    return Divers(shown, resting, scenes, looks, sign_looks)


def diver_pictures(table: Path) -> dict[Path, DiverPicture]:
    """Pictures of a table and their boxes. Raises InputError."""
    found: dict[Path, DiverPicture] = {}
    for line, row in table_rows(table, ("file",), "see --divers"):
        path = picture_path(table.parent, row["file"])
        picture = found.setdefault(path, DiverPicture(row.get("sequence") or path.parent.name))
        kind = row.get("kind")
        if kind not in (HAND, FACE):
            continue
        try:
            box = box_of([row.get(name) or "" for name in ("x", "y", "w", "h")])
        except (ValueError, OverflowError) as error:
            raise InputError(f"{table}, line {line}: holds no box ({error}); correct it") from None
        if kind == HAND:
            gloved = row.get("glove") == "glove"
            picture.hands.append(DiverHand(box, row.get("shape") or UNNAMED, gloved))
        else:
            picture.faces.append(box)
    return found
