"""Light on a canvas of round cones: soft normals, occlusion, shadow, skin reflectance.

All arithmetic is in linear light. Occlusion in the gaps between fingers is the unsharp mask of the depth buffer
(Luft, Colditz & Deussen, "Image enhancement by unsharp masking the depth buffer", ACM TOG 25(3), 2006). The red
glow at the edge of shadow is wrap lighting with a wider wrap for red, the usual cheap stand-in for subsurface
scattering (Green, "Real-time approximations to subsurface scattering", GPU Gems, 2004, ch. 16).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.atlas import smoothstep, unpack_texture
from lightgesture.synth.raster import LAYOUT, Canvas, Float32
from lightgesture.synth.skin import BLOOD_DENSITY_BGR, Tone
from lightgesture.synth.surface import FOREARM, HAND, SLEEVE
from lightgesture.synth.water import Water

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Light:
    """Illumination in image axes (x right, y down, z towards the camera), linear light, BGR.

    direction: towards the light, any length. key: its colour. sky / ground: ambient from above / below.
    shadow: 0 none .. 1 full darkness in cast shadows (water and overcast sky scatter, so rarely above 0.7).
    """

    direction: tuple[float, float, float] = (-0.3, -0.7, 0.65)
    key: tuple[float, float, float] = (0.75, 0.75, 0.75)
    sky: tuple[float, float, float] = (0.38, 0.38, 0.38)
    ground: tuple[float, float, float] = (0.2, 0.2, 0.2)
    shadow: float = 0.55


def triple(values: NDArray[np.floating]) -> tuple[float, float, float]:
    """A colour as plain numbers."""
    return float(values[0]), float(values[1]), float(values[2])


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


def daylight(water: Water, direction: tuple[float, float, float], strength: float = 1.0) -> Light:
    """Daylight that comes down through the water, and what the water scatters from around."""
    return Light(
        direction=direction,
        key=triple(water.light * np.float32(0.85 * strength)),
        sky=triple(water.light * np.float32(0.42 * strength)),
        ground=triple(water.veil * np.float32(0.7)),
        shadow=0.45,
    )


# The skin's response; lengths in millimetres.
WRAP_BGR: Final = (0.12, 0.2, 0.45)
"""How far diffuse light wraps beyond the terminator."""
SMOOTH_MM: Final = 3.2
"""Smoothing of the flesh of palm and forearm."""
OCCLUSION: Final = ((3.5, 0.12, 3.2), (11.0, 0.03, 9.0))
"""Radius of a blur of the depth, darkening per millimetre below it, and the depth up to which it darkens: what lies far
behind is lit from the side again."""
OCCLUSION_BGR: Final = (1.08, 1.05, 0.92)
"""Share of the darkening that each channel has."""
SHADOW_STEPS: Final = 5
SHADOW_STEP_MM: Final = 5.0
"""Length of each of so many steps, which together are the reach of a cast shadow."""
SHININESS: Final = 22
"""Exponent of the highlight."""
GLOSS_SKIN: Final = 0.16
"""Strength of the highlight per unit of a tone's gloss."""
GLOSS_NAIL: Final = 0.45
"""The same of a nail."""
GLOSS_SLEEVE: Final = 0.03
"""Strength of the highlight itself."""


def soften(canvas: Canvas, mask: Mask, sigma: float) -> None:
    """Replace the normals inside `mask` by those of the smoothed height (in place); outlines keep their own.

    Palm and forearm are unions of cones whose edges would show; flesh has none.
    """
    weight = mask.astype(np.float32)
    spread = np.asarray(cv2.GaussianBlur(weight, (0, 0), sigma), np.float32)
    smooth = np.asarray(
        cv2.GaussianBlur(np.where(mask, canvas.height, np.float32(0.0)), (0, 0), sigma), np.float32
    )
    smooth /= np.maximum(spread, np.float32(1e-3))
    dx = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, ksize=3, scale=0.125)
    dy = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, ksize=3, scale=0.125)
    inverse = 1.0 / np.sqrt(1.0 + dx * dx + dy * dy)
    share = np.clip(2.0 * spread - 1.0, 0.0, 1.0) * weight
    share = np.sqrt(share)
    for axis, value in enumerate((-dx * inverse, -dy * inverse, inverse)):
        canvas.normal[axis] += share * (value - canvas.normal[axis])


def occlusion(height: Float32, mask: Mask, px_per_mm: float) -> Float32:
    """Darkening 0..1 of points that lie below their surroundings."""
    weight = mask.astype(np.float32)
    depth = np.where(mask, height, np.float32(0.0))
    dark = np.zeros_like(height)
    for radius, strength, reach in OCCLUSION:
        size = (2 * int(radius * px_per_mm) + 1,) * 2
        mean = cv2.blur(cv2.blur(depth, size), size) / np.maximum(
            cv2.blur(cv2.blur(weight, size), size), 1e-3
        )
        below = np.clip(mean - height, 0.0, np.float32(reach * px_per_mm))
        dark += np.float32(strength / px_per_mm) * below
    return np.asarray(np.clip(dark, 0.0, 0.85) * weight, np.float32)


def cast_shadow(height: Float32, light: Light, px_per_mm: float) -> Float32:
    """Soft shadow 0..1 by marching the height field towards the light."""
    lx, ly, lz = np.array(light.direction) / np.linalg.norm(light.direction)
    shadow = np.zeros_like(height)
    rows, columns = height.shape
    for step in range(1, SHADOW_STEPS + 1):
        reach = step * SHADOW_STEP_MM * px_per_mm
        move = np.array([[1.0, 0.0, -lx * reach], [0.0, 1.0, -ly * reach]], np.float32)
        blocker = cv2.warpAffine(height, move, (columns, rows), flags=cv2.INTER_NEAREST, borderValue=-1e4)
        excess = (blocker - height - np.float32(lz * reach)) * np.float32(1.0 / (4.0 * px_per_mm))
        np.maximum(shadow, np.clip(excess, 0.0, 1.0), out=shadow)
    return np.asarray(cv2.blur(shadow, (3, 3)), np.float32)


def albedo(
    canvas: Canvas, pixels: NDArray[np.intp], atlas: NDArray[np.uint8], tone: Tone, sleeve_bgr: Float32
) -> tuple[Float32, Float32]:
    """Reflectance (n, 3) and gloss (n,) of the given flat pixel indices."""
    texture = np.asarray(cv2.remap(atlas, canvas.atlas[0], canvas.atlas[1], cv2.INTER_LINEAR), np.uint8)
    factor, palm, blood, nail = unpack_texture(texture.reshape(-1, 4)[pixels])
    palm *= smoothstep(-0.45, 0.45, canvas.palmar.reshape(-1)[pixels])
    colour = tone.back + palm[:, None] * (tone.palm - tone.back)
    if not tone.glove:  # first order of the exponential: the change is small
        colour *= 1.0 - blood[:, None] * BLOOD_DENSITY_BGR.astype(np.float32)
    colour += nail[:, None] * (tone.nail - colour)
    gloss = tone.gloss * (GLOSS_SKIN * (1.0 - 0.3 * palm) + GLOSS_NAIL * nail)
    sleeve = canvas.material.reshape(-1)[pixels] == SLEEVE
    colour[sleeve] = sleeve_bgr
    gloss[sleeve] = GLOSS_SLEEVE
    colour *= factor[:, None]
    return np.asarray(colour, np.float32), np.asarray(gloss, np.float32)


def shade(
    canvas: Canvas, atlas: NDArray[np.uint8], tone: Tone, sleeve_bgr: Float32, light: Light, px_per_mm: float
) -> Float32:
    """Radiance (h, w, 3), linear BGR, of everything on the canvas; black elsewhere."""
    mask = canvas.material > 0
    soft_skin = (canvas.atlas[1] < LAYOUT.palm_height) & (canvas.material == HAND)
    soften(canvas, soft_skin | (canvas.material == FOREARM), SMOOTH_MM * px_per_mm)
    sleeve = canvas.material == SLEEVE
    if sleeve.any():
        soften(canvas, sleeve, SMOOTH_MM * px_per_mm)
    pixels = np.flatnonzero(mask)
    closed = occlusion(canvas.height, mask, px_per_mm).reshape(-1)[pixels]
    reach = 1.0 - np.float32(light.shadow) * cast_shadow(canvas.height, light, px_per_mm).reshape(-1)[pixels]
    colour, gloss = albedo(canvas, pixels, atlas, tone, sleeve_bgr)
    normal = canvas.normal.reshape(3, -1)[:, pixels]
    radiance = np.zeros((*canvas.height.shape, 3), np.float32)
    radiance.reshape(-1, 3)[pixels] = reflected(normal, colour, gloss, closed, reach, light)
    return radiance


def reflected(
    normal: Float32, colour: Float32, gloss: Float32, closed: Float32, reach: Float32, light: Light
) -> Float32:
    """Light (n, 3) that points with normals (3, n), reflectance (n, 3) and gloss (n,) send to the camera.

    closed: occlusion 0..1. reach: share of the key light that is not in shadow.
    """
    towards = np.array(light.direction, np.float32) / np.float32(np.linalg.norm(light.direction))
    lit = towards @ normal
    up = np.clip(0.5 - 0.5 * normal[1], 0.0, 1.0)
    half = towards + np.array([0.0, 0.0, 1.0], np.float32)
    half /= np.float32(np.linalg.norm(half))
    facing: Float32 = np.clip(half @ normal, 0.0, 1.0).astype(np.float32)
    highlight = gloss * _power(facing, SHININESS) * reach * (1.0 - closed)
    radiance = np.empty_like(colour)
    for channel in range(3):
        wrap, key = WRAP_BGR[channel], np.float32(light.key[channel])
        diffuse = np.clip((lit + np.float32(wrap)) * np.float32(1.0 / (1.0 + wrap)), 0.0, 1.0) * reach
        ambient = np.float32(light.ground[channel]) + up * np.float32(
            light.sky[channel] - light.ground[channel]
        )
        total = (diffuse * key + ambient) * (1.0 - np.float32(OCCLUSION_BGR[channel]) * closed)
        radiance[:, channel] = colour[:, channel] * total + highlight * key
    return np.maximum(radiance, 0.0)


def _power(base: Float32, exponent: int) -> Float32:
    """Integer power by squaring, several times faster than np.power on float32."""
    result, square = np.ones_like(base), base
    while exponent:
        if exponent & 1:
            result = result * square
        square = square * square
        exponent >>= 1
    return result
