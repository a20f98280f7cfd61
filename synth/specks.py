"""What drifts between camera and diver: particles ("marine snow"), bubbles of the regulator, and the mirror image in
the water's surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import cv2
import numpy as np

from lightgesture.synth.body import Camera
from lightgesture.synth.raster import Float32
from lightgesture.synth.skeleton import FloatArray
from lightgesture.synth.water import Water

FIXED_POINT_BITS = 4


# Lengths in millimetres, speeds in mm/s.
NEAR: Final = 250.0
FAR: Final = 2500.0
"""Range of particles before the camera."""
SIZE: Final = (0.4, 1.6)
"""Smallest and largest radius of a particle."""
DRIFT: Final = 40.0
"""Speed of particles, standard deviation."""
BRIGHTNESS: Final = 0.5
"""Of a particle against the light."""
BUBBLE_RADIUS: Final = (3.0, 16.0)
"""Smallest and largest."""
RISE: Final = 280.0
"""Speed of bubbles; small ones reach 0.2 to 0.35 m/s (Clift, Grace & Weber, "Bubbles, drops, and particles", 1978,
ch. 7)."""
BREATH_S: Final = 4.0
EXHALE: Final = 0.4
"""Share of a breath, its first part, in which bubbles leave."""
LIFE_S: Final = 3.0
"""Of a bubble."""
MIRRORED: Final = 0.6
"""Brightness of the diver's image in the surface against the diver's own: at shallow angles nearly all is reflected."""


class Particles:
    """Specks that drift through a box in front of the camera and come round again."""

    def __init__(self, count: int, camera: Camera, size: tuple[int, int], rng: np.random.Generator) -> None:
        self._camera, self._size = camera, size
        depth = NEAR + (FAR - NEAR) * rng.uniform(0.0, 1.0, count) ** 0.6
        reach = np.column_stack([0.7 * depth * size[0], 0.7 * depth * size[1]]) / camera.focal
        self._depth, self._reach = depth, reach
        self._start = rng.uniform(-1.0, 1.0, (count, 2)) * reach
        self._speed = rng.normal(0.0, DRIFT, (count, 2)) + np.array([0.0, -0.3 * DRIFT])
        self._radius = rng.uniform(*SIZE, count)
        self._strength = rng.uniform(0.2, 1.0, count)

    def draw(self, picture: Float32, time_s: float, water: Water) -> None:
        """Add the light that the specks scatter (in place)."""
        place = self._start + self._speed * time_s
        place = (place + self._reach) % (2.0 * self._reach) - self._reach
        image, scale = self._camera.project(np.column_stack([place, self._depth]))
        layer = np.zeros((self._size[1] // 2, self._size[0] // 2), np.float32)
        radius = np.maximum(0.5 * scale * self._radius, 0.4)
        unit = 1 << FIXED_POINT_BITS
        spots = np.column_stack([0.5 * image * unit, radius * unit]).astype(int).tolist()
        for (x, y, r), strength in zip(spots, self._strength.tolist(), strict=True):
            cv2.circle(layer, (x, y), r, strength, -1, cv2.LINE_AA, FIXED_POINT_BITS)
        layer = np.asarray(cv2.resize(cv2.GaussianBlur(layer, (0, 0), 0.8), self._size), np.float32)
        picture += layer[..., None] * (water.light * np.float32(BRIGHTNESS))


class Bubbles:
    """Bubbles that leave the regulator in breaths, rise and wobble."""

    def __init__(self, rate: float, camera: Camera, rng: np.random.Generator) -> None:
        self._rate, self._camera = rate, camera
        self._phase = float(rng.uniform(0.0, 1.0))
        self._random = rng.uniform(0.0, 1.0, (997, 5))

    def at(self, time_s: float, mouth: FloatArray) -> Iterator[tuple[FloatArray, float, float]]:
        """Camera point (3,), radius in mm and age share 0..1 of each bubble; `mouth`: camera point of the regulator."""
        last = int(time_s * self._rate)
        for number in range(last, last - int(LIFE_S * self._rate) - 1, -1):
            born = number / self._rate
            if number < 0 or (born / BREATH_S + self._phase) % 1.0 > EXHALE:
                continue
            a, b, c, d, e = self._random[number % len(self._random)]
            age = time_s - born
            side = 90.0 if d < 0.5 else -90.0
            wobble = 25.0 * np.sin(9.0 * age + 6.3 * a)
            spread = np.array(
                [
                    (b - 0.5) * 90.0 * age + wobble + side,
                    RISE * (0.7 + 0.6 * c) * age,
                    (e - 0.5) * 120.0,
                ]
            )
            low, high = BUBBLE_RADIUS
            yield mouth + spread, low + (high - low) * a**3, age / LIFE_S

    def draw(self, picture: Float32, time_s: float, mouth: FloatArray, water: Water) -> None:
        """Draw rings with a highlight (in place)."""
        for point, radius_mm, age in self.at(time_s, mouth):
            image, scale = self._camera.project(point[None])
            radius = float(scale[0]) * radius_mm * (1.0 + 0.3 * age)
            x, y, reach = float(image[0, 0]), float(image[0, 1]), int(radius) + 3
            x0, y0 = int(x) - reach, int(y) - reach
            window = picture[max(y0, 0) : max(y0 + 2 * reach, 0), max(x0, 0) : max(x0 + 2 * reach, 0)]
            if window.size == 0:
                continue
            rows, columns = np.mgrid[0 : window.shape[0], 0 : window.shape[1]].astype(np.float32)
            dx, dy = columns + max(x0, 0) - x, rows + max(y0, 0) - y
            distance = np.sqrt(dx * dx + dy * dy) / np.float32(max(radius, 0.8))
            rim = np.exp(-(((distance - 0.85) / 0.22) ** 2)) * (0.55 - 0.45 * dy / (abs(dy).max() + 1e-3))
            spot = np.exp(-((dx / radius + 0.3) ** 2 + (dy / radius + 0.35) ** 2) * 18.0)
            window += (0.35 * rim + 0.6 * spot)[..., None] * water.light


def mirror_in_surface(picture: Float32, cover: Float32, line: float, ripples: Float32, time_s: float) -> None:
    """Lay the diver's image, mirrored about row `line` and broken by ripples, over the surface above it (in place).

    cover (h, w): where the diver is. ripples: tileable noise. At shallow angles the surface reflects totally, so the
    image is nearly as bright as the diver.
    """
    rows = min(int(line), picture.shape[0])
    if rows < 4:
        return
    height, width = picture.shape[:2]
    y, x = np.mgrid[0:rows, 0:width].astype(np.float32)
    size = np.float32(ripples.shape[0])
    depth = (np.float32(line) - y) / np.float32(max(line, 1.0))
    u, v = (x * 0.55 + 40.0 * time_s) % size, (y * (2.5 - depth) * 1.6 + 25.0 * time_s) % size
    wave = np.asarray(
        cv2.remap(ripples, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR), np.float32
    )
    amount = (0.25 + depth) * np.float32(0.016 * width)
    source_x, source_y = x + wave * amount, 2.0 * np.float32(line) - y + np.roll(wave, 37, 1) * amount
    source_x, source_y = source_x.astype(np.float32), np.clip(source_y, 0, height - 1).astype(np.float32)
    image = np.asarray(cv2.remap(picture, source_x, source_y, cv2.INTER_LINEAR), np.float32)
    seen = np.asarray(cv2.remap(cover, source_x, source_y, cv2.INTER_LINEAR), np.float32)
    seen *= np.float32(MIRRORED) * np.clip(1.0 - 0.45 * wave, 0.0, 1.0)
    top = picture[:rows]
    top += seen[..., None] * (image - top)
