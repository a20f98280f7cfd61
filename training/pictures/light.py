"""Light, water and camera: how the same picture looks elsewhere.

Water is that of `synth.water`; here stand the ranges from which training pictures draw it. No distance is known in a
photograph, so what is drawn is all the water before it.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float, Image
from lightgesture.synth.water import WaterPath

Random = np.random.Generator

SCENE_GAMMA: Final = 1.6
"""Exponent that makes the values of a whole picture about linear."""
DEPTH: Final = (0.2, 2.0)
"""Optical depth in red of the water before a hand."""
MURK: Final = (0.0, 1.0)
"""Optical depth of the veil before a hand."""
DARKEST: Final = 0.2
"""Brightness of the darkest copy of a hand, a share of the original's."""


@dataclass(frozen=True, slots=True)
class LightSettings:
    """How far the light of copies of hands goes."""

    gamma: float = 0.25
    """Standard deviation of the exponent's logarithm, 0 to 1."""
    contrast: float = 0.2
    """Standard deviation of the contrast's logarithm, 0 to 1."""
    gain: float = 0.08
    """Standard deviation of the logarithm of each channel's gain, 0 to 1."""
    gradient: float = 0.35
    """Largest change of brightness over the picture, a share, 0 to 1."""
    dark: float = 0.25
    """Share of dark copies among those not under water, 0 to 1."""
    backlit: float = 0.12
    """Share of copies with a darkened hand before a brightened background, where the hand's mask is known, 0 to 1."""
    water: float = 0.35
    """Share of copies under water, 0 to 1."""
    blur: float = 0.35
    """Share of blurred copies, 0 to 1."""
    widest_blur: float = 1.6
    """Standard deviation of the widest blur, pixels, from 0.3."""
    grey: float = 0.0
    """Share of copies without colour, 0 to 1: under water a hand is hardly redder than what stands behind it."""
    noise: float = 8.0
    """Largest standard deviation of the noise, grey levels of 255."""


def relight(image: Image, mask: Float | None, settings: LightSettings, random: Random) -> Image:
    """The picture in other light, uint8 of the same shape; `mask` (height, width), 1 on the hand, where known."""
    picture = image.astype(np.float32) * np.float32(1 / 255)
    if mask is not None and random.random() < settings.backlit:
        picture = _backlit(picture, mask, random)
    if settings.grey and random.random() < settings.grey:
        picture = np.repeat(picture.mean(axis=2, keepdims=True), 3, axis=2)
    picture = _exposed(picture, settings, random)
    if random.random() < settings.water:
        picture = np.asarray(path_before_hand(random).see(picture), np.float32)
    elif random.random() < settings.dark:
        picture *= np.float32(random.uniform(DARKEST, 0.7))
    if random.random() < settings.blur:
        sigma = random.uniform(0.3, settings.widest_blur)
        picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), sigma), np.float32)
    # One noise for the three channels: what matters to gradients is its strength, and drawing it takes long.
    noise = random.standard_normal((*picture.shape[:2], 1), np.float32)
    picture += noise * np.float32(random.uniform(0.0, settings.noise) / 255)
    return np.asarray(np.clip(picture, 0.0, 1.0) * 255, np.uint8)


def path_before_hand(random: Random) -> WaterPath:
    """Water before a copy of a hand, whose values are taken as they are."""
    depth = random.uniform(*DEPTH)
    green = random.uniform(0.1, 0.5)
    blue = green * random.uniform(0.4, 1.6)
    absorbed = np.exp(-depth * np.array([blue, green, 1.0], np.float32))
    veil = [random.uniform(0.3, 0.9), random.uniform(0.3, 0.8), random.uniform(0.0, 0.25)]
    return WaterPath(absorbed, np.float32(np.exp(-random.uniform(*MURK))), np.array(veil, np.float32))


def path_before_scene(random: Random) -> WaterPath:
    """Water before a whole picture whose values were made linear with `SCENE_GAMMA`."""
    attenuation = np.array([random.uniform(0.05, 0.6), random.uniform(0.03, 0.4), random.uniform(0.5, 2.2)])
    absorbed = np.exp(-attenuation * random.uniform(0.3, 1.6))
    veil = np.array([random.uniform(0.3, 0.9), random.uniform(0.35, 0.9), random.uniform(0.02, 0.3)])
    veil *= random.uniform(0.3, 1.0)
    return WaterPath(absorbed, np.exp(-random.uniform(0.05, 1.1)), veil)


def _backlit(picture: Float, mask: Float, random: Random) -> Float:
    """Darken the hand and brighten what stands behind it."""
    hand = np.float32(random.uniform(0.15, 0.6))
    behind = np.float32(random.uniform(1.0, 1.8))
    return np.minimum(picture * (behind + (hand - behind) * mask[..., None]), np.float32(1.0))


def _exposed(picture: Float, settings: LightSettings, random: Random) -> Float:
    """Change gamma, contrast, colour balance, and brightness across the picture."""
    exponent = np.float32(np.exp(random.normal(0.0, settings.gamma)))
    picture = np.power(picture, exponent)
    mean = picture.mean()
    contrast = np.float32(np.exp(random.normal(0.0, settings.contrast)))
    gains = np.exp(random.normal(0.0, settings.gain, 3)).astype(np.float32)
    picture = (mean + (picture - mean) * contrast) * gains
    slope = random.uniform(-settings.gradient, settings.gradient, 2)
    rows, columns = picture.shape[:2]
    light = 1 + slope[0] * np.linspace(-1, 1, rows)[:, None] + slope[1] * np.linspace(-1, 1, columns)
    return np.asarray(np.clip(picture * light[..., None].astype(np.float32), 0.0, 1.0), np.float32)


def attenuate(image: Float, rng: Random) -> Float:
    """A whole picture under water, float32 (h, w, 3), 0 to 1."""
    linear = np.power(image, SCENE_GAMMA).astype(np.float64)
    mixed = path_before_scene(rng).see(linear)
    return np.asarray(np.power(np.clip(mixed, 0.0, 1.0), 1 / SCENE_GAMMA), np.float32)


def expose(image: Float, rng: Random) -> Image:
    """Blur, contrast and noise of a camera; the result in uint8."""
    if rng.random() < 0.5:
        image = np.asarray(cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.8)), np.float32)
    balance = rng.uniform(0.9, 1.1, 3)
    noisy = image * balance * rng.uniform(0.75, 1.15) + rng.normal(0, rng.uniform(0.002, 0.02), image.shape)
    return np.clip(noisy * 255.0, 0, 255).astype(np.uint8)


WATER_SHARE: Final = 0.3
DARK_SHARE: Final = 0.2
"""Of real pictures in air, those put under water and those put into the dark."""
GAMMA_SHARE: Final = 0.5
BALANCE_SHARE: Final = 0.5
CONTRAST_SHARE: Final = 0.4
GREY_SHARE: Final = 0.06
BLURRED_SHARE: Final = 0.25
NOISY_SHARE: Final = 0.6
"""Of all pictures, those with another exponent, white balance and contrast, without colour, blurred and noisy."""
DARKNESS: Final = (0.03, 0.3)
"""Factor on linear light."""
EXPONENT: Final = 0.4
"""Most change of its logarithm."""
BALANCE_SPREAD: Final = 0.12
"""Standard deviation of the logarithm of a channel's gain."""
BLUR_PX: Final = (0.4, 1.1)
"""Standard deviation of the Gaussian."""
NOISE: Final = (0.002, 0.025)
"""Standard deviation, over the full range."""
FINE: Final = 16
"""Steps of a grey level that the tables keep, so that a dark picture does not become stairs."""


def photometric(image: Image, rng: Random, in_air: bool) -> Image:
    """uint8 (h, w, 3) -> the same picture in another light. in_air: it may be put under water or into the dark.

    All that is pointwise goes through one table.
    """
    tones = np.clip(_tones(rng, in_air) * (255 * FINE), -3000, 8000).astype(np.float32)[None]
    if rng.random() < GREY_SHARE:
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        image = np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), np.uint8)
    out = np.asarray(cv2.LUT(image, tones), np.float32)
    if rng.random() < BLURRED_SHARE:
        out = np.asarray(cv2.GaussianBlur(out, (0, 0), rng.uniform(*BLUR_PX)), np.float32)
    if rng.random() < NOISY_SHARE:
        noise = rng.standard_normal(out.shape, dtype=np.float32)
        out = out + noise * np.float32(255 * FINE * rng.uniform(*NOISE))
    return np.clip(out / FINE, 0, 255).astype(np.uint8)


def _tones(rng: Random, in_air: bool) -> NDArray[np.float64]:
    """(256, 3), from 0 to about 1: what becomes of each value of each channel."""
    tones = np.repeat((np.arange(256) / 255.0)[:, None], 3, axis=1)
    draw = rng.random()
    if in_air and draw < WATER_SHARE:
        seen = path_before_scene(rng).see(tones**SCENE_GAMMA)
        tones = np.asarray(seen ** (1 / SCENE_GAMMA), np.float64)
    elif in_air and draw < WATER_SHARE + DARK_SHARE:
        tones = (tones**2.2 * rng.uniform(*DARKNESS)) ** (1 / 2.2)
    if rng.random() < GAMMA_SHARE:
        tones = tones ** np.exp(rng.uniform(-EXPONENT, EXPONENT))
    if rng.random() < BALANCE_SHARE:
        tones = tones * np.exp(rng.normal(0.0, BALANCE_SPREAD, 3))
    if rng.random() < CONTRAST_SHARE:
        tones = (tones - 0.5) * rng.uniform(0.6, 1.25) + 0.5 + rng.uniform(-0.12, 0.12)
    return tones
