"""Where composed divers are: rendered water and rooms, or real pictures with the light and water they imply."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from lightgesture.synth.backdrop import Backdrop, BackdropLook
from lightgesture.synth.raster import Float32
from lightgesture.synth.room import Room, RoomLook
from lightgesture.synth.shading import Light, daylight, triple
from lightgesture.synth.textures import periodic_noise
from lightgesture.synth.water import JERLOV_BGR, Water, WaterRange, make_water
from lightgesture.training.pictures.drawn import lamp_spots

Random = np.random.Generator
RIPPLES_SIZE = 256
"""Side of the tile of noise by which the surface breaks images, pixels."""
COUNT: Final = 10
"""Rendered waters and rooms each, drawn once."""
MOMENTS: Final = 3
"""Pictures of each water, seconds apart."""
WATERS: Final = WaterRange(tuple(JERLOV_BGR)[:9], (0.5, 8.0), (0.05, 0.6))
"""Of the rendered waters."""


@dataclass(frozen=True, slots=True, eq=False)
class Scenery:
    """picture: (h, w, 3) linear BGR. light: on the diver. water: between diver and camera, None in air."""

    picture: Float32
    light: Light
    water: Water | None


class Surroundings:
    """Rendered places of one picture size (width, height), ready to be taken. ripples: noise of a moving surface."""

    def __init__(self, size: tuple[int, int], rng: Random) -> None:
        self._dives = [_dive(size, rng) for _ in range(COUNT)]
        self.ripples = periodic_noise(rng, RIPPLES_SIZE, 1.9)
        self._rooms = [_room(size, rng) for _ in range(COUNT)]

    def dive(self, rng: Random) -> Scenery:
        """Rendered water, seen to either side."""
        pictures, water = self._dives[int(rng.integers(len(self._dives)))]
        picture = pictures[int(rng.integers(len(pictures)))]
        return Scenery(_either_side(picture, rng), light_under_water(water, rng), water)

    def room(self, rng: Random) -> Scenery:
        """A rendered room, seen to either side."""
        picture, light = self._rooms[int(rng.integers(len(self._rooms)))]
        return Scenery(_either_side(picture, rng), light, None)


def _dive(size: tuple[int, int], rng: Random) -> tuple[list[Float32], Water]:
    water = make_water(*WATERS.draw(rng))
    look = BackdropLook(
        str(rng.choice(("sand", "tiles", "rocks", ""))),
        float(rng.uniform(0.6, 4.0)),
        float(rng.uniform(0.2, 0.9)) if rng.random() < 0.4 else 0.0,
        float(rng.uniform(0.25, 0.65)),
        caustic=float(rng.uniform(0.0, 0.9)),
    )
    backdrop = Backdrop(look, water, 0.9 * size[0], size, rng)
    return [backdrop.frame(2.0 * moment) for moment in range(MOMENTS)], water


def _room(size: tuple[int, int], rng: Random) -> tuple[Float32, Light]:
    look = RoomLook(
        wall=int(rng.integers(6)),
        pieces=int(rng.integers(2, 18)),
        window=float(rng.uniform(0.8, 3.5)) if rng.random() < 0.4 else 0.0,
        lamps=int(rng.integers(0, 4)),
        level=float(rng.uniform(0.15, 1.2)),
    )
    room = Room(look, size, rng)
    return room.frame(0.0), room.light(rng)


def _either_side(picture: Float32, rng: Random) -> Float32:
    turned = picture[:, ::-1] if rng.random() < 0.5 else picture
    return np.array(turned, np.float32)


def light_under_water(water: Water, rng: Random) -> Light:
    """Daylight from above and whatever side, scattered light from around."""
    strength = float(np.exp(rng.uniform(-0.6, 0.5)))
    side = float(rng.uniform(-0.7, 0.7))
    return daylight(water, (side, -0.85, float(rng.uniform(0.2, 0.8))), strength)


def water_of_picture(picture: Float32, distance_m: float, rng: Random) -> Water:
    """A water that tints a diver at `distance_m` as a real underwater picture (linear) is tinted.

    The picture's mean stands for what is left of white light on its way there and back, so that its
    ratio of channels gives the attenuation (up to a drawn exponent) and its level the veil.
    """
    mean = np.maximum(picture.reshape(-1, 3).mean(axis=0), 1e-3)
    tint = mean / mean.max()
    share = float(rng.uniform(0.35, 0.8))
    haze = float(np.exp(rng.uniform(np.log(0.05), np.log(0.5))))
    attenuation = -share * np.log(tint) / distance_m + 0.6 * haze
    light = tint ** float(rng.uniform(0.2, 0.6)) * float(np.clip(mean.max() / 0.22, 0.25, 1.3))
    return Water(
        attenuation=attenuation.astype(np.float32),
        backscatter=np.full(3, haze / distance_m, np.float32),
        light=light.astype(np.float32),
        veil=mean.astype(np.float32),
        scattering=haze,
    )


def light_of_room(picture: Float32, rng: Random) -> Light:
    """Light as bright as a real picture of a room (linear) and nearly white, from above or a side."""
    level = float(np.clip(picture.mean() / 0.25, 0.2, 1.3)) * float(rng.uniform(0.6, 1.2))
    colour = rng.uniform([0.75, 0.9, 0.92], 1.0)
    share = float(rng.uniform(0.4, 0.7))
    return Light(
        direction=(
            float(rng.uniform(-0.9, 0.9)),
            float(rng.uniform(-0.9, -0.1)),
            float(rng.uniform(0.2, 0.9)),
        ),
        key=triple(colour * level * share),
        sky=triple(colour * level * (1.0 - share)),
        ground=triple(colour * level * 0.5 * (1.0 - share)),
    )


def darken(scenery: Scenery, rng: Random, lamps: float = 0.0) -> Scenery:
    """The same place against the light: windows and lamps stay bright, the rest and the diver are as dark as can be.

    lamps: share of places in which something else stands in a spot of light.
    """
    picture = scenery.picture
    glow = picture.min(axis=2, keepdims=True) > float(rng.uniform(0.35, 0.9))
    dark = picture * min(float(rng.uniform(0.015, 0.07)) / max(float(picture.mean()), 1e-3), 1.0)
    if rng.random() < lamps:
        dark = dark * lamp_spots(picture.shape[:2], rng)[..., None]
    level = float(np.exp(rng.uniform(np.log(0.07), np.log(0.4))))
    light = scenery.light
    return Scenery(
        np.where(glow, np.maximum(picture, np.float32(0.6)), dark).astype(np.float32),
        Light(
            light.direction,
            key=triple(np.array(light.key) * level),
            sky=triple(np.array(light.sky) * level),
            ground=triple(np.array(light.ground) * level),
            shadow=light.shadow,
        ),
        scenery.water,
    )
