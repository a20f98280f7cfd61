"""The camera: motion blur, exposure and white balance with their drift, sensor noise, compression.

Noise follows the Poisson-Gaussian model of Foi, Trimeche, Katkovnik & Egiazarian, "Practical Poissonian-Gaussian
noise modeling and fitting for single-image raw-data", IEEE TIP 17(10), 2008: variance = a * signal + b.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.hand import encode
from lightgesture.synth.motion import Drift
from lightgesture.synth.raster import Float32

Picture = NDArray[np.uint8]
NOISE_MARGIN = 192
"""How much wider and higher than a frame the stored noise is; each frame takes another window of it, pixels."""
CORNERS = 4096
"""Number of windows; noise comes round again after as many frames."""


@dataclass(frozen=True, slots=True)
class CameraLook:
    """Properties of a camera; light is linear, 1 is white.

    target: mean brightness that automatic exposure aims at. balance: how far automatic white balance removes the
    cast (0 none, 1 grey). drift: standard deviation of both, as a share. shot, read: a and the root of b of the
    noise model. blur_px: optical blur (standard deviation). motion_px: blur along the camera's own motion.
    jpeg: quality 1..100, 0 for none.
    """

    target: float = 0.24
    balance: float = 0.3
    drift: float = 0.03
    shot: float = 0.0006
    read: float = 0.004
    blur_px: float = 0.5
    motion_px: float = 0.0
    jpeg: int = 0


class Sensor:
    """Turns linear pictures of one `size` (width, height) into 8-bit frames; a frame's number decides its noise."""

    def __init__(
        self, look: CameraLook, size: tuple[int, int], rng: np.random.Generator, margin: int = NOISE_MARGIN
    ) -> None:
        self.look = look
        self._noise = rng.standard_normal((size[1] + margin, size[0] + margin, 3), np.float32)
        self._corners = rng.integers(0, margin + 1, (CORNERS, 2))
        self._drift = Drift(rng, 4, 0.15)
        self._angle = float(rng.uniform(0.0, np.pi))
        self._gain: Float32 | None = None

    def meter(self, picture: Float32) -> None:
        """Set exposure and white balance from a typical linear picture, as automatic cameras do."""
        mean = picture.reshape(-1, 3).mean(axis=0) + 1e-6
        cast = (mean.mean() / mean) ** self.look.balance
        self._gain = np.asarray(cast * self.look.target / float((mean * cast).mean()), np.float32)

    def expose(self, picture: Float32, frame: int, time_s: float) -> Picture:
        """The 8-bit BGR frame of a linear picture (which is used up)."""
        if self._gain is None:
            self.meter(picture)
        wander = 1.0 + self.look.drift * self._drift.at(time_s)
        picture *= self._gain * (wander[:3] * wander[3]).astype(np.float32)
        picture = self._blurred(picture)
        if self.look.shot > 0.0 or self.look.read > 0.0:
            self._add_noise(picture, frame)
        coded = encode(picture)
        if self.look.jpeg <= 0:
            return coded
        _, packed = cv2.imencode(".jpg", coded, [cv2.IMWRITE_JPEG_QUALITY, self.look.jpeg])
        return np.asarray(cv2.imdecode(packed, cv2.IMREAD_COLOR), np.uint8)

    def _blurred(self, picture: Float32) -> Float32:
        if self.look.blur_px > 0.2:
            picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), self.look.blur_px), np.float32)
        length = int(self.look.motion_px)
        if length >= 2:
            kernel = np.zeros((2 * length + 1, 2 * length + 1), np.float32)
            reach = 0.5 * length * np.array([np.cos(self._angle), np.sin(self._angle)])
            ends = [[round(length + s * float(r)) for r in reach] for s in (-1, 1)]
            cv2.line(kernel, ends[0], ends[1], 1.0)
            picture = np.asarray(cv2.filter2D(picture, -1, kernel / kernel.sum()), np.float32)
        return picture

    def _add_noise(self, picture: Float32, frame: int) -> None:
        rows, columns = picture.shape[:2]
        x, y = self._corners[frame % CORNERS]
        variance = np.float32(self.look.shot) * np.maximum(picture, 0.0) + np.float32(self.look.read**2)
        picture += self._noise[y : y + rows, x : x + columns] * cv2.sqrt(variance)


def draw_camera(rng: np.random.Generator) -> CameraLook:
    """A camera of changing quality, for single pictures."""
    return CameraLook(
        target=float(rng.uniform(0.12, 0.4)), balance=float(rng.uniform(0.0, 0.6)), drift=0.0,
        shot=0.0006 * float(rng.uniform(0.1, 3.0)), read=0.004 * float(rng.uniform(0.1, 2.0)),
        blur_px=float(rng.uniform(0.0, 1.1)), jpeg=int(rng.integers(40, 96)) if rng.uniform() < 0.6 else 0,
        motion_px=float(rng.uniform(2.0, 5.0)) if rng.uniform() < 0.1 else 0.0,
    )  # fmt: skip


def photographed(picture: Float32, look: CameraLook, rng: np.random.Generator) -> Picture:
    """The 8-bit BGR photograph of one linear picture (h, w, 3), which is used up."""
    return Sensor(look, (picture.shape[1], picture.shape[0]), rng, margin=0).expose(picture, 0, 0.0)
