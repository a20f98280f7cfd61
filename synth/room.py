"""Dry rooms to sign in: walls, windows with back light, lamps, and furniture of wood and leather as pale as skin.

Everything is made of rectangles with texture and shade, out of focus as rooms behind people are.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from lightgesture.synth.raster import Float32
from lightgesture.synth.shading import Light
from lightgesture.synth.textures import periodic_noise, wood

Colour = tuple[float, float, float]

# Linear BGR. Half of the furniture lies within the gamut of skin on purpose.
FURNITURE: tuple[Colour, ...] = (
    (0.10, 0.20, 0.36), (0.16, 0.29, 0.50), (0.28, 0.42, 0.62), (0.06, 0.10, 0.20), (0.20, 0.30, 0.42),
    (0.25, 0.25, 0.25), (0.05, 0.05, 0.06), (0.35, 0.18, 0.10), (0.08, 0.08, 0.32), (0.55, 0.56, 0.55),
)  # fmt: skip
WALLS: tuple[Colour, ...] = (
    (0.62, 0.66, 0.68), (0.42, 0.55, 0.66), (0.30, 0.42, 0.58), (0.50, 0.52, 0.40), (0.16, 0.15, 0.14),
    (0.25, 0.30, 0.36),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class RoomLook:
    """wall, wood: indices into WALLS and FURNITURE. pieces: furniture and pictures. window: brightness of the window
    against the wall, 0 for none. lamps: ceiling lights. level: brightness of the room's own light. blur: share of
    the width.
    """

    wall: int = 0
    pieces: int = 9
    window: float = 0.0
    lamps: int = 0
    level: float = 1.0
    blur: float = 0.003


class Room:
    """A still room; `frame` has the signature of `Backdrop.frame`."""

    def __init__(self, look: RoomLook, size: tuple[int, int], rng: np.random.Generator) -> None:
        self.look, self.size = look, size
        picture = self._walls(rng)
        for _ in range(look.pieces):
            self._furniture(picture, rng)
        for _ in range(look.lamps):
            x, y = rng.uniform(0.0, 1.0), rng.uniform(-0.02, 0.2)
            self._rectangle(picture, (x, y, x + rng.uniform(0.08, 0.3), y + 0.025), (2.4, 2.6, 2.6))
        if look.window > 0.0:
            self._window(picture, rng)
        sigma = look.blur * size[0]
        if sigma > 0.3:
            picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), sigma), np.float32)
        self._picture = picture

    def frame(self, time_s: float) -> Float32:
        """Linear picture (h, w, 3); rooms stand still, so time has no effect."""
        del time_s
        return self._picture.copy()

    def light(self, rng: np.random.Generator) -> Light:
        """Light on the person: from lamps above and, with a window behind, little from the front."""
        front = self.look.level * (0.55 if self.look.window > 0.0 else 0.8)
        warm = rng.uniform(0.85, 1.0)
        key, ambient = (front * warm * 0.9, front * 0.96, front), 0.45 * front
        x = float(rng.uniform(-0.8, 0.8))
        return Light((x, -0.75, 0.6), key, _grey(ambient), _grey(0.6 * ambient), shadow=0.6)

    def _walls(self, rng: np.random.Generator) -> Float32:
        width, height = self.size
        wall = np.array(WALLS[self.look.wall % len(WALLS)], np.float32) * np.float32(self.look.level)
        across = np.linspace(rng.uniform(0.5, 1.0), rng.uniform(0.5, 1.0), width, dtype=np.float32)
        down = np.linspace(1.0, rng.uniform(0.6, 0.9), height, dtype=np.float32)
        stain = 1.0 + np.float32(0.03) * cv2.resize(periodic_noise(rng, 128), (width, height))
        return np.asarray(down[:, None, None] * across[None, :, None] * stain[..., None] * wall, np.float32)

    def _rectangle(
        self, picture: Float32, corners: tuple[float, float, float, float], colour: Colour
    ) -> None:
        width, height = self.size
        x0, y0, x1, y1 = (int(v * s) for v, s in zip(corners, (width, height, width, height), strict=True))
        cv2.rectangle(picture, (x0, y0), (x1, y1), tuple(float(c) * self.look.level for c in colour), -1)

    def _furniture(self, picture: Float32, rng: np.random.Generator) -> None:
        """A cupboard, shelf, chair back, box or picture: a textured box with a lit top and a darker side."""
        width, height = self.size
        w, h = int(rng.uniform(0.06, 0.4) * width), int(rng.uniform(0.08, 0.55) * height)
        x, y = int(rng.uniform(-0.1, 0.95) * width), int(rng.uniform(0.05, 0.9) * height)
        x0, y0, x1, y1 = max(x, 0), max(y, 0), min(x + w, width), min(y + h, height)
        if x1 <= x0 or y1 <= y0:
            return
        colour = np.array(FURNITURE[int(rng.integers(len(FURNITURE)))], np.float32) * np.float32(
            self.look.level
        )
        grain = (
            wood(rng, y1 - y0, x1 - x0) if rng.uniform() < 0.6 else np.ones((y1 - y0, x1 - x0), np.float32)
        )
        shade = np.linspace(1.0, rng.uniform(0.5, 0.95), x1 - x0, dtype=np.float32)
        picture[y0:y1, x0:x1] = (grain * shade)[..., None] * colour
        edge = max(height // 120, 1)
        picture[y0 : y0 + edge, x0:x1] *= np.float32(1.5)
        picture[max(y1 - edge, y0) : y1, x0:x1] *= np.float32(0.45)
        if rng.uniform() < 0.4:  # shelves or drawers
            for row in range(y0, y1, max((y1 - y0) // int(rng.integers(2, 6)), 4)):
                picture[row : row + edge, x0:x1] *= np.float32(0.4)

    def _window(self, picture: Float32, rng: np.random.Generator) -> None:
        """A bright window with frame and blinds, and its glow on the walls around."""
        x, y = rng.uniform(-0.1, 0.7), rng.uniform(0.0, 0.25)
        w, h = rng.uniform(0.2, 0.5), rng.uniform(0.35, 0.6)
        bright = 1.6 * self.look.window
        self._rectangle(picture, (x, y, x + w, y + h), (bright * 1.08, bright * 1.02, bright))
        dark = (0.3, 0.3, 0.3)
        for part in np.linspace(0.0, 1.0, int(rng.integers(2, 5))):
            self._rectangle(picture, (x + part * w - 0.006, y, x + part * w + 0.006, y + h), dark)
        if rng.uniform() < 0.4:
            for row in np.arange(y, y + h, 0.035):
                self._rectangle(picture, (x, row, x + w, row + 0.012), _grey(bright * 0.6))
        glow = cv2.GaussianBlur(np.maximum(picture - 1.0, 0.0), (0, 0), 0.06 * self.size[0])
        picture += np.float32(0.25) * glow


def _grey(level: float) -> Colour:
    return (level, level, level)
