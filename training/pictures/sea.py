"""Dry hands as dives show them: colour, contrast, blur, size and compression of real divers' hands, and gloves.

Nearly all labelled hands are of bare hands in rooms. What a model makes of a diver's hand is decided by what is left of
it under water: one colour, a tenth of the contrast, a few dozen pixels, and the blocks of a video's compression. All of
these are taken from pictures of real divers, a look at a time, and given to a copy.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Float, Image

Random = np.random.Generator

REACH: Final = 1.3
"""Side of what a look is measured on, over the longer side of the hand's box."""
COLOUR_LEFT: Final = (0.0, 0.6)
"""Share of a copy's own colours that water leaves; the rest is one brightness in all channels."""
SPREAD: Final = 0.25
"""Standard deviation of the logarithm by which contrast and size differ from those of the look that is taken."""
BLUR: Final = (0.3, 0.9)
"""Standard deviation of the blur, pixels of the dive's picture."""
NOISE: Final = (0.6, 2.2)
"""Standard deviation of the camera's noise, grey levels."""
QUALITY: Final = (30, 90)
"""Of the JPEG compression, which stands for that of videos, too."""
LEAST_SIDE: Final = 20
"""Pixels to which a copy is reduced at most."""
PLANE: Final = (0.0, 0.85)
"""Share of the variance that is a brightness which grows evenly over the picture: half of what a bare hand's picture
shows and four fifths of a dark glove's before bright water."""
UPWARDS: Final = 25.0
"""Standard deviation of the direction in which it grows, degrees from upwards, where the surface is."""
GLOVES: Final = 0.15
"""Share of copies with a glove of any colour, where the hand's outline is known and the look is no glove's."""
SILHOUETTE: Final = (0.25, 0.75)
"""Brightness of a glove over that of what stands behind it, for looks of gloves: most are dark before bright water."""
THICKER: Final = 0.03
"""By how much of the hand's side a glove is thicker all round, at most."""
GLOVE_COLOURS: Final = (
    (0.03, 0.03, 0.03),
    (0.10, 0.09, 0.09),
    (0.30, 0.12, 0.06),
    (0.10, 0.55, 0.65),
    (0.75, 0.75, 0.75),
)
"""Reflectance in blue, green and red of gloves: black, dark grey, blue, yellow, white."""
SHADING_LEFT: Final = (0.3, 0.8)
"""Exponent of the hand's own shading on a glove, whose cloth hides the finer of it."""


@dataclass(frozen=True, slots=True)
class SeaLook:
    """What a picture of a diver's hand is like. mean, deviation: of blue, green and red, grey levels. side: longer side
    of the hand, pixels. gloved: whether it wears a glove."""

    mean: tuple[float, float, float]
    deviation: tuple[float, float, float]
    side: float
    gloved: bool = False


def measure_look(image: Image, box: Box, is_gloved: bool) -> SeaLook:
    """The look of a hand, uint8 BGR; box: of the hand, partly inside the picture."""
    x, y, width, height = box
    side = max(width, height)
    reach = 0.5 * REACH * side
    rows, columns = image.shape[:2]
    top, bottom = max(0, int(y + height / 2 - reach)), min(rows, int(y + height / 2 + reach) + 1)
    left, right = max(0, int(x + width / 2 - reach)), min(columns, int(x + width / 2 + reach) + 1)
    mean, deviation = cv2.meanStdDev(image[top:bottom, left:right])
    blue, green, red = mean.ravel().tolist()
    own = deviation.ravel().tolist()
    return SeaLook((blue, green, red), (own[0], own[1], own[2]), float(side), is_gloved)


def submerge(
    image: Image, mask: Float | None, side: float, looks: Sequence[SeaLook], random: Random
) -> Image:
    """A copy of a hand as a dive would show it, uint8 of the same shape.

    mask: float32 (height, width), 1 on the hand, where known. side: of the hand, pixels, the longer one. looks: one or
    more.
    """
    look = looks[int(random.integers(len(looks)))]
    picture = image.astype(np.float32)
    if mask is not None and look.gloved:
        picture = _silhouette(picture, mask, side, random)
    elif mask is not None and random.random() < GLOVES:
        picture = gloved(picture, mask, random)
    picture = _coloured_as(picture, look, random)
    return _recorded(picture, look.side * float(np.exp(random.normal(0.0, SPREAD))) / side, random)


def gloved(picture: Float, mask: Float, random: Random) -> Float:
    """The hand in a glove of one colour that keeps a part of its shading; values 0 to 255."""
    brightness = picture.mean(axis=2)
    level = max(float((brightness * mask).sum() / max(float(mask.sum()), 1.0)), 1.0)
    shading = np.power(np.maximum(brightness / level, 0.05), random.uniform(*SHADING_LEFT))
    colour = np.array(GLOVE_COLOURS[int(random.integers(len(GLOVE_COLOURS)))], np.float32)
    colour = colour * np.exp(random.normal(0.0, 0.25, 3)).astype(np.float32)
    cloth = np.minimum(shading[..., None] * colour * 255.0, 255.0)
    return np.asarray(picture + mask[..., None] * (cloth - picture), np.float32)


def _silhouette(picture: Float, mask: Float, side: float, random: Random) -> Float:
    """The hand in a thick glove that is darker than what stands behind it."""
    reach = 2 * round(0.5 * random.uniform(0.0, 2 * THICKER) * side) + 1
    thick = np.asarray(cv2.dilate(mask, np.ones((reach, reach), np.uint8)), np.float32)
    behind = (picture * (1.0 - thick)[..., None]).sum(axis=(0, 1)) / max(float((1.0 - thick).sum()), 1.0)
    brightness = picture.mean(axis=2)
    level = max(float((brightness * mask).sum() / max(float(mask.sum()), 1.0)), 1.0)
    shading = np.power(np.maximum(brightness / level, 0.1), random.uniform(0.0, SHADING_LEFT[0]))
    cloth = np.minimum(shading[..., None] * behind * random.uniform(*SILHOUETTE), 255.0)
    return np.asarray(picture + thick[..., None] * (cloth - picture), np.float32)


def _coloured_as(picture: Float, look: SeaLook, random: Random) -> Float:
    """Mean and deviation of each channel as the look's, the channels nearly alike before."""
    brightness = picture @ random.dirichlet((1.0, 3.0, 2.0)).astype(np.float32)
    left = np.float32(random.uniform(*COLOUR_LEFT))
    mixed = brightness[..., None] + left * (picture - brightness[..., None])
    mean, deviation = mixed.reshape(-1, 3).mean(axis=0), mixed.reshape(-1, 3).std(axis=0)
    contrast = np.float32(np.exp(random.normal(0.0, SPREAD)))
    wanted = np.array(look.deviation, np.float32) * contrast
    share = np.float32(random.uniform(*PLANE))
    even = (mixed - mean) / np.maximum(deviation, 1.0)
    plane = _plane(picture.shape[:2], random)[..., None]
    shown = (np.sqrt(1 - share) * even + np.sqrt(share) * plane) * wanted + np.array(look.mean, np.float32)
    return np.asarray(np.clip(shown, 0.0, 255.0), np.float32)


def _plane(shape: tuple[int, ...], random: Random) -> Float:
    """Brightness that grows evenly towards about upwards, mean 0 and deviation 1."""
    angle = np.deg2rad(random.normal(0.0, UPWARDS))
    rows, columns = np.linspace(-1, 1, shape[0])[:, None], np.linspace(-1, 1, shape[1])
    plane = columns * np.sin(angle) - rows * np.cos(angle)
    return np.asarray(plane / plane.std(), np.float32)


def _recorded(picture: Float, scale: float, random: Random) -> Image:
    """As a camera and a codec leave it, at `scale` of its pixels, brought back to its own size."""
    rows, columns = picture.shape[:2]
    scale = min(1.0, max(scale, LEAST_SIDE / max(rows, columns)))
    size = max(2, round(columns * scale)), max(2, round(rows * scale))
    small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), random.uniform(*BLUR))
    noise: NDArray[np.float32] = random.standard_normal((size[1], size[0], 1), np.float32)
    seen = np.clip(small + noise * np.float32(random.uniform(*NOISE)), 0.0, 255.0).astype(np.uint8)
    coded = cv2.imencode(".jpg", seen, [cv2.IMWRITE_JPEG_QUALITY, int(random.integers(*QUALITY))])[1]
    decoded = np.asarray(cv2.imdecode(coded, cv2.IMREAD_COLOR), np.uint8)
    return np.asarray(cv2.resize(decoded, (columns, rows), interpolation=cv2.INTER_LINEAR), np.uint8)
