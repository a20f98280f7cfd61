"""The diver's body as round cones: torso, head with mask, snorkel or regulator, arms and legs.

Body frame in millimetres: origin between the shoulders, x to the diver's left (image right of a diver who faces the
camera), y up, z towards the camera. Segment lengths are adult means after Winter, "Biomechanics and motor control
of human movement", 4th ed. 2009, fig. 4.1, for a stature of 1.75 m.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np

from lightgesture.synth.raster import Canvas, Cone, Float32
from lightgesture.synth.shading import Light, occlusion, reflected
from lightgesture.synth.skeleton import FloatArray
from lightgesture.synth.water import Water

SUIT, ACCENT, SKIN, HOOD, MASK, GLASS, RUBBER = range(1, 8)
MOUTH = (0.0, 160.0, 125.0)
"""Where the regulator lets bubbles out."""
UPPER_ARM_MM, FOREARM_MM = 300.0, 265.0
SHOULDER = np.array([178.0, -15.0, 0.0])
BODY_BLEND_MM, SMALL_BLEND_MM = 28.0, 4.0
GLASS_BGR, RUBBER_BGR = (0.22, 0.2, 0.16), (0.02, 0.02, 0.02)
REDUCTION = 2
"""How many times smaller than the picture a body is rendered."""
OCCLUSION_SCALE = 4.0
"""Bodies are larger than hands: radius of the occlusion blur against that of `shading`."""
GLOSS = {SUIT: 0.03, ACCENT: 0.03, SKIN: 0.06, HOOD: 0.03, MASK: 0.15, GLASS: 0.35, RUBBER: 0.08}


@dataclass(frozen=True, slots=True)
class BodyLook:
    """Colours (linear BGR) and equipment of a diver.

    hood: neoprene over the hair (else `hood_bgr` is hair). mask, snorkel, regulator: worn or not. bare_arms: skin
    instead of suit below the elbow. cuff_mm: from the wrist to where the body's own arm begins. legs: drawn or
    hidden (standing behind a desk, cut by the picture).
    """

    suit_bgr: tuple[float, float, float] = (0.02, 0.017, 0.014)
    accent_bgr: tuple[float, float, float] = (0.25, 0.06, 0.02)
    skin_bgr: tuple[float, float, float] = (0.25, 0.36, 0.6)
    hood_bgr: tuple[float, float, float] = (0.015, 0.015, 0.015)
    mask_bgr: tuple[float, float, float] = (0.45, 0.12, 0.02)
    hood: bool = True
    mask: bool = True
    snorkel: bool = False
    regulator: bool = True
    bare_arms: bool = False
    cuff_mm: float = 35.0
    legs: bool = True

    def palette(self) -> Float32:
        """Albedo of every material, (8, 3)."""
        rows = [
            (0.0, 0.0, 0.0), self.suit_bgr, self.accent_bgr, self.skin_bgr, self.hood_bgr, self.mask_bgr,
            GLASS_BGR, RUBBER_BGR,
        ]  # fmt: skip
        return np.array(rows, np.float32)


@dataclass(frozen=True, slots=True)
class Camera:
    """Pinhole camera: focal length and principal point in pixels."""

    focal: float
    centre: tuple[float, float]

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Image points (n, 2) and scale (n,), pixels per mm, of camera points (n, 3): x right, y up, z depth."""
        scale = self.focal / np.maximum(points[:, 2], 1.0)
        return np.column_stack(
            [self.centre[0] + scale * points[:, 0], self.centre[1] - scale * points[:, 1]]
        ), scale


@dataclass(slots=True)
class _Parts:
    points: list[tuple[float, float, float]] = field(default_factory=list)
    radii: list[float] = field(default_factory=list)
    kinds: list[tuple[int, float]] = field(default_factory=list)

    def add(
        self, material: int, a: FloatArray | tuple[float, ...], ra: float, b: FloatArray | tuple[float, ...],
        rb: float, blend: float = SMALL_BLEND_MM,
    ) -> None:  # fmt: skip
        for point in (a, b):
            self.points.append((float(point[0]), float(point[1]), float(point[2])))
        self.radii += [ra, rb]
        self.kinds.append((material, blend))


def elbow_position(shoulder: FloatArray, wrist: FloatArray, outward: float) -> FloatArray:
    """Elbow of a two-bone arm that reaches from shoulder to wrist, bent downwards and `outward` (+1 or -1 in x).

    A wrist out of reach is met by a straight arm: the elbow then lies on the line.
    """
    upper, fore = UPPER_ARM_MM, FOREARM_MM
    line = wrist - shoulder
    distance = float(np.linalg.norm(line))
    reach = min(max(distance, abs(upper - fore) + 1.0), upper + fore - 1.0)
    along = (upper**2 - fore**2 + reach**2) / (2.0 * reach)
    bend = np.sqrt(max(upper**2 - along**2, 0.0))
    direction = line / max(distance, 1e-6)
    pole = np.array([0.45 * outward, -1.0, -0.25])
    pole = pole - (pole @ direction) * direction
    return np.asarray(shoulder + along * direction + bend * pole / max(float(np.linalg.norm(pole)), 1e-6))


def _add_torso(parts: _Parts, look: BodyLook) -> None:
    for side in (-1.0, 1.0):
        parts.add(SUIT, (side * 75, -60, 0), 105, (side * 62, -430, 0), 92, BODY_BLEND_MM)
        parts.add(SUIT, (side * 172, -20, -5), 60, (side * 55, 25, -5), 55, BODY_BLEND_MM)
    parts.add(SUIT, (0, -40, 5), 112, (0, -420, 5), 95, BODY_BLEND_MM)
    parts.add(ACCENT, (0, 30, 20), 62, (0, 42, 20), 60, SMALL_BLEND_MM)
    if look.legs:
        for side in (-1.0, 1.0):
            parts.add(SUIT, (side * 85, -500, 0), 92, (side * 105, -880, -90), 62, BODY_BLEND_MM)
            parts.add(SUIT, (side * 105, -880, -90), 62, (side * 120, -1180, -330), 42, BODY_BLEND_MM)
            parts.add(RUBBER, (side * 120, -1180, -330), 48, (side * 135, -1420, -420), 70)


def _add_head(parts: _Parts, look: BodyLook) -> None:
    parts.add(SUIT if look.hood else SKIN, (0, 20, -10), 58, (0, 130, 5), 56)
    parts.add(SKIN, (0, 160, 30), 62, (0, 240, 22), 80, BODY_BLEND_MM)
    parts.add(HOOD, (0, 255, -4), 90, (0, 190, -22), 84)
    if look.hood:
        parts.add(HOOD, (-30, 130, 6), 62, (30, 130, 6), 62)
    else:
        for side in (-1.0, 1.0):
            parts.add(SKIN, (side * 82, 205, 0), 14, (side * 84, 228, -4), 15)
    parts.add(SKIN, (0, 200, 100), 13, (0, 228, 92), 9)
    if look.mask:
        parts.add(MASK, (-40, 226, 64), 38, (40, 226, 64), 38)
        parts.add(RUBBER, (-38, 227, 74), 32, (38, 227, 74), 32)
        parts.add(GLASS, (-37, 228, 82), 27, (37, 228, 82), 27)
        parts.add(MASK, (0, 196, 104), 17, (0, 222, 96), 13)
        parts.add(RUBBER, (-84, 228, 20), 12, (-60, 228, 60), 12)
        parts.add(RUBBER, (84, 228, 20), 12, (60, 228, 60), 12)
    else:
        for side in (-1.0, 1.0):
            parts.add(HOOD, (side * 24, 250, 84), 5, (side * 44, 250, 76), 5)
            parts.add(RUBBER, (side * 30, 232, 88), 8, (side * 36, 232, 86), 8)
        parts.add(ACCENT if look.regulator else HOOD, (-18, 160, 86), 5, (18, 160, 86), 5)
    if look.regulator:
        parts.add(RUBBER, (0, 162, 110), 34, (0, 160, 122), 30)
        parts.add(RUBBER, (-30, 160, 105), 12, (-150, 90, 20), 13)
    if look.snorkel:
        parts.add(ACCENT, (70, 150, 80), 11, (112, 220, 20), 11)
        parts.add(ACCENT, (112, 220, 20), 11, (96, 400, -40), 11)


def _add_arm(
    parts: _Parts, look: BodyLook, shoulder: FloatArray, elbow: FloatArray, wrist: FloatArray
) -> None:
    lower = SKIN if look.bare_arms else SUIT
    parts.add(SUIT, shoulder, 58, elbow, 45, BODY_BLEND_MM)
    if look.bare_arms:
        cuff = shoulder + 0.9 * (elbow - shoulder)
        parts.add(SUIT, cuff, 51, elbow + 0.06 * (wrist - elbow), 53)
    near = elbow + (1.0 - (look.cuff_mm + 31.0) / FOREARM_MM) * (wrist - elbow)
    parts.add(lower, elbow, 45, near, 31, 8.0)


def render_body(
    look: BodyLook, rotation: FloatArray, position: FloatArray, wrists: tuple[FloatArray, FloatArray],
    camera: Camera, size: tuple[int, int], light: Light, water: Water | None = None,
) -> tuple[Float32, Float32]:  # fmt: skip
    """Radiance (h, w, 3), premultiplied, and coverage (h, w) of the body in a picture of `size` (width, height).

    rotation (3, 3) and position (3,) place the body frame before the camera (x right, y up, z depth towards the
    scene); wrists: left and right, in the body frame. water: what lies between, None in air. Rendered `REDUCTION`
    times smaller, because suits are smooth.
    """
    parts = _Parts()
    _add_torso(parts, look)
    _add_head(parts, look)
    for side, wrist in zip((1.0, -1.0), wrists, strict=True):
        shoulder = SHOULDER * np.array([side, 1.0, 1.0])
        _add_arm(parts, look, shoulder, elbow_position(shoulder, wrist, side), wrist)
    world = to_camera(np.array(parts.points), rotation, position)
    image, scale = camera.project(world)
    image, scale = image / REDUCTION, scale / REDUCTION
    nearness = -(world[:, 2] - position[2]) * camera.focal / position[2] / REDUCTION
    radii = np.array(parts.radii) * scale
    canvas = Canvas(size[0] // REDUCTION, size[1] // REDUCTION)
    spheres = np.column_stack([image, nearness, radii]).tolist()
    for index, (material, blend) in enumerate(parts.kinds):
        a, b = sorted(spheres[2 * index : 2 * index + 2], key=lambda sphere: -sphere[3])
        canvas.draw(Cone(tuple(a), tuple(b), blend * float(scale[2 * index]), material))
    radiance, cover = _shaded(canvas, look, light, camera.focal / position[2] / REDUCTION, position[2], water)
    return (
        np.asarray(cv2.resize(radiance, size, interpolation=cv2.INTER_LINEAR), np.float32),
        np.asarray(cv2.resize(cover, size, interpolation=cv2.INTER_LINEAR), np.float32),
    )


def to_camera(points: FloatArray, rotation: FloatArray, position: FloatArray) -> FloatArray:
    """Body points (n, 3) to camera points: the body's z looks at the camera, the camera's z into the scene."""
    turned = points @ rotation.T
    return np.asarray(turned * np.array([1.0, 1.0, -1.0]) + position)


def _shaded(
    canvas: Canvas, look: BodyLook, light: Light, px_per_mm: float, distance_mm: float, water: Water | None
) -> tuple[Float32, Float32]:
    mask = canvas.material > 0
    pixels = np.flatnonzero(mask)
    kind = canvas.material.reshape(-1)[pixels]
    gloss = np.array([GLOSS.get(material, 0.0) for material in range(RUBBER + 1)], np.float32)[kind]
    closed = occlusion(canvas.height, mask, OCCLUSION_SCALE * px_per_mm).reshape(-1)[pixels] * np.float32(0.6)
    normal = canvas.normal.reshape(3, -1)[:, pixels]
    lit = reflected(normal, look.palette()[kind], gloss, closed, np.ones_like(closed), light)
    if water is not None:
        away = (distance_mm - canvas.height.reshape(-1)[pixels] / px_per_mm) / 1000.0
        lit = water.see_points(lit, np.asarray(away, np.float32))
    radiance = np.zeros((*canvas.height.shape, 3), np.float32)
    radiance.reshape(-1, 3)[pixels] = lit
    # A small blur hides the steps of the coarser grid at the outline.
    smooth = (cv2.blur(layer, (3, 3)) for layer in (radiance, mask.astype(np.float32)))
    radiance, cover = (np.asarray(layer, np.float32) for layer in smooth)
    return radiance, cover
