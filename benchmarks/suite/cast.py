"""Which real hands and pictures play in the suite: chosen from `hands/val` and `negatives`, cut out and tinted."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.errors import InputError
from lightgesture.sources import read_picture
from lightgesture.synth.diver import SIDES
from lightgesture.synth.hand import decode, encode
from lightgesture.synth.raster import Float32
from lightgesture.training.datasets import read_landmarks
from lightgesture.training.pictures.cutouts import Cutout, cut_out
from lightgesture.training.pictures.diver_composites import THUMB_TOKENS
from lightgesture.training.pictures.real_hands import skin_colour

Row = dict[str, str]
Random = np.random.Generator


PICTURES: Final = 4
"""Most pictures of one hand and sign that take turns in a hold."""

ZOOM: Final = 1.15
"""How much larger than a frame the picture behind is, which leaves room to move it."""

GAIN: Final = (0.5, 2.0)
"""Bounds within which another person's hand is tinted to match."""


def group_people(rows: Sequence[Row]) -> list[dict[str, list[Row]]]:
    """Undoubted pictures by person and token; a person is a subject of a source, or a source without subjects."""
    people: dict[tuple[str, str], dict[str, list[Row]]] = {}
    for row in rows:
        if "doubtful" not in row["note"].split():
            person = people.setdefault((row["set"], row["subject"]), {})
            person.setdefault(row["token"], []).append(row)
    return [people[key] for key in sorted(people)]


def cast(
    people: Sequence[dict[str, list[Row]]], tokens: Sequence[str], rng: Random
) -> dict[str, tuple[Row, ...]]:
    """Pictures for each token: of one person as far as they go, else of whoever has most of that token."""
    order = [people[index] for index in rng.permutation(len(people))]
    known = sorted(order, key=lambda person: -sum(token in person for token in tokens))
    # Not always the same person: whoever has more than half of the tokens may sign.
    able = [person for person in known if 2 * sum(token in person for token in tokens) > len(tokens)]
    main = able[int(rng.integers(len(able)))] if able else known[0]
    hands = {}
    for token in tokens:
        owner = main if token in main else max(order, key=lambda person: len(person.get(token, ())))
        own = owner.get(token, [])
        if not own:
            raise InputError(f"hands/val holds no picture of {token}; --data must name a complete folder")
        chosen = rng.permutation(len(own))[:PICTURES]
        hands[token] = tuple(own[int(index)] for index in chosen)
    return hands


def load_hands(data: Path, chosen: dict[str, tuple[Row, ...]]) -> dict[str, dict[str, list[Cutout]]]:
    """Cut-outs by side and token, tinted like the first of them; `left` and `right` keep their thumbs' meaning."""
    target: tuple[float, float, float] | None = None
    hands: dict[str, dict[str, list[Cutout]]] = {side: {} for side in SIDES}
    for token, rows in chosen.items():
        for row in rows:
            landmarks = read_landmarks(row)
            cutout = cut_out(read_picture(data / "hands" / row["path"]), landmarks, token, row["set"])
            if cutout is None:
                continue
            target = target or skin_colour(cutout)
            tinted = _tinted(cutout, target)
            flipped = replace(tinted.mirrored(), token=token)
            # Landmarks 2 and 17: base of the thumb and of the little finger. A palm's thumb points inwards.
            is_left = token in THUMB_TOKENS or bool(landmarks[2, 0] < landmarks[17, 0])
            hands["left"].setdefault(token, []).append(tinted if is_left else flipped)
            hands["right"].setdefault(token, []).append(flipped if is_left else tinted)
        if token not in hands["left"]:
            raise InputError(f"{rows[0]['path']}: no hand of {token} can be cut out; restore the pictures")
    return hands


def _tinted(cutout: Cutout, target: tuple[float, float, float]) -> Cutout:
    """The hand with the mean colour of another, within bounds: one diver has one skin."""
    gain = np.clip(np.array(target) / np.maximum(skin_colour(cutout), 1e-3), *GAIN)
    return replace(cutout, image=encode(decode(cutout.image) * gain.astype(np.float32)))


def load_backdrop(path: Path, frame_size: tuple[int, int]) -> Float32:
    """The picture behind, linear, cut to the frame's shape and larger than it by the zoom."""
    picture = read_picture(path)
    width, height = (round(side * ZOOM) for side in frame_size)
    scale = max(width / picture.shape[1], height / picture.shape[0])
    size = max(width, round(picture.shape[1] * scale)), max(height, round(picture.shape[0] * scale))
    large = cv2.resize(picture, size, interpolation=cv2.INTER_AREA if scale < 1.0 else cv2.INTER_LINEAR)
    left, top = (size[0] - width) // 2, (size[1] - height) // 2
    return decode(np.asarray(large[top : top + height, left : left + width], np.uint8))
