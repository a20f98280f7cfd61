"""Light, water and camera drawn anew for each training picture; all that is pointwise goes through one table."""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

Random = np.random.Generator
_FINE = 16
"""Steps of a grey level that the tables keep, so that a dark picture does not become stairs."""


@dataclass(frozen=True, slots=True)
class PhotometricSettings:
    """Shares are 0 to 1, and of pictures.

    water, dark: put under water or into the dark, of real pictures in air only. gamma, balance, contrast: changed
    exponent, white balance, contrast. grey: without colour. blurred, noisy: as said. darkness: factor on linear light.
    exponent: most change of its logarithm. balance_spread: standard deviation of a channel's logarithm. blur_px: of the
    Gaussian. noise: standard deviation, over the full range.
    """

    water: float = 0.3
    dark: float = 0.2
    gamma: float = 0.5
    balance: float = 0.5
    contrast: float = 0.4
    grey: float = 0.06
    blurred: float = 0.25
    noisy: float = 0.6
    darkness: tuple[float, float] = (0.03, 0.3)
    exponent: float = 0.4
    balance_spread: float = 0.12
    blur_px: tuple[float, float] = (0.4, 1.1)
    noise: tuple[float, float] = (0.002, 0.025)


def photometric(image: Image, rng: Random, in_air: bool, settings: PhotometricSettings) -> Image:
    """uint8 (h, w, 3) -> the same picture in another light. in_air: it may be put under water or into the dark."""
    tones = np.clip(_tones(rng, in_air, settings) * (255 * _FINE), -3000, 8000).astype(np.float32)[None]
    if rng.random() < settings.grey:
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        image = np.asarray(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR), np.uint8)
    out = np.asarray(cv2.LUT(image, tones), np.float32)
    if rng.random() < settings.blurred:
        out = np.asarray(cv2.GaussianBlur(out, (0, 0), rng.uniform(*settings.blur_px)), np.float32)
    if rng.random() < settings.noisy:
        noise = rng.standard_normal(out.shape, dtype=np.float32)
        out = out + noise * np.float32(255 * _FINE * rng.uniform(*settings.noise))
    return np.clip(out / _FINE, 0, 255).astype(np.uint8)


def _tones(rng: Random, in_air: bool, settings: PhotometricSettings) -> NDArray[np.float64]:
    """(256, 3), from 0 to about 1: what becomes of each value of each channel."""
    tones = np.repeat((np.arange(256) / 255.0)[:, None], 3, axis=1)
    draw = rng.random()
    if in_air and draw < settings.water:
        tones = _under_water(tones, rng)
    elif in_air and draw < settings.water + settings.dark:
        tones = (tones**2.2 * rng.uniform(*settings.darkness)) ** (1 / 2.2)
    if rng.random() < settings.gamma:
        tones = tones ** np.exp(rng.uniform(-settings.exponent, settings.exponent))
    if rng.random() < settings.balance:
        tones = tones * np.exp(rng.normal(0.0, settings.balance_spread, 3))
    if rng.random() < settings.contrast:
        tones = (tones - 0.5) * rng.uniform(0.6, 1.25) + 0.5 + rng.uniform(-0.12, 0.12)
    return tones


def _under_water(tones: NDArray[np.float64], rng: Random) -> NDArray[np.float64]:
    """The water of `composites.attenuate`, for tones instead of pixels."""
    attenuation = np.array([rng.uniform(0.05, 0.6), rng.uniform(0.03, 0.4), rng.uniform(0.5, 2.2)])
    transmission = np.exp(-attenuation * rng.uniform(0.3, 1.6))
    veil = np.array([rng.uniform(0.3, 0.9), rng.uniform(0.35, 0.9), rng.uniform(0.02, 0.3)])
    veil *= rng.uniform(0.3, 1.0)
    covered = 1.0 - np.exp(-rng.uniform(0.05, 1.1))
    return np.asarray((tones**1.6 * transmission * (1.0 - covered) + veil * covered) ** (1 / 1.6))
