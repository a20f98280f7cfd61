"""HaGRID (Kapitanov and others, WACV 2024): people in rooms, a JSON file of labels a gesture, boxes as shares of the
picture.

Below the folder lie the JSON files, {picture: {"bboxes": [[x, y, w, h], ...], "labels": [...]}}, and the pictures,
`gesture/picture.jpg`, both at any depth: the releases differ in the folders between.
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

from lightgesture.benchmarks.divers.pictures import DiverFrame, DiverHand
from lightgesture.errors import InputError
from lightgesture.sources import is_picture_name
from lightgesture.training.datasets import grow_box

SHAPES: Final[Mapping[str, str | None]] = {
    "fist": "0",
    "one": "1",
    **dict.fromkeys(("peace", "peace_inverted", "two_up", "two_up_inverted"), "2"),
    "three": "3",
    "four": "4",
    **dict.fromkeys(("palm", "stop", "stop_inverted"), "5"),
    "ok": "ok",
    "thumb_index": "pic",
    "like": "thumb_up",
    "dislike": "thumb_down",
    "no_gesture": "rest",
    **dict.fromkeys(("mute", "point", "gun"), None),
}
"""Gestures whose shape has a name here; None: a shape that is a sign of ours from some sides and from others not. All
others stand under their own name and are no sign of ours."""
REMEDY: Final = "name the folder of HaGRID with its JSON files"
PARTS: Final = 1_000_000
"""Into how many parts a picture's side is divided, for boxes in whole numbers."""


def read_hagrid(folder: Path) -> list[DiverFrame]:
    """The pictures of all JSON files below the folder, by file and name; place and dive are the gesture's file.

    InputError: there are none, or one is damaged.
    """
    files = sorted(folder.rglob("*.json"))
    if not files:
        raise InputError(f"{folder}: holds no JSON files; {REMEDY}")
    pictures = {(path.parent.name, path.stem): path for path in folder.rglob("*") if is_picture_name(path)}
    frames: list[DiverFrame] = []
    for file in files:
        for name, hands in _labels(file):
            path = pictures.get((file.stem, name), file.parent / file.stem / f"{name}.jpg")
            shown = path.relative_to(folder).as_posix()
            frames.append(DiverFrame(path, shown, file.stem, file.stem, hands, parts=PARTS))
    return frames


def _labels(file: Path) -> Iterator[tuple[str, tuple[DiverHand, ...]]]:
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        for name, labels in content.items():
            yield str(name), tuple(_hand(box, str(label)) for box, label in _pairs(labels))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(
            f"{file}: is no file of HaGRID's labels ({error!r}); restore it or take it away"
        ) from None


def _pairs(labels: Mapping[str, Any]) -> Iterator[tuple[Any, Any]]:
    return zip(labels["bboxes"], labels["labels"], strict=True)


def _hand(box: Any, label: str) -> DiverHand:
    x, y, width, height = (float(share) for share in box)
    if not (width > 0 and height > 0):
        raise ValueError(f"box {box} has no area")
    whole = grow_box(PARTS * x, PARTS * y, PARTS * (x + width), PARTS * (y + height), 0.0)
    return DiverHand(whole, SHAPES.get(label, label), "bare", margin=0.0)
