"""Light and cameras drawn at random for single hands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.raster import Float32
from lightgesture.synth.shading import Light
from lightgesture.synth.water import Water


def draw_light(rng: np.random.Generator, water: Water | None) -> Light:
    """A light from above or the side, warm or cold in air, as the water leaves it below."""
    angle = rng.uniform(-1.3, 1.3)
    direction = (
        float(np.sin(angle)),
        float(-np.cos(angle)) * float(rng.uniform(0.3, 1.0)),
        float(rng.uniform(0.15, 1.0)),
    )
    colour = water.light if water is not None else rng.uniform([0.7, 0.85, 0.9], [1.0, 1.0, 1.0])
    strength = float(np.exp(rng.uniform(-1.2, 0.1)))
    share = float(rng.uniform(0.25, 0.7))
    key, sky, ground = (
        colour * strength * part for part in (1.0 - share, share * 0.9, share * rng.uniform(0.3, 0.8))
    )
    return Light(direction, triple(key), triple(sky), triple(ground), float(rng.uniform(0.2, 0.75)))


def triple(values: NDArray[np.floating]) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def photographed(picture: Float32, rng: np.random.Generator) -> NDArray[np.uint8]:
    """The picture as a camera of changing quality keeps it."""
    look = CameraLook(
        target=float(rng.uniform(0.12, 0.4)), balance=float(rng.uniform(0.0, 0.6)), drift=0.0,
        shot=0.0006 * float(rng.uniform(0.1, 3.0)), read=0.004 * float(rng.uniform(0.1, 2.0)),
        blur_px=float(rng.uniform(0.0, 1.1)), jpeg=int(rng.integers(40, 96)) if rng.uniform() < 0.6 else 0,
        motion_px=float(rng.uniform(2.0, 5.0)) if rng.uniform() < 0.1 else 0.0,
    )  # fmt: skip
    return Sensor(look, (picture.shape[1], picture.shape[0]), rng, margin=0).expose(picture, 0, 0.0)
