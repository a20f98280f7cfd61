"""Light, water and camera: how the same hand looks elsewhere.

Water follows the usual model of underwater image formation, I = J exp(-c d) + B (1 - exp(-c d)) (Akkaynak and
Treibitz, "A revised underwater image formation model", CVPR 2018, with one coefficient a channel): red is taken
first, and a veil of the water's own colour lies over all.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image

Float = NDArray[np.float32]
Random = np.random.Generator


@dataclass(frozen=True, slots=True)
class LightSettings:
    """Shares are probabilities per copy, 0 to 1.

    gamma, contrast, gain: standard deviations of the logarithm of the exponent, of the contrast and of each
        channel's gain. gradient: largest change of brightness over the picture, a share.
    dark: share of dark copies among those not under water. darkest: brightness of the darkest, a share of
        the original's.
    backlit: share of copies with a darkened hand before a brightened background, where the hand's mask is known.
    water: share of copies under water. depth: largest optical depth in red. murk: largest veil's depth.
    blur: share of blurred copies. widest_blur: standard deviation in pixels.
    noise: largest standard deviation of the noise, grey levels of 255.
    """

    gamma: float = 0.25
    contrast: float = 0.2
    gain: float = 0.08
    gradient: float = 0.35
    dark: float = 0.25
    darkest: float = 0.2
    backlit: float = 0.12
    water: float = 0.35
    depth: float = 2.0
    murk: float = 1.0
    blur: float = 0.35
    widest_blur: float = 1.6
    noise: float = 8.0


def relight(image: Image, mask: Float | None, settings: LightSettings, random: Random) -> Image:
    """The picture in other light, uint8 of the same shape; `mask` (height, width), 1 on the hand, where known."""
    picture = image.astype(np.float32) * np.float32(1 / 255)
    if mask is not None and random.random() < settings.backlit:
        picture = _backlit(picture, mask, random)
    picture = _exposed(picture, settings, random)
    if random.random() < settings.water:
        picture = under_water(picture, settings, random)
    elif random.random() < settings.dark:
        picture *= np.float32(random.uniform(settings.darkest, 0.7))
    if random.random() < settings.blur:
        sigma = random.uniform(0.3, settings.widest_blur)
        picture = np.asarray(cv2.GaussianBlur(picture, (0, 0), sigma), np.float32)
    # One noise for the three channels: what matters to gradients is its strength, and drawing it takes long.
    noise = random.standard_normal((*picture.shape[:2], 1), np.float32)
    picture += noise * np.float32(random.uniform(0.0, settings.noise) / 255)
    return np.asarray(np.clip(picture, 0.0, 1.0) * 255, np.uint8)


def under_water(picture: Float, settings: LightSettings, random: Random) -> Float:
    """Attenuate and veil a picture, float32 (height, width, 3), BGR, 0 to 1."""
    depth = random.uniform(0.2, settings.depth)
    green = random.uniform(0.1, 0.5)
    blue = green * random.uniform(0.4, 1.6)
    attenuation = np.exp(-depth * np.float32([blue, green, 1.0]))  # type: ignore[arg-type]
    veil = np.float32([random.uniform(0.3, 0.9), random.uniform(0.3, 0.8), random.uniform(0.0, 0.25)])  # type: ignore[arg-type]
    through = np.float32(np.exp(-random.uniform(0.0, settings.murk)))
    return np.asarray(picture * attenuation * through + veil * (1 - through), np.float32)


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
