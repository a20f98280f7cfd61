"""Rasteriser of round cones: exact visible surface of each, smooth union between them, kept as height and normal.

A round cone is the hull of two spheres; flesh built of them is the sphere-mesh model of Tkach, Pauly &
Tagliasacchi, "Sphere-meshes for real-time hand modeling and tracking", ACM TOG 35(6), 2016. Here each cone is
intersected with parallel rays along the optical axis (perspective is applied to the sphere centres and radii
before, which is exact to first order for parts much smaller than their distance), and heights are united by the
polynomial smooth maximum, so that connected parts melt into each other as skin does.

Pixel coordinates: x right, y down, height towards the camera, all in pixels.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float32 = NDArray[np.float32]

EMPTY_HEIGHT = -1.0e4
"""Height where nothing stands, far below any body part (pixels)."""


@dataclass(frozen=True, slots=True)
class Patch:
    """How the surface of a cone finds its place in the texture atlas.

    frame: (3, 3) columns x (lateral), y (along), z (palmar), in image axes. origin: (3,) start of the bone, pixels.
    length: of the bone, pixels. tile: (x, y) corner in the atlas of the tile, or of the palmar one of two.
    planar: project along z instead of unrolling around y.
    """

    frame: Float32
    origin: Float32
    length: float
    tile: tuple[float, float]
    planar: bool = False


@dataclass(frozen=True, slots=True)
class Cone:
    """Two spheres `start` and `end` (x, y, height, radius) in pixels, with their smooth-union width `blend` (pixels),
    `material` number and texture patch.
    """

    start: tuple[float, float, float, float]
    end: tuple[float, float, float, float]
    blend: float
    material: int
    patch: Patch | None = None


@dataclass(frozen=True, slots=True)
class AtlasLayout:
    """Sizes of the tiles of the texture atlas, atlas pixels.

    A limb's tile unrolls the circumference over `limb_width` (dorsal middle in the centre) and the bone's length
    with a quarter more at each end over `limb_height`. The palm's two tiles lie side by side.
    """

    limb_width: float = 64.0
    limb_height: float = 96.0
    palm_width: float = 160.0
    palm_height: float = 208.0
    margin: float = 0.25
    palm_half_breadth: float = 0.62
    palm_top: float = 1.2
    palm_bottom: float = -0.35


LAYOUT = AtlasLayout()


class Canvas:
    """Buffers of one picture, all (h, w): `height`, unit `normal`, `atlas` coordinates, `palmar` (the part of the
    normal that points out of the palm, -1..1), float32, and `material`, uint8. `corner`: picture pixel (x, y) of the
    upper left corner.
    """

    def __init__(self, width: int, height: int, corner: tuple[int, int] = (0, 0)) -> None:
        self.width, self.rows, self.corner = width, height, corner
        self.height = np.full((height, width), EMPTY_HEIGHT, np.float32)
        self.normal = np.zeros((3, height, width), np.float32)
        self.atlas = np.zeros((2, height, width), np.float32)
        self.palmar = np.zeros((height, width), np.float32)
        self.material = np.zeros((height, width), np.uint8)
        self._x = np.arange(width, dtype=np.float32) + np.float32(corner[0] + 0.5)
        self._y = (np.arange(height, dtype=np.float32) + np.float32(corner[1] + 0.5))[:, None]

    def draw(self, cone: Cone) -> None:
        """Unite the visible surface of one cone with what is already there."""
        (ax, ay, _, ar), (bx, by, _, br) = cone.start, cone.end
        left, top = self.corner
        x0, x1 = (
            max(int(min(ax - ar, bx - br) - left), 0),
            min(int(max(ax + ar, bx + br) - left) + 2, self.width),
        )
        y0, y1 = (
            max(int(min(ay - ar, by - br) - top), 0),
            min(int(max(ay + ar, by + br) - top) + 2, self.rows),
        )
        if x0 >= x1 or y0 >= y1:
            return
        height, normal = _surface(cone, self._x[x0:x1], self._y[y0:y1])
        window = np.s_[y0:y1, x0:x1]
        before = self.height[window]
        rise = height - before
        share = np.clip(rise * np.float32(0.5 / cone.blend) + np.float32(0.5), 0.0, 1.0)
        before += share * (rise + np.float32(cone.blend) * (np.float32(1.0) - share))
        kept = self.normal[:, y0:y1, x0:x1]
        kept += share * (normal - kept)
        wins = share > np.float32(0.5)
        np.copyto(self.material[window], np.uint8(cone.material), where=wins)
        if cone.patch is not None:
            position = (self._x[x0:x1], self._y[y0:y1], height)
            facing = self.palmar[window]
            palmar = _along(normal, cone.patch.frame[:, 2])
            facing += share * (palmar - facing)
            for axis, value in enumerate(_atlas_coordinates(cone.patch, position, normal, palmar)):
                np.copyto(self.atlas[axis][window], value, where=wins)


def _surface(cone: Cone, x: Float32, y: Float32) -> tuple[Float32, Float32]:
    """Height (EMPTY_HEIGHT off the cone) and normal (3, h, w) of a cone over the pixels x (w,) and y (h, 1)."""
    ax, ay, az, ar = cone.start
    bx, by, bz, br = (end - start for end, start in zip(cone.end, cone.start, strict=True))
    x, y = x - np.float32(ax), y - np.float32(ay)
    spread = bx * bx + by * by - br * br
    if spread > 1e-3 * (bz * bz + 1e-6):
        along = _axis_position(x, y, (bx, by, bz, br), ar, spread)
    else:  # seen end-on one end hides the other
        along = np.full((y.shape[0], x.shape[0]), 1.0 if bz + br > 0.0 else 0.0, np.float32)
    dx, dy = x - np.float32(bx) * along, y - np.float32(by) * along
    radius = np.float32(ar) + np.float32(br) * along
    depth = radius * radius - dx * dx - dy * dy
    inside = depth > 0.0
    dz = np.sqrt(np.maximum(depth, 0.0))
    height = np.where(inside, np.float32(az) + np.float32(bz) * along + dz, np.float32(EMPTY_HEIGHT))
    return height, np.asarray(np.stack([dx, dy, dz]) / radius, np.float32)


def _axis_position(
    x: Float32, y: Float32, axis: tuple[float, float, float, float], ar: float, spread: float
) -> Float32:
    """Which sphere of the family (0..1 along the axis) carries the visible point of each pixel.

    The spheres |p - a - uB| = r + u d envelop the cone where dF/du = 0; eliminating u leaves a quadratic equation
    in the height, whose larger root is the visible one.
    """
    bx, by, bz, br = axis
    scale = 1.0 / (spread + bz * bz)
    lead = spread * scale
    m = np.float32(bx) * x + (np.float32(by) * y + np.float32(br * ar))
    rest = x * x + (y * y - np.float32(ar * ar)) - np.float32(scale) * m * m
    half = np.float32(scale * bz) * m
    root = np.sqrt(np.maximum(half * half - np.float32(lead) * rest, 0.0))
    height = (half + root) * np.float32(1.0 / lead)
    return np.asarray(np.clip(np.float32(scale) * (m + np.float32(bz) * height), 0.0, 1.0), np.float32)


def _along(normal: Float32, axis: Float32) -> Float32:
    """Part of the normals (3, h, w) along a unit axis (3,)."""
    return np.asarray(normal[0] * axis[0] + normal[1] * axis[1] + normal[2] * axis[2], np.float32)


def _atlas_coordinates(
    patch: Patch, position: tuple[Float32, Float32, Float32], normal: Float32, palmar: Float32
) -> tuple[Float32, Float32]:
    """Atlas x and y of the surface points `position` with unit `normal`."""
    frame = patch.frame
    x, y, height = (p - o for p, o in zip(position, patch.origin, strict=True))
    along = (x * frame[0, 1] + y * frame[1, 1] + height * frame[2, 1]) * np.float32(1.0 / patch.length)
    if patch.planar:
        across = (x * frame[0, 0] + y * frame[1, 0] + height * frame[2, 0]) * np.float32(1.0 / patch.length)
        return palm_tile_coordinates(patch.tile, across, along, palmar < 0.0)
    lateral = _along(normal, frame[:, 0])
    angle = np.arctan2(lateral, -palmar)
    half = np.float32(0.5 * LAYOUT.limb_width - 1.0)
    column = np.float32(patch.tile[0] + 0.5 * LAYOUT.limb_width) + angle * (half / np.float32(np.pi))
    return column, limb_row(patch.tile[1], along)


def limb_row(tile_y: float, along: Float32) -> Float32:
    """Atlas row of the position `along` a bone (0 start, 1 end)."""
    span = 1.0 + 2.0 * LAYOUT.margin
    part = np.clip((along + np.float32(LAYOUT.margin)) * np.float32(1.0 / span), 0.0, 1.0)
    return np.asarray(np.float32(tile_y + 1.0) + part * np.float32(LAYOUT.limb_height - 2.0), np.float32)


def palm_tile_coordinates(
    tile: tuple[float, float], across: Float32, along: Float32, dorsal: NDArray[np.bool_]
) -> tuple[Float32, Float32]:
    """Atlas x and y of points of the palm's plane, in units of the distance from the wrist to the middle MCP."""
    column = np.clip(0.5 + across * np.float32(0.5 / LAYOUT.palm_half_breadth), 0.0, 1.0)
    row = np.clip((LAYOUT.palm_top - along) / np.float32(LAYOUT.palm_top - LAYOUT.palm_bottom), 0.0, 1.0)
    x = np.float32(tile[0] + 1.0) + column * np.float32(LAYOUT.palm_width - 2.0)
    x = x + dorsal * np.float32(LAYOUT.palm_width)
    return (
        np.asarray(x, np.float32),
        np.asarray(np.float32(tile[1] + 1.0) + row * np.float32(LAYOUT.palm_height - 2.0), np.float32),
    )
