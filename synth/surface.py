"""The flesh of the hand: round cones laid along a posed skeleton, projected to the picture.

Radii are half of the breadths of fingers and palms in photographs of open hands with landmarks, against the distance
from the wrist to the middle MCP joint; the palm's cones follow the metacarpals, the thenar and hypothenar
eminences and the webs between the fingers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from lightgesture.synth.raster import LAYOUT, Cone, Float32, Patch, limb_row
from lightgesture.synth.skeleton import FloatArray, HandPose, Proportions, Skeleton, pose_skeleton

HAND, FOREARM, SLEEVE = 1, 2, 3
"""Materials of a canvas; 0 is nothing."""

# Radii in millimetres at MCP, PIP, DIP and tip (thumb: metacarpal base, MCP, IP, tip).
RADII = np.array(
    [[14.5, 12.2, 11.2, 9.2], [11.8, 10.9, 9.3, 7.9], [12.0, 10.7, 9.4, 8.1], [11.4, 10.2, 9.1, 7.7],
     [10.5, 9.2, 8.1, 6.9]]
)  # fmt: skip
PALM_BLEND_MM, BASE_BLEND_MM, FINGER_BLEND_MM = 9.0, 5.0, 1.3
# Carpal and distal ends of the slab of the palm: the four metacarpals and, between them, the flesh that fills it.
CARPALS = np.array(
    [[15.0, 12.0, 0.0], [10.0, 10.0, 0.5], [5.0, 8.0, 0.0], [0.0, 8.0, 0.5],
     [-5.0, 8.0, 0.0], [-10.0, 10.0, 0.5], [-15.0, 12.0, 0.0]]
)  # fmt: skip
CARPAL_RADII = (14.5, 14.5, 15.0, 15.0, 15.0, 14.5, 14.5)
HEAD_RADII = (12.5, 11.8, 12.5, 11.6, 12.0, 11.0, 11.2)
MEAN_PALM = np.array([91.0, 93.0])  # breadth and length that the constants above belong to


@dataclass(frozen=True, slots=True)
class Forearm:
    """What is seen below the wrist: `length_mm` of forearm, in a sleeve from `sleeve_mm` on (None: bare)."""

    length_mm: float = 150.0
    sleeve_mm: float | None = None


@dataclass(frozen=True, slots=True)
class HandView:
    """Where and how a hand stands before the camera.

    rotation: (3, 3) from the hand's frame to the camera's (x right, y up, z towards the camera). wrist: pixel
    position of the wrist. px_per_mm: scale at the wrist. distance_mm: from the camera to the wrist (perspective).
    left: a left hand.
    """

    rotation: FloatArray
    wrist: tuple[float, float]
    px_per_mm: float
    distance_mm: float = 1200.0
    left: bool = False

    def project(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Image points (n, 3): x, y, height in pixels, and the local scale (n,) in pixels per millimetre."""
        turned = (points * self._mirror()) @ self.rotation.T
        scale = self.px_per_mm * self.distance_mm / (self.distance_mm - turned[:, 2])
        image = turned * scale[:, None] * np.array([1.0, -1.0, 1.0])
        return image + np.array([self.wrist[0], self.wrist[1], 0.0]), scale

    def image_frame(self, frame: FloatArray) -> Float32:
        """A bone's frame in image axes."""
        turned = self.rotation @ (frame * self._mirror()[:, None])
        return np.asarray(turned * np.array([[1.0], [-1.0], [1.0]]), np.float32)

    def _mirror(self) -> FloatArray:
        return np.array([-1.0 if self.left else 1.0, 1.0, 1.0])


@dataclass(slots=True)
class _Flesh:
    """Cones in the hand's frame, gathered before they are projected together."""

    points: list[FloatArray] = field(default_factory=list)
    radii: list[float] = field(default_factory=list)
    blends: list[float] = field(default_factory=list)
    kinds: list[tuple[int, int]] = field(default_factory=list)  # material, segment

    def add(
        self, a: FloatArray, ra: float, b: FloatArray, rb: float, blend: float, kind: tuple[int, int]
    ) -> None:
        self.points += [a, b]
        self.radii += [ra, rb]
        self.blends.append(blend)
        self.kinds.append(kind)


FOREARM_TILE_MM = 500.0
"""Length that stands for a bone's in the forearm's tile, so that 125 mm of it lie within the tile's margin."""
PALM_SEGMENT, FOREARM_SEGMENT = 0, 15
"""Segments 1..14 are the thumb's two phalanges and three of each finger, in order."""


def segment_tile(segment: int) -> tuple[float, float]:
    """Corner of a segment's tile in the atlas: the palm on top, limbs in rows of five below."""
    if segment == PALM_SEGMENT:
        return (0.0, 0.0)
    row, column = divmod(segment - 1, 5)
    return (column * LAYOUT.limb_width, LAYOUT.palm_height + row * LAYOUT.limb_height)


def hand_cones(
    pose: HandPose, proportions: Proportions, view: HandView, forearm: Forearm
) -> tuple[list[Cone], FloatArray]:
    """The cones of a posed hand in the picture, in drawing order, and its projected landmarks (21, 3)."""
    skeleton = pose_skeleton(pose, proportions)
    flesh = _Flesh()
    _add_forearm(flesh, skeleton, proportions, forearm)
    _add_palm(flesh, skeleton, proportions)
    _add_webs(flesh, skeleton, proportions)
    for finger in range(5):
        _add_finger(flesh, skeleton, proportions, finger)
    landmarks, _ = view.project(skeleton.points)
    return list(_project(flesh, skeleton, view)), landmarks


def _add_forearm(flesh: _Flesh, skeleton: Skeleton, proportions: Proportions, forearm: Forearm) -> None:
    thick = proportions.thickness
    for side in (-1.0, 0.0, 1.0):
        near = skeleton.forearm @ np.array([side * 12.0 * thick, 2.0, -0.5])
        far = skeleton.forearm @ np.array([side * 16.0 * thick, -forearm.length_mm, -1.0])
        swell = 16.5 + 0.045 * forearm.length_mm
        flesh.add(near, 16.5 * thick, far, swell * thick, PALM_BLEND_MM, (FOREARM, FOREARM_SEGMENT))


def sleeve_row(sleeve_mm: float) -> float:
    """Atlas row above which the forearm is covered by a sleeve that begins `sleeve_mm` from the wrist."""
    along = np.array(-sleeve_mm / FOREARM_TILE_MM, np.float32)
    return float(limb_row(segment_tile(FOREARM_SEGMENT)[1], along))


def _add_palm(flesh: _Flesh, skeleton: Skeleton, proportions: Proportions) -> None:
    thick, points = proportions.thickness, skeleton.points
    breadth, length = proportions.mcp[0, 0] - proportions.mcp[3, 0] + 30.0 * thick, proportions.mcp[1, 1]
    size = np.array([breadth / MEAN_PALM[0], length / MEAN_PALM[1], thick])

    def cone(a: FloatArray, ra: float, b: FloatArray, rb: float) -> None:
        flesh.add(a, ra * thick, b, rb * thick, PALM_BLEND_MM, (HAND, PALM_SEGMENT))

    knuckles = points[[5, 9, 13, 17]] - np.array([0.0, 3.0, 0.0])
    between = 0.5 * (knuckles[:-1] + knuckles[1:]) - np.array([0.0, 2.0, -0.5])
    heads = np.stack([knuckles[0], between[0], knuckles[1], between[1], knuckles[2], between[2], knuckles[3]])
    for carpal, radius, head, head_radius in zip(CARPALS, CARPAL_RADII, heads, HEAD_RADII, strict=True):
        cone(carpal * size, radius, head, head_radius)
    cone(heads[0] + [-2.0, -8.0, 3.5], 9.5, heads[-1] + [2.0, -5.0, 2.5], 8.5)  # pads below the fingers
    cone(np.array([-19.0, 22.0, 5.5]) * size, 14.5, np.array([-33.0, 60.0, 5.0]) * size, 12.0)  # hypothenar
    base, mcp, metacarpal = points[1], points[2], skeleton.frames[1]
    pad, ulnar = metacarpal[:, 2], np.array([-1.0, 0.0, 0.0])
    cone(base, 15.0, mcp, RADII[0, 1])
    cone(np.array([9.0, 24.0, 8.0]) * size, 14.0, base + 0.78 * (mcp - base) + 3.0 * pad, 9.5)  # thenar
    index = points[5]
    for part, height, radius in ((0.72, 0.68, 8.0), (0.95, 0.8, 6.0)):  # first web
        start = base + part * (mcp - base) + 2.0 * ulnar
        cone(start, radius, index * np.array([0.9, height, 1.0]) + [0.0, 0.0, 2.0], radius)


def _add_webs(flesh: _Flesh, skeleton: Skeleton, proportions: Proportions) -> None:
    for finger in range(1, 4):
        first, second = 1 + 4 * finger, 5 + 4 * finger
        base = 0.5 * (skeleton.points[first] + skeleton.points[second])
        reach = 0.5 * (skeleton.points[first + 1] + skeleton.points[second + 1]) - base
        radius = proportions.thickness * RADII[finger + 1, 0]
        flesh.add(
            base, 0.85 * radius, base + 0.27 * reach, 0.55 * radius, PALM_BLEND_MM, (HAND, PALM_SEGMENT)
        )


def _add_finger(flesh: _Flesh, skeleton: Skeleton, proportions: Proportions, finger: int) -> None:
    first = 1 + 4 * finger
    chain = skeleton.points[first : first + 4].copy()
    radii = RADII[finger] * proportions.thickness
    chain[3] -= radii[3] * skeleton.frames[first + 3][:, 1]  # the tip's landmark lies on its skin
    segment = 1 if finger == 0 else 3 * finger
    bones = range(1, 3) if finger == 0 else range(3)
    for order, bone in enumerate(bones):
        a, b, ra, rb = chain[bone], chain[bone + 1], float(radii[bone]), float(radii[bone + 1])
        kind = (HAND, segment + order)
        if order == 0:  # the root melts into the palm, the rest stays distinct from its neighbours
            flesh.add(a, ra, a + 0.35 * (b - a), ra + 0.35 * (rb - ra), BASE_BLEND_MM, kind)
        flesh.add(a, ra, b, rb, FINGER_BLEND_MM, kind)


def _bone_of(segment: int) -> int:
    """First landmark of the bone of a limb's segment 1..14."""
    if segment <= 2:
        return 1 + segment
    finger, order = divmod(segment, 3)
    return 1 + 4 * finger + order


def _project(flesh: _Flesh, skeleton: Skeleton, view: HandView) -> Iterator[Cone]:
    image, scale = view.project(np.array(flesh.points))
    radii = scale * np.array(flesh.radii)
    spheres = np.column_stack([image, radii]).tolist()
    patches: dict[int, Patch] = {}
    for index, (material, segment) in enumerate(flesh.kinds):
        if segment not in patches:
            patches[segment] = _patch(segment, skeleton, view)
        a, b = spheres[2 * index], spheres[2 * index + 1]
        if a[3] < b[3]:  # the wider end first keeps the end-on case simple
            a, b = b, a
        blend = flesh.blends[index] * float(scale[2 * index])
        yield Cone(tuple(a), tuple(b), blend, material, patches[segment])


def _patch(segment: int, skeleton: Skeleton, view: HandView) -> Patch:
    if segment == PALM_SEGMENT:
        bone, frame, length = 0, np.eye(3), float(skeleton.points[9, 1])
    elif segment == FOREARM_SEGMENT:
        bone, frame, length = 0, skeleton.forearm, FOREARM_TILE_MM
    else:
        bone = _bone_of(segment)
        frame = skeleton.frames[bone]
        length = float(np.linalg.norm(skeleton.points[bone + 1] - skeleton.points[bone]))
    image, scale = view.project(skeleton.points[bone : bone + 1])
    return Patch(
        frame=view.image_frame(frame),
        origin=np.asarray(image[0], np.float32),
        length=length * float(scale[0]),
        tile=segment_tile(segment),
        planar=segment == PALM_SEGMENT,
    )
