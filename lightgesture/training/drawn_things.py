"""Things about as large as a hand that no picture at hand shows: fish, fins, pipes, robots, drawn into real places.

A net that knows bare water and rooms as `none` takes whatever else stands out from them for a hand: a pipe's bend for
`right`, a dark robot for `0`. There are more things in the sea than pictures to learn them from, so these are drawn:
pieces of other places within outlines of chance, and painted structures.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image
from lightgesture.training.decoys import put_decoy, put_structures

Random = np.random.Generator
Float = NDArray[np.float32]
CHANGED = 0.02
"""Least difference of a pixel of 0 to 1 that something drawn makes."""


@dataclass(frozen=True, slots=True)
class ThingSettings:
    """What is drawn.

    count: pictures with one thing each, of each place and round. canvas: side of such a picture, pixels. place: least
    side of the part of the place that is seen, over the place's shorter side, 0.05 to 1. smallest, largest: size of a
    thing over the canvas, 0 to 1. structures, blobs: shares of painted structures and of round outlines; the other
    things have corners. longest: length of a round outline over its width. whole: share of boxes that go round the
    thing; the others, and all of structures, lie somewhere on it.
    """

    count: int = 2
    canvas: int = 96
    place: float = 0.25
    smallest: float = 0.25
    largest: float = 0.6
    structures: float = 0.35
    blobs: float = 0.4
    longest: float = 3.0
    whole: float = 0.6


def drawn_things(
    place: Image, others: Sequence[Image], settings: ThingSettings, random: Random
) -> Iterator[tuple[Image, Box]]:
    """Pictures, uint8 (canvas, canvas, 3) BGR, and a box in each of them that lies on a thing.

    place: picture into which is drawn. others: of which the things are pieces; not empty.
    """
    for _ in range(settings.count):
        canvas = _piece(place, settings.place, settings.canvas, random)
        before = canvas.copy()
        unit = settings.canvas * random.uniform(settings.smallest, settings.largest)
        kind = random.random()
        if kind < settings.structures:
            put_structures(canvas, unit, random)
        else:
            texture = _piece(
                others[int(random.integers(len(others)))], settings.place, settings.canvas, random
            )
            if kind < settings.structures + settings.blobs:
                _put_blob(canvas, texture, unit, settings.longest, random)
            else:
                put_decoy(canvas, unit, texture, random)
        changed = np.abs(canvas - before).max(axis=2) > CHANGED
        if changed.any():
            whole = kind >= settings.structures and random.random() < settings.whole
            box = _round(changed) if whole else _upon(changed, unit, random)
            yield np.asarray(np.clip(np.rint(canvas * 255.0), 0, 255), np.uint8), box


def _piece(picture: Image, least: float, size: int, random: Random) -> Float:
    """A random square part of a picture, float32 (size, size, 3), 0 to 1."""
    rows, columns = picture.shape[:2]
    side = max(2, round(min(rows, columns) * random.uniform(least, 1.0)))
    top, left = random.integers(rows - side + 1), random.integers(columns - side + 1)
    part = cv2.resize(
        picture[top : top + side, left : left + side], (size, size), interpolation=cv2.INTER_AREA
    )
    return np.asarray(part, np.float32) / np.float32(255.0)


def _put_blob(canvas: Float, texture: Float, unit: float, longest: float, random: Random) -> None:
    """A round outline, often long, of a random hue and lightness: what fish, fins, stones and weed look like afar."""
    size = len(canvas)
    around = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    reach = np.ones(len(around))
    for waves in range(1, 5):
        reach += random.normal(0.0, 0.25 / waves) * np.cos(waves * around + random.uniform(0.0, 2.0 * np.pi))
    narrow = 1.0 / random.uniform(1.0, longest)
    points = np.stack([np.cos(around), narrow * np.sin(around)], axis=1) * np.maximum(reach, 0.2)[:, None]
    angle = random.uniform(0.0, 2.0 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    outline = 0.6 * unit * points @ turn.T + random.uniform(0.15, 0.85, 2) * size
    mask = np.zeros(canvas.shape[:2], np.uint8)
    cv2.fillPoly(mask, [np.rint(outline).astype(np.int32)], 255, cv2.LINE_AA)
    soft = cv2.GaussianBlur(mask, (0, 0), random.uniform(0.3, 2.0)).astype(np.float32) / np.float32(255.0)
    tint = random.uniform(0.0, 0.8)
    colour = random.uniform(0.05, 1.0) * random.uniform(0.4, 1.0, 3).astype(np.float32)
    thing = texture * (1.0 - tint) + (0.4 + 0.6 * texture) * colour * tint
    canvas += soft[..., None] * (thing - canvas)


def _round(changed: NDArray[np.bool_]) -> Box:
    """The box round all that was drawn."""
    x, y, width, height = cv2.boundingRect(changed.astype(np.uint8))
    return x, y, max(2, width), max(2, height)


def _upon(changed: NDArray[np.bool_], unit: float, random: Random) -> Box:
    """A box about as large as the thing with its middle on a pixel of it."""
    places = np.argwhere(changed)
    y, x = places[int(random.integers(len(places)))]
    width, height = (max(2, round(unit * factor)) for factor in random.uniform(0.6, 1.6, 2))
    return round(x - width / 2), round(y - height / 2), width, height
