"""Labelled pictures of divers: hands with the shape that they show, heads and bodies, the place and the dive.

The table of the data folder, `divers/boxes.csv`, is read here; the readers of public sets make the same of theirs.
"""

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import TypeVar

from lightgesture.benchmarks.contact_sheet import choose_evenly
from lightgesture.errors import InputError, UsageError
from lightgesture.features.types import Box
from lightgesture.models import CLASSES, NONE
from lightgesture.training.datasets import grow_box
from lightgesture.training.tables import table_rows

Item = TypeVar("Item")

TABLE = Path("divers") / "boxes.csv"
COLUMNS = ("file", "sequence")
SIDES = ("x", "y", "w", "h")

TOKENS = frozenset(CLASSES) - {NONE}
"""Shapes that are signs of the language; all others must not be read as one."""

GIVEN_MARGIN = -0.04
"""Of `DiverHand.margin` for pictures of divers: their hands were boxed generously, and 0.92 of the side is the outline
(design trials; 0.75 to 1.1 changed nothing)."""


@dataclass(frozen=True, slots=True)
class DiverHand:
    """One labelled hand. shape: a token, another word for what it shows, None where the set does not say.

    box: as labelled, pixels. glove: "bare", "glove" or "?". view: "palm", "back", "side" or "?". margin: by how much of
    its side the box is grown on each side before it is read.
    """

    box: Box
    shape: str | None = None
    glove: str = "?"
    view: str = "?"
    margin: float = GIVEN_MARGIN

    @property
    def may_be_sign(self) -> bool:
        """Whether a token that is read there may be right."""
        return self.shape is None or self.is_sign

    @property
    def is_sign(self) -> bool:
        """Whether it shows one of the ten tokens."""
        return self.shape in TOKENS

    @property
    def outline(self) -> Box:
        """The box that is given to a classifier."""
        x, y, width, height = self.box
        return grow_box(x, y, x + width, y + height, self.margin)


@dataclass(frozen=True, slots=True)
class DiverFrame:
    """One picture. file: its name in tables. place, dive: what may be held out as a whole. heads, bodies: of divers.

    parts: into how many parts the picture's sides are divided, where the boxes are no pixels.
    """

    path: Path
    file: str
    place: str
    dive: str
    hands: tuple[DiverHand, ...]
    heads: tuple[Box, ...] = ()
    bodies: tuple[Box, ...] = ()
    parts: int | None = None

    def in_pixels(self, width: int, height: int) -> "DiverFrame":
        """The same with boxes in pixels of a picture of that size."""
        if self.parts is None:
            return self
        across, down = width / self.parts, height / self.parts

        def scaled(box: Box) -> Box:
            x, y, wide, high = box
            return grow_box(across * x, down * y, across * (x + wide), down * (y + high), 0.0)

        return replace(
            self,
            hands=tuple(replace(hand, box=scaled(hand.box)) for hand in self.hands),
            heads=tuple(map(scaled, self.heads)),
            bodies=tuple(map(scaled, self.bodies)),
            parts=None,
        )


def read_divers(data: Path) -> list[DiverFrame]:
    """All pictures of `divers/boxes.csv`, in the order of the table; the place is the folder of the picture.

    InputError: the table is missing, or a row is damaged.
    """
    remedy = "--data must name a folder with divers/"
    rows: dict[str, list[dict[str, str]]] = defaultdict(list)
    for line, row in table_rows(data / TABLE, COLUMNS, remedy):
        if row.get("kind", "") in ("hand", "head", "diver"):
            row["box"] = f"{data / TABLE}, line {line}"
        rows[row["file"]].append(row)
    return [_frame(data / TABLE.parent, file, members) for file, members in rows.items()]


def _frame(folder: Path, file: str, rows: Sequence[dict[str, str]]) -> DiverFrame:
    boxes: dict[str, list[Box]] = defaultdict(list)
    hands = []
    for row in rows:
        if "box" not in row:
            continue
        box = _box(row)
        if row["kind"] == "hand":
            glove, view = row.get("glove") or "?", row.get("view") or "?"
            hands.append(DiverHand(box, row.get("shape") or None, glove, view))
        else:
            boxes[row["kind"]].append(box)
    return DiverFrame(
        path=folder / file,
        file=file,
        place=PurePosixPath(file).parent.name,
        dive=rows[0]["sequence"],
        hands=tuple(hands),
        heads=tuple(boxes["head"]),
        bodies=tuple(boxes["diver"]),
    )


def _box(row: dict[str, str]) -> Box:
    try:
        x, y, width, height = (float(row[name]) for name in SIDES)
    except (KeyError, ValueError):
        raise InputError(f"{row['box']}: x,y,w,h is no box; restore the table") from None
    return grow_box(x, y, x + width, y + height, 0.0)


def choose_frames(
    frames: Sequence[DiverFrame], places: Collection[str] = (), dives: Collection[str] = ()
) -> list[DiverFrame]:
    """The frames of the named places and dives, all where none is named. UsageError: there is no such place or dive."""
    for option, names, known in (
        ("place", places, {frame.place for frame in frames}),
        ("dive", dives, {frame.dive for frame in frames}),
    ):
        if unknown := [name for name in names if name not in known]:
            raise UsageError(
                f"--{option} {unknown[0]}: no such {option}; there are {', '.join(sorted(known))}"
            )
    if not places and not dives:
        return list(frames)
    return [frame for frame in frames if frame.place in places or frame.dive in dives]


def spread(items: Sequence[Item], most: int | None) -> list[Item]:
    """At most so many of the items, evenly spread; None for all."""
    return list(items) if most is None else [items[index] for index in choose_evenly(len(items), most)]


def side_of(hand: DiverHand, frame: DiverFrame, width: int) -> str:
    """The diver's own side of a hand, as the product infers it of one that faces the camera: "left" or "right".

    The labels do not tell sides. Two hands of the only diver in view go by their order, the image-left one being the
    right. Any other hand goes by the axis of the head nearest to it, else of the nearest body, else by the middle of
    the picture, `width` pixels wide.
    """
    middle = _middle(hand.box)
    if len(frame.hands) == 2 and max(len(frame.heads), len(frame.bodies)) <= 1:
        (other,) = (item for item in frame.hands if item is not hand)
        axis = _middle(other.box)[0]
    elif near := frame.heads or frame.bodies:
        axis = min(
            (_middle(box) for box in near), key=lambda at: abs(at[0] - middle[0]) + abs(at[1] - middle[1])
        )[0]
    else:
        axis = width / 2
    return "right" if middle[0] < axis else "left"


def _middle(box: Box) -> tuple[float, float]:
    return box[0] + box[2] / 2, box[1] + box[3] / 2
