"""Kinematic skeleton of the hand: joint angles -> joint positions, as pure functions.

The hand's own frame is right-handed and in millimetres: x points to the thumb's side (radial), y from the wrist
to the fingertips (distal), z out of the palm. Every joint angle is in degrees; flexion (towards the palm) and
abduction towards the thumb's side are positive. A left hand is the mirror image of a right hand in x.

Joints are numbered as in the 21-landmark convention: wrist, then thumb, index, middle, ring and little finger
from base to tip.

Sources: segment lengths by Buryanov & Kotiuk, "Proportions of hand segments", Int. J. Morphol. 28(3), 2010
(means of adults, soft tissue of the tip added to the last phalanx), brought within 4 % to the proportions of
landmarks on photographs of hands, which put the thumb's first landmark 7 mm beyond its joint; ranges of motion by
the American Academy of Orthopaedic Surgeons (AAOS, "Joint motion: method of measuring and recording", 1965) with the
abduction range and the DIP-PIP dependence of Lin, Wu & Huang, "Modeling the constraints of human hand motion", IEEE
HUMO 2000.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

FINGERS = ("thumb", "index", "middle", "ring", "little")
JOINT_COUNT = 21

# Rows: thumb, index, middle, ring, little. Columns of a finger: MCP flexion, MCP abduction, PIP and DIP flexion.
# Columns of the thumb: radial abduction of the metacarpal (angle to y in the plane of the palm), its palmar
# abduction (angle out of that plane), MCP and IP flexion.
ANGLE_LIMITS_MIN = np.array(
    [[-25.0, -5.0, -10.0, -25.0], [-30.0, -20.0, -5.0, -10.0], [-30.0, -15.0, -5.0, -10.0],
     [-30.0, -20.0, -5.0, -10.0], [-30.0, -30.0, -5.0, -10.0]]
)  # fmt: skip
ANGLE_LIMITS_MAX = np.array(
    [[70.0, 65.0, 65.0, 85.0], [95.0, 20.0, 112.0, 85.0], [95.0, 15.0, 112.0, 85.0],
     [95.0, 15.0, 115.0, 85.0], [95.0, 15.0, 115.0, 85.0]]
)  # fmt: skip
WRIST_LIMITS_MIN = np.array([-60.0, -35.0])  # extension, ulnar deviation
WRIST_LIMITS_MAX = np.array([70.0, 22.0])  # flexion, radial deviation

# Metacarpal heads (x, y, z) of index, middle, ring, little, and the thumb's CMC joint: the metacarpals of the
# source above, laid out on the transverse arch with a breadth of 91 mm over the heads.
MCP_POSITIONS = np.array([[25.0, 90.0, 1.0], [2.5, 93.0, -1.0], [-18.5, 86.5, 0.5], [-36.5, 76.0, 4.0]])
THUMB_CMC = np.array([25.0, 22.0, 6.0])
THUMB_LENGTHS = np.array([41.0, 31.6, 25.3])  # metacarpal, proximal, distal + soft tissue
FINGER_LENGTHS = np.array(
    [[39.8, 22.4, 19.7], [43.6, 25.7, 20.9], [40.4, 25.1, 20.8], [31.3, 17.6, 18.7]]
)  # fmt: skip

# The thumb's pad looks to the little finger's side by this twist; opposition (palmar abduction and adduction)
# turns it further, because the saddle joint couples them (Kapandji, "The physiology of the joints", vol. 1).
THUMB_TWIST_DEG = 48.0
TWIST_PER_PALMAR_DEG = 0.55
TWIST_PER_ADDUCTION_DEG = 0.75
TWIST_FREE_RADIAL_DEG = 40.0


@dataclass(frozen=True, slots=True)
class HandPose:
    """Joint angles of one hand: `angles` float (5, 4) and `wrist` float (2,) (flexion, radial deviation), degrees."""

    angles: FloatArray
    wrist: FloatArray

    def clipped(self) -> HandPose:
        """The pose with every joint inside its range of motion."""
        return HandPose(
            np.clip(self.angles, ANGLE_LIMITS_MIN, ANGLE_LIMITS_MAX),
            np.clip(self.wrist, WRIST_LIMITS_MIN, WRIST_LIMITS_MAX),
        )


@dataclass(frozen=True, slots=True)
class Proportions:
    """Bone lengths and thickness of one person's hand, millimetres.

    `mcp` (4, 3) and `cmc` (3,) are joint positions in the hand's frame, `fingers` (4, 3) and `thumb` (3,) segment
    lengths; `thickness` (about 0.85..1.2) scales every radius of the flesh.
    """

    mcp: FloatArray
    cmc: FloatArray
    fingers: FloatArray
    thumb: FloatArray
    thickness: float


@dataclass(frozen=True, slots=True)
class Skeleton:
    """Posed joints: `points` (21, 3) in millimetres; `frames` (21, 3, 3), columns x, y, z of the bone that starts
    at the joint (of the bone that ends there, for a tip). `forearm` (3, 3) is the frame of the forearm.
    """

    points: FloatArray
    frames: FloatArray
    forearm: FloatArray


MEAN_PROPORTIONS = Proportions(MCP_POSITIONS, THUMB_CMC, FINGER_LENGTHS, THUMB_LENGTHS, 1.0)


def sample_proportions(rng: np.random.Generator) -> Proportions:
    """Another adult's hand: overall size, slenderness, finger length and each finger's own length vary.

    Spreads (standard deviations) follow the 5-7 % of the published adult means.
    """
    size = rng.normal(1.0, 0.055)
    breadth = size * rng.normal(1.0, 0.045)
    fingers = size * rng.normal(1.0, 0.04) * rng.normal(1.0, 0.022, (4, 1))
    palm = np.array([breadth, size * rng.normal(1.0, 0.03), size])
    return Proportions(
        mcp=MCP_POSITIONS * palm,
        cmc=THUMB_CMC * palm,
        fingers=FINGER_LENGTHS * fingers,
        thumb=THUMB_LENGTHS * size * rng.normal(1.0, 0.04),
        thickness=float(np.clip(breadth * rng.normal(1.0, 0.07), 0.8, 1.25)),
    )


def rotation_x(degrees: float) -> FloatArray:
    """Rotation about x: turns y towards z for positive angles."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(degrees: float) -> FloatArray:
    """Rotation about y: turns z towards x for positive angles."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(degrees: float) -> FloatArray:
    """Rotation about z: turns x towards y for positive angles."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def thumb_base_frame(radial: float, palmar: float) -> FloatArray:
    """Frame of the thumb's metacarpal for the two angles of its saddle joint, twist included."""
    phi, theta = np.radians(radial), np.radians(palmar)
    along = np.array([np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta), np.sin(theta)])
    normal = np.array([0.0, 0.0, 1.0]) - along[2] * along
    normal /= np.linalg.norm(normal)
    frame = np.column_stack([np.cross(along, normal), along, normal])
    adduction = max(TWIST_FREE_RADIAL_DEG - radial, 0.0)
    twist = THUMB_TWIST_DEG + TWIST_PER_PALMAR_DEG * palmar + TWIST_PER_ADDUCTION_DEG * adduction
    return np.asarray(frame @ rotation_y(-twist))


def _chain(
    start: FloatArray, frame: FloatArray, bends: FloatArray, lengths: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Joint positions after `start`, and bone frames, of a finger whose bone i is bent by bends[i] before it runs."""
    points, frames, point = [], [], start
    for bend, length in zip(bends, lengths, strict=True):
        frame = frame @ rotation_x(float(bend))
        point = point + length * frame[:, 1]
        points.append(point)
        frames.append(frame)
    return points, frames


def pose_skeleton(pose: HandPose, proportions: Proportions = MEAN_PROPORTIONS) -> Skeleton:
    """Forward kinematics of a right hand in its own frame (palm fixed, the forearm turns at the wrist)."""
    points = np.zeros((JOINT_COUNT, 3))
    frames = np.tile(np.eye(3), (JOINT_COUNT, 1, 1))
    radial, palmar, mcp, ip = pose.angles[0]
    base = thumb_base_frame(float(radial), float(palmar))
    ends, bones = _chain(proportions.cmc, base, np.array([0.0, mcp, ip]), proportions.thumb)
    points[1], points[2:5] = proportions.cmc, ends
    frames[1:4], frames[4] = bones, bones[-1]
    for finger in range(4):
        flexion, abduction, pip, dip = pose.angles[finger + 1]
        first = 5 + 4 * finger
        base = rotation_z(-float(abduction))
        bends = np.array([flexion, pip, dip])
        ends, bones = _chain(proportions.mcp[finger], base, bends, proportions.fingers[finger])
        points[first], points[first + 1 : first + 4] = proportions.mcp[finger], ends
        frames[first : first + 3], frames[first + 3] = bones, bones[-1]
    flexion, deviation = pose.wrist
    forearm = rotation_z(float(deviation)) @ rotation_x(-float(flexion))
    return Skeleton(points, frames, forearm)
