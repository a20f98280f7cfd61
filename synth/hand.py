"""One rendered hand: pose, proportions, skin and light in; pixels, coverage, box and landmarks out."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.atlas import paint_atlas
from lightgesture.synth.raster import Canvas, Float32
from lightgesture.synth.shading import Light, shade
from lightgesture.synth.skeleton import MEAN_PROPORTIONS, FloatArray, HandPose, Proportions
from lightgesture.synth.skin import Tone, skin_tone
from lightgesture.synth.surface import FOREARM, HAND, SLEEVE, Forearm, HandView, hand_cones, sleeve_row

Box = tuple[int, int, int, int]
SUPERSAMPLED_LENGTH_PX = 330.0
"""Longest hand (wrist to fingertip, after doubling) rendered at twice the resolution; larger ones alias less."""
HAND_LENGTH_MM = 190.0


@dataclass(frozen=True, slots=True)
class HandLook:
    """What stays the same about one person's hand: proportions, tone, texture atlas, sleeve colour (linear BGR)."""

    proportions: Proportions = MEAN_PROPORTIONS
    tone: Tone = field(default_factory=lambda: skin_tone(3.5))
    atlas: NDArray[np.uint8] = field(default_factory=lambda: paint_atlas(np.random.default_rng(0)))
    sleeve_bgr: tuple[float, float, float] = (0.02, 0.018, 0.015)


@dataclass(frozen=True, slots=True)
class HandImage:
    """A rendered hand. radiance: (h, w, 3) float32 linear BGR, premultiplied by `alpha` (h, w) 0..1. hand: (h, w)
    coverage of the hand without the forearm. origin: picture pixel of the upper left corner. box: (x, y, width,
    height) of the hand without the forearm in picture pixels. landmarks: (21, 3), picture pixels, height last.
    """

    radiance: Float32
    alpha: Float32
    hand: Float32
    origin: tuple[int, int]
    box: Box
    landmarks: FloatArray

    def paste(self, picture: Float32) -> None:
        """Lay the hand over a linear float picture (in place), clipped at its edges."""
        target, part = self._overlap(picture)
        picture[target] *= 1.0 - self.alpha[part][..., None]
        picture[target] += self.radiance[part]

    def cover(self, coverage: Float32) -> None:
        """Add the hand to a coverage picture (in place)."""
        target, part = self._overlap(coverage)
        np.maximum(coverage[target], self.alpha[part], out=coverage[target])

    def _overlap(self, picture: Float32) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
        """Where the hand lies in a picture, and which part of the hand that is."""
        rows, columns = self.alpha.shape
        x0, y0 = max(self.origin[0], 0), max(self.origin[1], 0)
        x1 = max(min(self.origin[0] + columns, picture.shape[1]), x0)
        y1 = max(min(self.origin[1] + rows, picture.shape[0]), y0)
        dx, dy = self.origin
        return np.s_[y0:y1, x0:x1], np.s_[y0 - dy : y1 - dy, x0 - dx : x1 - dx]


def encode(linear: Float32) -> NDArray[np.uint8]:
    """Linear light 0..1 to 8 bits with a gamma of 2.2 (the usual approximation of sRGB)."""
    clipped = np.clip(linear, 0.0, 1.0)
    return np.asarray(cv2.convertScaleAbs(cv2.pow(clipped, 1.0 / 2.2), alpha=255.0), np.uint8)


def decode(picture: NDArray[np.uint8]) -> Float32:
    """The reverse of `encode`."""
    table = (np.arange(256, dtype=np.float32) / np.float32(255.0)) ** np.float32(2.2)
    return np.asarray(table[picture], np.float32)


def render_hand(
    pose: HandPose,
    view: HandView,
    look: HandLook | None = None,
    light: Light | None = None,
    forearm: Forearm | None = None,
) -> HandImage:
    """Render one hand where `view` puts it. Fully outside pictures are fine: nothing is clipped here."""
    look, light, forearm = look or HandLook(), light or Light(), forearm or Forearm()
    factor = 2.0 if 2.0 * view.px_per_mm * HAND_LENGTH_MM <= SUPERSAMPLED_LENGTH_PX else 1.0
    big = HandView(
        view.rotation, (view.wrist[0] * factor, view.wrist[1] * factor), view.px_per_mm * factor,
        view.distance_mm, view.left,
    )  # fmt: skip
    cones, landmarks = hand_cones(pose, look.proportions, big, forearm)
    spheres = np.array([[*cone.start, *cone.end] for cone in cones]).reshape(-1, 4)
    low = np.floor((spheres[:, :2] - spheres[:, 3:]).min(axis=0) / factor).astype(int) - 2
    size = np.ceil((spheres[:, :2] + spheres[:, 3:]).max(axis=0) / factor).astype(int) + 2 - low
    corner = (int(low[0] * factor), int(low[1] * factor))
    canvas = Canvas(int(size[0] * factor), int(size[1] * factor), corner)
    for cone in cones:
        canvas.draw(cone)
    if forearm.sleeve_mm is not None:
        covered = (canvas.material == FOREARM) & (canvas.atlas[1] < sleeve_row(forearm.sleeve_mm))
        canvas.material[covered] = SLEEVE
    sleeve = np.array(look.sleeve_bgr, np.float32)
    radiance = shade(canvas, look.atlas, look.tone, sleeve, light, big.px_per_mm)
    cover = (canvas.material > 0).astype(np.float32)
    hand = (canvas.material == HAND).astype(np.float32)
    if factor > 1.0:
        target = (int(size[0]), int(size[1]))
        radiance, cover, hand = (_reduced(layer, target) for layer in (radiance, cover, hand))
    landmarks = landmarks / factor
    origin = (int(low[0]), int(low[1]))
    return HandImage(radiance, cover, hand, origin, mask_box(hand, origin), landmarks)


def _reduced(layer: Float32, size: tuple[int, int]) -> Float32:
    return np.asarray(cv2.resize(layer, size, interpolation=cv2.INTER_AREA), np.float32)


def mask_box(mask: Float32, origin: tuple[int, int] = (0, 0)) -> Box:
    """Tight box of the pixels that are at least half covered; (x, y, 0, 0) where there is none."""
    x, y, width, height = cv2.boundingRect((mask >= 0.5).astype(np.uint8))
    return (int(x) + origin[0], int(y) + origin[1], int(width), int(height))
