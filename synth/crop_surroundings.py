"""What stands behind single hands: small pictures of rooms, some with a person, and of dives."""

from __future__ import annotations

from typing import Any, Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.backdrop import Backdrop, BackdropLook
from lightgesture.synth.body import BodyLook, Camera, render_body
from lightgesture.synth.hand import decode
from lightgesture.synth.raster import Float32
from lightgesture.synth.room import Room, RoomLook
from lightgesture.synth.shading import Light, triple
from lightgesture.synth.skeleton import rotation_y, rotation_z
from lightgesture.synth.skin import skin_tone
from lightgesture.synth.water import JERLOV_BGR, Water, WaterRange, make_water

SIZE: Final = (320, 240)
"""Of each picture, pixels."""
WATERS: Final = WaterRange(tuple(JERLOV_BGR)[:9], (0.5, 8.0), (float(np.exp(-3.0)), 1.0))
"""Between camera and hand."""
WATER_SHARE: Final = 0.3
"""Share of hands seen through water."""
PLAIN_SHARE: Final = 0.2
"""Share of hands before one even colour."""
WINDOW: Final = (60, 200)
"""Side of what is seen of a surrounding, pixels."""
PART: Final = (0.25, 1.0)
"""Side of what is seen of a photograph, over its shorter side."""
PERSON_SHARE: Final = 0.6
"""Share of rooms with somebody in them."""


def draw_surroundings(rng: np.random.Generator, count: int) -> tuple[list[Float32], list[Float32]]:
    """`count` rooms and as many dives, float32 (240, 320, 3), linear BGR."""
    rooms, dives = [], []
    for _ in range(count):
        look = RoomLook(
            wall=int(rng.integers(6)), pieces=int(rng.integers(0, 14)), lamps=int(rng.integers(3)),
            window=float(rng.uniform(0.8, 2.5)) if rng.uniform() < 0.3 else 0.0,
            level=float(rng.uniform(0.3, 1.2)), blur=float(rng.uniform(0.0, 0.02)),
        )  # fmt: skip
        room = Room(look, SIZE, rng)
        picture = room.frame(0.0)
        if rng.uniform() < PERSON_SHARE:
            _draw_person(picture, room.light(rng), rng)
        rooms.append(picture)
        floor = str(rng.choice(("sand", "tiles", "rocks")))
        surface = float(rng.uniform(0.3, 0.9)) if rng.uniform() < 0.5 else 0.0
        dive = BackdropLook(floor, float(rng.uniform(0.5, 3.0)), surface, float(rng.uniform(0.2, 0.7)))
        water = make_water(str(rng.choice(list(JERLOV_BGR)[:7])), 2.0, float(rng.uniform(0.05, 0.6)))
        dives.append(Backdrop(dive, water, 280.0, SIZE, rng).frame(float(rng.uniform(0.0, 9.0))))
    return rooms, dives


def draw_water(rng: np.random.Generator) -> Water | None:
    """Water between camera and hand, None for most hands."""
    return make_water(*WATERS.draw(rng)) if rng.uniform() < WATER_SHARE else None


def window_of(
    surroundings: list[Float32], water: Water | None, size: int, rng: np.random.Generator
) -> Float32:
    """A random window of one of the surroundings, or now and then an even colour, (size, size, 3); water: before it."""
    if rng.uniform() < PLAIN_SHARE:
        plain = water.veil if water is not None else rng.uniform(0.01, 0.9) * rng.uniform(0.7, 1.0, 3)
        return np.asarray(np.broadcast_to(plain, (size, size, 3)), np.float32).copy()
    source = surroundings[int(rng.integers(len(surroundings)))]
    span = int(rng.integers(*WINDOW))
    x, y = int(rng.integers(0, source.shape[1] - span)), int(rng.integers(0, source.shape[0] - span))
    window = _perhaps_mirrored(source[y : y + span, x : x + span], rng)
    return np.asarray(cv2.resize(window, (size, size), interpolation=cv2.INTER_LINEAR), np.float32)


def part_of(photograph: NDArray[np.uint8], size: int, rng: np.random.Generator) -> Float32:
    """A random part of a photograph, uint8 BGR, as linear light, (size, size, 3)."""
    rows, columns = photograph.shape[:2]
    span = max(2, int(min(rows, columns) * rng.uniform(*PART)))
    y, x = int(rng.integers(rows - span + 1)), int(rng.integers(columns - span + 1))
    window = _perhaps_mirrored(photograph[y : y + span, x : x + span], rng)
    return decode(np.asarray(cv2.resize(window, (size, size), interpolation=cv2.INTER_AREA), np.uint8))


def _perhaps_mirrored(window: NDArray[Any], rng: np.random.Generator) -> NDArray[Any]:
    return window[:, ::-1] if rng.uniform() < 0.5 else window


def _draw_person(picture: Float32, light: Light, rng: np.random.Generator) -> None:
    """Somebody behind the hand, as in most pictures from webcams: face, hair and a shirt."""
    blue, green, red = triple(skin_tone(float(rng.uniform(1.0, 9.5))).back)
    look = BodyLook(
        suit_bgr=triple(rng.uniform(0.01, 0.7, 3)), accent_bgr=triple(rng.uniform(0.01, 0.7, 3)),
        skin_bgr=(blue, green, red), hood_bgr=triple(rng.uniform(0.005, 0.12) * np.array([0.5, 0.7, 1.0])),
        hood=False, mask=False, regulator=False, legs=False,
    )  # fmt: skip
    size = (picture.shape[1], picture.shape[0])
    camera = Camera(float(size[0]), (0.5 * size[0], 0.5 * size[1]))
    place = np.array([rng.normal(0.0, 200.0), rng.normal(-120.0, 80.0), rng.uniform(500.0, 1100.0)])
    wrists = (np.array([260.0, -400.0, 60.0]), np.array([-260.0, -400.0, 60.0]))
    turn = rotation_y(rng.normal(0.0, 20.0)) @ rotation_z(rng.normal(0.0, 6.0))
    radiance, cover = render_body(look, turn, place, wrists, camera, size, light)
    picture *= 1.0 - cover[..., None]
    picture += radiance
