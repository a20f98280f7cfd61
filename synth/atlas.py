"""The texture atlas of a hand: creases, nails, mottling, palm lines and veins, painted once for each person.

Layers of a texel, 8 bits each: albedo factor (128 is 1), how far the palmar side has a palm's colour, change of blood
(128 is 0, 64 a unit) and nail. `raster.LAYOUT` says where the tiles lie.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.raster import LAYOUT, Float32

LIMB_ROWS, LIMB_COLUMNS = 3, 5


def smoothstep(low: float, high: float, values: Float32) -> Float32:
    """Cubic ramp from 0 at `low` to 1 at `high` (either may be the larger)."""
    part = np.clip((values - np.float32(low)) / np.float32(high - low), 0.0, 1.0)
    return np.asarray(part * part * (3.0 - 2.0 * part), np.float32)


def noise(rng: np.random.Generator, rows: int, columns: int, cell: float) -> Float32:
    """Smooth noise (rows, columns), about unit variance, with features of `cell` pixels."""
    small = (max(int(rows / cell), 2), max(int(columns / cell), 2))
    coarse = rng.standard_normal(small).astype(np.float32)
    return np.asarray(cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_CUBIC), np.float32)


@dataclass(slots=True)
class _Tile:
    """Layers of one tile: albedo factor around 1, how far the palmar side has a palm's colour 0..1, blood change
    around 0, nail 0..1.
    """

    shade: Float32
    palm: Float32
    blood: Float32
    nail: Float32

    def packed(self) -> NDArray[np.uint8]:
        layers = [self.shade * 128.0, self.palm * 255.0, self.blood * 64.0 + 128.0, self.nail * 255.0]
        return np.clip(np.stack(layers, axis=-1), 0.0, 255.0).astype(np.uint8)


def unpack_texture(texture: NDArray[np.uint8]) -> tuple[Float32, Float32, Float32, Float32]:
    """Layers (albedo factor, palmness, blood change, nail) of sampled atlas values (..., 4)."""
    values = texture.astype(np.float32)
    return (
        values[..., 0] * np.float32(1 / 128),
        values[..., 1] * np.float32(1 / 255),
        (values[..., 2] - 128.0) * np.float32(1 / 64),
        values[..., 3] * np.float32(1 / 255),
    )


def paint_atlas(rng: np.random.Generator, glove: bool = False) -> NDArray[np.uint8]:
    """The texture atlas (h, w, 4) of one person's hand; tiles lie as `raster.LAYOUT` says."""
    rows = int(LAYOUT.palm_height + LIMB_ROWS * LAYOUT.limb_height)
    atlas = np.zeros((rows, int(LIMB_COLUMNS * LAYOUT.limb_width), 4), np.uint8)
    palm_rows, palm_columns = int(LAYOUT.palm_height), int(LAYOUT.palm_width)
    atlas[:palm_rows, :palm_columns] = _palm_side(rng, glove).packed()
    atlas[:palm_rows, palm_columns : 2 * palm_columns] = _back_side(rng, glove).packed()
    height, width = int(LAYOUT.limb_height), int(LAYOUT.limb_width)
    for segment in range(1, LIMB_ROWS * LIMB_COLUMNS + 1):
        row, column = divmod(segment - 1, LIMB_COLUMNS)
        top, left = palm_rows + row * height, column * width
        atlas[top : top + height, left : left + width] = _limb(rng, segment, glove).packed()
    return atlas


def _mottled(rng: np.random.Generator, rows: int, columns: int, glove: bool) -> _Tile:
    fine, coarse = noise(rng, rows, columns, 3.0), noise(rng, rows, columns, 20.0)
    shade = 1.0 + 0.025 * fine + 0.045 * coarse
    blood = np.zeros((rows, columns), np.float32) if glove else 0.22 * noise(rng, rows, columns, 14.0)
    zero = np.zeros((rows, columns), np.float32)
    return _Tile(shade.astype(np.float32), zero.copy(), blood.astype(np.float32), zero.copy())


def _limb(rng: np.random.Generator, segment: int, glove: bool) -> _Tile:
    """A phalanx (segments 1..14) or the forearm (15), unrolled: the dorsal middle in the centre column."""
    rows, columns = int(LAYOUT.limb_height), int(LAYOUT.limb_width)
    tile = _mottled(rng, rows, columns, glove)
    angle = np.linspace(-np.pi, np.pi, columns, dtype=np.float32)[None, :]
    along = np.linspace(-LAYOUT.margin, 1.0 + LAYOUT.margin, rows, dtype=np.float32)[:, None]
    palmar = smoothstep(0.4, -0.4, np.cos(angle))
    tile.palm[:] = 1.0
    if segment == 15:
        tile.palm *= 0.45
        return tile
    distal = segment == 2 or (segment > 2 and segment % 3 == 2)
    dorsal = 1.0 - palmar
    for joint in (0.0,) if distal else (0.0, 1.0):
        wander = joint + 0.012 * noise(rng, 1, columns, 12.0)
        crease = np.exp(-(((along - wander) / 0.028) ** 2))
        tile.shade -= (0.30 if not glove else 0.12) * crease * palmar
        near = np.exp(-(((along - joint) / 0.16) ** 2))
        ripple = np.cos((along - wander) * 90.0) * near
        tile.shade -= 0.10 * np.clip(ripple, 0.0, 1.0) * dorsal
        tile.blood += 0.5 * near * dorsal
    if glove:
        seam = np.exp(-(((np.abs(angle) - 1.5) / 0.12) ** 2))
        tile.shade -= 0.18 * seam
        return tile
    if distal:
        tile.blood += 0.7 * smoothstep(0.4, 1.0, along) * palmar
        _paint_nail(tile, angle, along)
    return tile


def _paint_nail(tile: _Tile, angle: Float32, along: Float32) -> None:
    """A rounded nail plate with a darker fold around it and a light free edge."""
    across, down = angle / 0.92, (along - 0.74) / 0.32
    radius = (np.abs(across) ** 3 + np.abs(down) ** 3) ** np.float32(1 / 3)
    tile.nail[:] = smoothstep(1.05, 0.9, radius)
    fold = np.exp(-(((radius - 1.08) / 0.1) ** 2)) * (along < 1.0)
    tile.shade -= 0.16 * fold
    tile.shade += 0.12 * tile.nail * smoothstep(0.98, 1.03, along)


# Main creases of the palm in its plane, units of the wrist-to-middle-MCP distance, x to the thumb's side.
PALM_LINES = (
    ((0.29, 0.72), (0.14, 0.68), (0.03, 0.55), (-0.02, 0.38), (0.03, 0.2), (0.1, 0.06)),  # life
    ((0.29, 0.73), (0.12, 0.69), (-0.06, 0.61), (-0.2, 0.5), (-0.28, 0.4)),  # head
    ((-0.42, 0.66), (-0.28, 0.66), (-0.12, 0.7), (0.02, 0.78), (0.1, 0.9)),  # heart
    ((-0.27, 0.0), (-0.1, -0.03), (0.1, -0.03), (0.26, 0.01)),  # wrist
)


def _palm_pixels(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Tile pixels of points (n, 2) in the palm's plane."""
    x = (0.5 + points[:, 0] * 0.5 / LAYOUT.palm_half_breadth) * LAYOUT.palm_width
    y = (LAYOUT.palm_top - points[:, 1]) / (LAYOUT.palm_top - LAYOUT.palm_bottom) * LAYOUT.palm_height
    return np.column_stack([x, y])


def _strokes(lines: list[NDArray[np.float64]], thickness: int, blur: float) -> Float32:
    """Soft strokes along the lines (each (n, 2) in the palm's plane), 0..1."""
    layer = np.zeros((int(LAYOUT.palm_height), int(LAYOUT.palm_width)), np.float32)
    for line in lines:
        pixels = (_palm_pixels(line) * 16.0).astype(np.int32)[:, None]
        cv2.polylines(layer, [pixels], False, 1.0, thickness, cv2.LINE_AA, 4)
    return np.asarray(cv2.GaussianBlur(layer, (0, 0), blur), np.float32)


def _curved(rng: np.random.Generator, points: NDArray[np.float64], wander: float) -> NDArray[np.float64]:
    """A polyline made smooth (cubic interpolation by resizing) and individual."""
    bent = (points + rng.normal(0.0, wander, points.shape)).astype(np.float32)
    dense = cv2.resize(bent.reshape(-1, 1, 2), (1, 8 * len(bent)), interpolation=cv2.INTER_CUBIC)
    return np.asarray(dense.reshape(-1, 2), np.float64)


def _palm_side(rng: np.random.Generator, glove: bool) -> _Tile:
    rows, columns = int(LAYOUT.palm_height), int(LAYOUT.palm_width)
    tile = _mottled(rng, rows, columns, glove)
    tile.palm[:] = 1.0
    if glove:
        return tile
    main = [_curved(rng, np.array(line), 0.012) for line in PALM_LINES]
    minor = [_curved(rng, rng.uniform([-0.3, 0.15], [0.3, 0.75]) + _walk(rng, 4), 0.01) for _ in range(12)]
    tile.shade -= rng.uniform(0.15, 0.45) * _strokes(main, 2, 1.0) + 0.12 * _strokes(minor, 1, 0.7)
    x = np.linspace(-LAYOUT.palm_half_breadth, LAYOUT.palm_half_breadth, columns, dtype=np.float32)[None, :]
    y = np.linspace(LAYOUT.palm_top, LAYOUT.palm_bottom, rows, dtype=np.float32)[:, None]
    for cx, cy, size in (
        (0.2, 0.3, 0.2),
        (-0.28, 0.4, 0.18),
        (0.2, 0.88, 0.12),
        (-0.05, 0.9, 0.12),
        (-0.3, 0.8, 0.1),
    ):
        tile.blood += 0.5 * np.exp(-(((x - cx) ** 2 + (y - cy) ** 2) / size**2))
    tile.palm *= smoothstep(-0.05, 0.3, np.broadcast_to(y, (rows, columns))) * 0.55 + 0.45
    return tile


def _walk(rng: np.random.Generator, steps: int) -> NDArray[np.float64]:
    """A short random path, (steps, 2)."""
    heading = rng.uniform(0.0, np.pi) + np.cumsum(rng.normal(0.0, 0.25, steps))
    return np.cumsum(np.column_stack([np.cos(heading), np.sin(heading)]) * 0.06, axis=0)


def _back_side(rng: np.random.Generator, glove: bool) -> _Tile:
    rows, columns = int(LAYOUT.palm_height), int(LAYOUT.palm_width)
    tile = _mottled(rng, rows, columns, glove)
    tile.palm[:] = 1.0
    if glove:
        return tile
    heads = [(0.25, 0.95), (0.02, 0.98), (-0.19, 0.9), (-0.37, 0.8)]
    tendons = [np.array([[0.05 + 0.3 * x, 0.1], [0.9 * x, y - 0.12]]) for x, y in heads]
    tile.shade += 0.05 * _strokes(tendons, 4, 3.0)
    veins = [_curved(rng, np.array([[rng.uniform(-0.3, 0.25), 0.1], [0.0, 0.3], [0.0, 0.5], [0.0, 0.75]]), 0.1)
             for _ in range(3)]  # fmt: skip
    vein = _strokes(veins, 3, 2.0) * np.float32(rng.uniform(0.0, 1.0))
    tile.shade -= 0.08 * vein
    tile.blood -= 0.5 * vein
    x = np.linspace(-LAYOUT.palm_half_breadth, LAYOUT.palm_half_breadth, columns, dtype=np.float32)[None, :]
    y = np.linspace(LAYOUT.palm_top, LAYOUT.palm_bottom, rows, dtype=np.float32)[:, None]
    for cx, cy in heads:
        knuckle = np.exp(-(((x - cx) ** 2 + (y - cy) ** 2) / 0.09**2))
        tile.blood += 0.6 * knuckle
        tile.shade -= 0.06 * knuckle
    return tile
