"""Regions that are no token: faces, arms, walls, water, and boxes that miss the hand.

What the selector proposes in a picture and what is not a hand there is what the classifier meets on the board,
so most of these regions are its own proposals.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.proposals import propose
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.types import Box, Image
from lightgesture.models import NONE
from lightgesture.sources import is_picture_name, read_picture
from lightgesture.training.pool.samples import LabelledHand
from lightgesture.training.samples import TrainingSample
from lightgesture.training.tables import picture_path, table_rows

Random = np.random.Generator


LONGEST_SIDE: Final = 320
"""Pixels to which the longer side of a picture is reduced."""
PROPOSALS: Final = 5
"""The selector's own proposals that are taken of each picture."""
RANDOM_BOXES: Final = 3
"""Boxes drawn at random in each picture."""
SMALLEST: Final = 0.1
"""Side of the smallest random box over the picture's shorter side."""
LARGEST: Final = 0.6
"""Side of the largest."""
ACCEPTED_IOU: Final = 0.3
"""A box that overlaps a hand more than this is no negative."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A whole picture. hands, faces: boxes in its pixels; a face is no hand. source: as of a sample."""

    image: Image
    hands: tuple[Box, ...]
    faces: tuple[Box, ...]
    source: str


def read_backgrounds(folder: Path) -> list[Scene]:
    """All pictures under a folder, without any hand; the source is the folder a picture lies in."""
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; give --backgrounds a folder of pictures without hands")
    paths = sorted(path for path in folder.rglob("*") if is_picture_name(path))
    if not paths:
        raise InputError(
            f"{folder}: holds no pictures; give --backgrounds a folder of pictures without hands"
        )
    return [
        Scene(_reduced(read_picture(path))[0], (), (), f"background {path.parent.name}") for path in paths
    ]


def read_scenes(manifest: Path) -> list[Scene]:
    """Whole pictures with boxes: columns `file`, `x`, `y`, `w`, `h`, and if known `set` and `face_boxes`.

    Several rows may share a file; `face_boxes` is `x,y,w,h` joined by `;`. Paths are relative to the manifest.
    """
    hands: dict[Path, list[Box]] = {}
    faces: dict[Path, list[Box]] = {}
    sources: dict[Path, str] = {}
    for line, row in table_rows(manifest, ("file", "x", "y", "w", "h"), "see --scenes"):
        path = picture_path(manifest.parent, row["file"])
        try:
            hands.setdefault(path, []).append(box_of([row[name] for name in ("x", "y", "w", "h")]))
            faces[path] = [box_of(text.split(",")) for text in _texts(row)]
        except (ValueError, OverflowError) as error:
            raise InputError(f"{manifest}, line {line}: holds no box ({error}); correct it") from None
        sources[path] = row.get("set") or "scenes"
    return [boxed_scene(read_picture(path), hands[path], faces[path], sources[path]) for path in hands]


def negatives(scenes: Sequence[Scene], random: Random) -> Iterator[TrainingSample]:
    """Faces, proposals and random boxes of pictures, none of them on a hand."""
    colours = ColourStage()
    for scene in scenes:
        colour = colours.process(scene.image)
        proposed = np.asarray(propose(colour).boxes, np.float64) * np.tile(colour.scale, 2)
        drawn = _random_boxes(scene.image.shape[:2], random)
        chosen = _clear(proposed, scene.hands)
        chosen = chosen[random.permutation(len(chosen))[:PROPOSALS]]
        boxes = [*scene.faces, *_as_boxes(chosen), *_as_boxes(_clear(drawn, scene.hands))]
        for box in boxes:
            side = "left" if random.random() < 0.5 else "right"
            yield TrainingSample(image=scene.image, box=box, side=side, token=NONE, source=scene.source)


def missed_hand(hand: LabelledHand, random: Random) -> TrainingSample | None:
    """A box beside or on a small part of a hand, None where the draw overlaps the hand too much."""
    x, y, width, height = hand.box
    side = max(width, height) * random.uniform(0.3, 0.9)
    centre = np.array([x + width / 2, y + height / 2]) + random.uniform(-0.7, 0.7, 2) * (width, height)
    box = (round(centre[0] - side / 2), round(centre[1] - side / 2), max(2, round(side)), max(2, round(side)))
    overlap = pairwise_iou(np.array([box]), np.array([hand.box]))[0, 0]
    rows, columns = hand.image.shape[:2]
    inside = 0 <= centre[0] < columns and 0 <= centre[1] < rows
    if overlap > ACCEPTED_IOU or not inside:
        return None
    return TrainingSample(image=hand.image, box=box, side=hand.side, token=NONE, source=hand.source)


def boxed_scene(image: Image, hands: Sequence[Box], faces: Sequence[Box], source: str) -> Scene:
    """A whole picture with its boxes, reduced."""
    image, scale = _reduced(image)

    def scaled(boxes: Sequence[Box]) -> tuple[Box, ...]:
        return tuple(_as_boxes(np.array(boxes, np.float64).reshape(-1, 4) * scale))

    return Scene(image, scaled(hands), scaled(faces), source)


def _reduced(image: Image) -> tuple[Image, float]:
    """The picture at most `LONGEST_SIDE` pixels long, and the factor."""
    scale = LONGEST_SIDE / max(image.shape[:2])
    if scale >= 1.0:
        return image, 1.0
    small = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    return np.asarray(small, np.uint8), scale


def _random_boxes(size: tuple[int, ...], random: Random) -> NDArray[np.float64]:
    rows, columns = size[:2]
    sides = min(rows, columns) * random.uniform(SMALLEST, LARGEST, RANDOM_BOXES)
    left = random.uniform(0.0, 1.0, len(sides)) * (columns - sides)
    top = random.uniform(0.0, 1.0, len(sides)) * (rows - sides)
    return np.stack([left, top, sides, sides], axis=1)


def _clear(boxes: NDArray[np.float64], hands: Sequence[Box]) -> NDArray[np.float64]:
    """The boxes that overlap no hand."""
    if not hands or not len(boxes):
        return boxes
    return np.asarray(boxes[pairwise_iou(boxes, np.array(hands)).max(axis=1) <= ACCEPTED_IOU])


def _as_boxes(boxes: NDArray[np.float64]) -> list[Box]:
    return [(round(x), round(y), max(2, round(w)), max(2, round(h))) for x, y, w, h in boxes.tolist()]


def _texts(row: dict[str, str]) -> list[str]:
    return [text for text in (row.get("face_boxes") or "").split(";") if text]


def box_of(texts: Sequence[str]) -> Box:
    """Left, top, width and height from a table's cells. Raises ValueError, OverflowError."""
    x, y, width, height = (round(float(text)) for text in texts)
    if width <= 0 or height <= 0:
        raise ValueError(f"box {x},{y},{width},{height} has no area")
    return x, y, width, height
