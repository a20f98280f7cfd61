"""What stands behind the diver under water: open water, floor with caustics, surface from below.

All planes are horizontal; the camera looks along the horizon, tilted by moving the horizon's row.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from lightgesture.synth.raster import Float32
from lightgesture.synth.textures import FLOORS, caustics, periodic_noise
from lightgesture.synth.water import Water, through_water

TEXTURE_SIZE = 512
TEXTURE_M = 2.0
"""Size of one repeat of the floor's texture, metres."""
OVERHEAD = 1.6
"""Brightness of the water overhead against straight ahead."""
FAR_M = 40.0
"""Beyond this distance a plane is drawn as open water, metres."""


@dataclass(frozen=True, slots=True)
class BackdropLook:
    """Layout of the surroundings.

    floor: key of textures.FLOORS, or "" for open water. floor_m / surface_m: below / above the camera, metres
    (surface_m 0: not in view). horizon: row of the horizon as a share of the height. caustic: contrast of caustics
    0..1.
    """

    floor: str = "sand"
    floor_m: float = 1.6
    surface_m: float = 0.0
    horizon: float = 0.45
    caustic: float = 0.5


class Backdrop:
    """Draws the surroundings of one dive; geometry is worked out once, light moves with time."""

    def __init__(
        self, look: BackdropLook, water: Water, focal: float, size: tuple[int, int], rng: np.random.Generator
    ) -> None:
        self.look, self.water, self.size = look, water, size
        self._caustics = caustics(rng, TEXTURE_SIZE)
        self.ripples = periodic_noise(rng, TEXTURE_SIZE, 1.9)
        self._rows, self._columns = np.mgrid[0 : size[1] : 2, 0 : size[0] : 2].astype(np.float32)
        self._open = self._open_water()
        self._floor = self._plane(look.floor_m, focal, below=True) if look.floor else None
        self._surface = self._plane(look.surface_m, focal, below=False) if look.surface_m > 0.0 else None
        if self._floor is not None:
            albedo = FLOORS[look.floor](rng, TEXTURE_SIZE)
            self._static = self._sample(albedo, self._floor[0], self._floor[1], TEXTURE_M)

    def frame(self, time_s: float) -> Float32:
        """Linear picture (h, w, 3) at a time."""
        picture = self._open.copy()
        if self._floor is not None:
            self._draw_floor(picture, time_s)
        if self._surface is not None:
            self._draw_surface(picture, time_s)
        return np.asarray(cv2.resize(picture, self.size, interpolation=cv2.INTER_LINEAR), np.float32)

    def _open_water(self) -> Float32:
        height = self.size[1]
        up = (self.look.horizon * height - self._rows[:, :1]) / height
        glow = np.exp(np.log(OVERHEAD) * 2.0 * np.clip(up, -0.5, 0.6))
        return np.asarray(
            np.broadcast_to(glow[..., None] * self.water.veil, (*self._rows.shape, 3)), np.float32
        )

    def _plane(self, gap_m: float, focal: float, below: bool) -> tuple[Float32, Float32, Float32]:
        """Texture position x and z in metres of a horizontal plane, and how much of it is seen through the water."""
        sign = 1.0 if below else -1.0
        drop = np.maximum(sign * (self._rows - self.look.horizon * self.size[1]), 1e-3) / focal
        distance = gap_m / drop
        x = (self._columns - 0.5 * self.size[0]) / focal * distance
        range_m = np.minimum(distance * np.sqrt(1.0 + drop * drop), 4.0 * FAR_M)
        seen = self.water.transmission(range_m[..., None]) * (distance < FAR_M)[..., None]
        return x.astype(np.float32), np.minimum(distance, FAR_M).astype(np.float32), seen.astype(np.float32)

    @staticmethod
    def _sample(texture: Float32, x: Float32, z: Float32, repeat_m: float) -> Float32:
        scale = np.float32(TEXTURE_SIZE / repeat_m)
        return np.asarray(
            cv2.remap(texture, x * scale, z * scale, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP), np.float32
        )

    def _draw_floor(self, picture: Float32, time_s: float) -> None:
        assert self._floor is not None
        x, z, seen = self._floor
        drift = np.float32(0.13 * time_s)
        first = self._sample(self._caustics, x + drift, z, 1.7)
        across = np.asarray(x * np.float32(0.8) - z * np.float32(0.6), np.float32)
        second = self._sample(self._caustics, across, z - drift, 2.1)
        net = np.minimum(first, second)
        light = (1.0 - self.look.caustic) + np.float32(self.look.caustic * 1.6) * np.minimum(net, 3.0)
        plane = self._static * light[..., None] * self.water.light * np.float32(0.8)
        picture[:] = through_water(plane, seen, seen, picture)

    def _draw_surface(self, picture: Float32, time_s: float) -> None:
        """The surface from below: bright and dark patches of sky and mirrored water that ripple."""
        assert self._surface is not None
        x, z, seen = self._surface
        drift = np.float32(0.25 * time_s)
        wave = self._sample(self.ripples, x * np.float32(0.7) + drift, z * np.float32(1.4), 3.0)
        wave += np.float32(0.6) * self._sample(self.ripples, x - drift, z * np.float32(2.0) + drift, 1.3)
        bright = np.clip(0.5 + 0.4 * wave, 0.0, 1.6)
        plane = bright[..., None] * self.water.light * np.float32(0.75) + self.water.veil * np.float32(0.5)
        picture[:] = through_water(plane, seen, seen, picture)
