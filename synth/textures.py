"""Tileable textures of our own making: noise, caustics, sand, tiles, wood."""

from __future__ import annotations

import cv2
import numpy as np

from lightgesture.synth.raster import Float32


def periodic_noise(rng: np.random.Generator, size: int, roughness: float = 1.6) -> Float32:
    """Tileable noise (size, size) with power falling as 1/f^roughness, zero mean, unit variance."""
    frequency = np.fft.fftfreq(size)
    radius = np.hypot(frequency[:, None], frequency[None, :])
    radius[0, 0] = 1.0
    spectrum = np.exp(2j * np.pi * rng.random((size, size))) * radius**-roughness
    spectrum[0, 0] = 0.0
    field = np.fft.ifft2(spectrum).real
    return np.asarray(field / field.std(), np.float32)


def caustics(rng: np.random.Generator, size: int) -> Float32:
    """Tileable net of light (size, size), mean 1: thin bright lines around dark cells.

    Caustics are where the refracting surface's curvature focuses light; the ridges (values near zero) of smooth
    noise fields have the same look, and two that move against each other shimmer like them.
    """
    octave = 6  # cells across the tile
    frequency = np.fft.fftfreq(size, 1.0 / size)
    radius = np.hypot(frequency[:, None], frequency[None, :])
    band = np.exp(-(((radius - octave) / (0.35 * octave)) ** 2))
    field = np.fft.ifft2(np.exp(2j * np.pi * rng.random((size, size))) * band).real
    field /= field.std()
    net = 1.0 / (0.12 + np.abs(field))
    return np.asarray(net / net.mean(), np.float32)


def sand(rng: np.random.Generator, size: int) -> Float32:
    """Tileable rippled sand (size, size, 3), linear BGR albedo."""
    wander = periodic_noise(rng, size, 2.0) * np.float32(0.9)
    rows = np.linspace(0.0, 2.0 * np.pi * 14, size, endpoint=False, dtype=np.float32)[:, None]
    ripples = np.sin(rows + wander)
    grain = rng.standard_normal((size, size)).astype(np.float32)
    value = 0.42 * (1.0 + 0.09 * ripples + 0.1 * periodic_noise(rng, size) + 0.05 * grain)
    return np.asarray(value[..., None] * np.array([0.68, 0.86, 1.0]), np.float32)


def tiles(rng: np.random.Generator, size: int, count: int = 8) -> Float32:
    """Tileable pool floor (size, size, 3): pale tiles, grout, one dark lane line along the columns."""
    step = size // count
    value = np.repeat(np.repeat(rng.normal(0.72, 0.02, (count, count)), step, 0), step, 1).astype(np.float32)
    value = np.asarray(cv2.resize(value, (size, size), interpolation=cv2.INTER_NEAREST), np.float32)
    colour = value[..., None] * np.array([0.98, 1.0, 0.93], np.float32)
    width = max(size // 256, 1)
    for start in range(0, size, step):
        colour[start : start + width] *= np.float32(0.7)
        colour[:, start : start + width] *= np.float32(0.7)
    colour[:, : size // 16] = (0.05, 0.04, 0.03)
    colour *= 1.0 + np.float32(0.03) * periodic_noise(rng, size)[..., None]
    return np.asarray(colour, np.float32)


def rocks(rng: np.random.Generator, size: int) -> Float32:
    """Tileable reef or rubble (size, size, 3)."""
    shape = periodic_noise(rng, size, 1.3)
    tint = periodic_noise(rng, size, 1.8)
    value = 0.22 * np.exp(0.45 * shape)
    colour = np.stack([value * (0.6 - 0.1 * tint), value * 0.8, value * (0.9 + 0.25 * tint)], axis=-1)
    return np.asarray(np.clip(colour, 0.01, 0.9), np.float32)


FLOORS = {"sand": sand, "tiles": tiles, "rocks": rocks}


def wood(rng: np.random.Generator, rows: int, columns: int) -> Float32:
    """Wood grain (rows, columns), mean about 1, running along the longer side."""
    long, across = max(rows, columns), min(rows, columns)
    position = np.linspace(0.0, rng.uniform(6.0, 25.0), across, dtype=np.float32)[:, None]
    bend = cv2.resize(
        rng.standard_normal((3, 4)).astype(np.float32), (long, across), interpolation=cv2.INTER_CUBIC
    )
    value = 1.0 + 0.14 * np.sin(2.0 * np.pi * position + 2.5 * bend) + 0.06 * bend
    value += 0.04 * rng.standard_normal((across, long)).astype(np.float32)
    return np.asarray(value if columns >= rows else value.T, np.float32)
