"""The pictures from which the selector learns, read from a data folder, without the sources that are left out."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.features.types import Box, Image
from lightgesture.models import CLASSES
from lightgesture.sources import read_picture
from lightgesture.training.datasets import (
    Sample,
    fold_of,
    read_frames,
    read_landmarks,
    read_negatives,
    read_table,
    read_webcam,
)
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.composites import Background
from lightgesture.training.pictures.cutouts import Cutout, cut_out
from lightgesture.training.pictures.light import attenuate, expose
from lightgesture.training.pictures.real_divers import RealDiver
from lightgesture.training.pool.divers import SOURCE, UNNAMED, diver_pictures
from lightgesture.training.pool.left_out import LeftOut

CUTOUTS_PER_SOURCE: Final = 16
"""Most hands cut out of one source, so that no person rules."""
LONGEST_SIDE: Final = 320
"""Whole frames are reduced to so many pixels first."""
NEGATIVE_SETS: Final = ("funie", "rov25", "u45")
"""Sets of `negatives` that are trained on; all others stay unseen for the report."""
DIVERS: Final = "divers/boxes.csv"
"""Table of real divers within the data folder; they are left out where there is none."""
ONE_IN: Final = 8
"""Of so many people in rooms, one is kept from the nets: the trees that weigh the nets are fitted on what nets do to
people and water they have not seen."""
COMPOSED: Final = 12000
"""Pictures composed for the nets and the classical trees of regions."""
UNSEEN: Final = 2000
"""Those composed of what is kept from the nets."""
NEVER: Final = frozenset({"emre_drone"})
"""Sources of `hands` that are not cut out: their people are those of `frames/drone`, whose figures would not count
otherwise."""


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """All that is trained on. frames: people in rooms with boxed hands. empty: water without a hand. hands: cut out.
    divers: real ones."""

    frames: list[BoxedPicture]
    empty: list[BoxedPicture]
    hands: list[Cutout]
    divers: list[RealDiver]

    def parted(self, one_in: int) -> tuple["Material", "Material"]:
        """Most of it, and one in so many: of people by source, so that nobody is in both, of empty frames by number.

        Real divers are all in the first part: a hundred signs are too few to keep any back, and trees that were fitted
        on dives that their nets had not seen told hands no better.
        """

        def is_second(source: str) -> bool:
            return fold_of(source, one_in) == 0

        second = [any(map(is_second, one.sources)) for one in self.frames]
        return (
            Material(
                [one for one, is_own in zip(self.frames, second, strict=True) if not is_own],
                [one for index, one in enumerate(self.empty) if index % one_in],
                [one for one in self.hands if not is_second(one.source)],
                self.divers,
            ),
            Material(
                [one for one, is_own in zip(self.frames, second, strict=True) if is_own],
                self.empty[::one_in],
                [one for one in self.hands if is_second(one.source)],
                [],
            ),
        )

    def rooms(self) -> list[Background]:
        """The frames with their hands painted over."""
        return [Background(without_hands(one), *one.sources) for one in self.frames]

    def waters(self) -> list[Background]:
        """The pictures of water as backgrounds."""
        return [Background(one.image, *one.sources) for one in self.empty]


def read_material(data: Path, without: LeftOut, seed: int) -> Material:
    """Everything, less the sources left out. Raises InputError."""
    return Material(
        whole_frames(data, without),
        negatives(data, without),
        cutouts(data, without, seed),
        real_divers(data, without),
    )


def whole_frames(data: Path, without: LeftOut) -> list[BoxedPicture]:
    """People in rooms: `webcam/train`, whose faces are all known, and the single pictures of `frames/subhi`."""
    single = [one for one in read_frames(data) if one.source == "subhi" and one.order is None]
    rooms = [(one, True) for one in read_webcam(data, "train")] + [(one, False) for one in single]
    return [_boxed(one, faces) for one, faces in rooms if not without.covers(one.source)]


def negatives(data: Path, without: LeftOut) -> list[BoxedPicture]:
    """Underwater frames without a hand, of the sets that may be trained on."""
    return [
        _boxed(one, all_faces=False)
        for one in read_negatives(data)
        if one.source in NEGATIVE_SETS and not without.covers(one.source)
    ]


def real_divers(data: Path, without: LeftOut) -> list[RealDiver]:
    """All of `divers`, at the camera's resolution; hands that nobody could name are neither hands nor none."""
    table = data / DIVERS
    if not table.is_file():
        return []
    found = []
    for path, picture in diver_pictures(table).items():
        source = f"{SOURCE} {picture.sequence}"
        if not without.covers(source):
            hands = tuple(one.box for one in picture.hands if one.shape != UNNAMED)
            ignored = tuple(one.box for one in picture.hands if one.shape == UNNAMED)
            boxed = BoxedPicture(
                read_picture(path), hands, tuple(picture.faces), False, frozenset({source}), ignored
            )
            found.append(RealDiver(boxed, any(one.shape in CLASSES for one in picture.hands)))
    return found


def cutouts(data: Path, without: LeftOut, seed: int) -> list[Cutout]:
    """Hands of `hands/train`, cut out, at most a few from each source."""
    by_source: dict[str, list[dict[str, str]]] = {}
    for row in read_table(data, "hands/train.csv"):
        if row["set"] not in NEVER and not without.covers(row["set"]):
            by_source.setdefault(row["set"], []).append(row)
    rng = np.random.default_rng(seed)
    found = []
    for source in sorted(by_source):
        own = by_source[source]
        for index in rng.permutation(len(own))[:CUTOUTS_PER_SOURCE]:
            row = own[index]
            image = read_picture(data / "hands" / row["path"])
            cutout = cut_out(image, read_landmarks(row), row["token"], source)
            if cutout is not None:
                found.append(cutout)
    return found


def without_hands(picture: BoxedPicture) -> Image:
    """The frame as a background: each labelled hand painted over from what stands around it."""
    mask = np.zeros(picture.image.shape[:2], np.uint8)
    for x, y, width, height in picture.boxes:
        margin_x, margin_y = width // 6, height // 5
        cv2.rectangle(
            mask, (x - margin_x, y - margin_y), (x + width + margin_x, y + height + margin_y), 255, -1
        )
    return cv2.inpaint(picture.image, mask, 5, cv2.INPAINT_TELEA)  # type: ignore[return-value]


def variants(picture: BoxedPicture, rng: np.random.Generator) -> Iterator[BoxedPicture]:
    """The picture itself, then it and its mirror image under water and in the dark."""
    yield picture
    for view in (picture, _mirrored(picture)):
        image = view.image.astype(np.float32) / np.float32(255.0)
        yield BoxedPicture(expose(attenuate(image, rng), rng), view.boxes)
        shaded = np.power(np.power(image, 2.2) * rng.uniform(0.03, 0.3), 1 / 2.2)
        yield BoxedPicture(expose(np.asarray(shaded, np.float32), rng), view.boxes)


def _mirrored(picture: BoxedPicture) -> BoxedPicture:
    width = picture.image.shape[1]
    boxes = tuple((width - x - w, y, w, h) for x, y, w, h in picture.boxes)
    return BoxedPicture(np.ascontiguousarray(picture.image[:, ::-1]), boxes)


def _boxed(sample: Sample, all_faces: bool) -> BoxedPicture:
    image = read_picture(sample.path)
    scale = min(LONGEST_SIDE / max(image.shape[:2]), 1.0)
    if scale < 1.0:
        image = np.asarray(
            cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8
        )
    hands = tuple(_scaled(label.box, scale) for label in sample.labels)
    faces = tuple(_scaled(face, scale) for face in sample.faces)
    return BoxedPicture(image, hands, faces, all_faces, frozenset({sample.source}))


def _scaled(box: Box, scale: float) -> Box:
    x, y, width, height = (round(value * scale) for value in box)
    return x, y, max(width, 1), max(height, 1)
