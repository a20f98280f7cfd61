"""Joint angles from the positions of joints: inverse kinematics of the hand in closed form, many hands at a time.

The palm, which is stiff, is laid on the skeleton's by the best rotation and scale (Umeyama, "Least-squares estimation
of transformation parameters between two point patterns", IEEE PAMI 13(4), 1991). In its frame the plane in which a
finger bends gives its abduction, and the directions of its bones in that plane give the flexions. A joint whose range
does not reach so far is turned as far as it goes, and the next one makes up for that.

The thumb's plane follows from the two angles of its saddle joint. Where its bones do not lie in that plane, all four
angles are moved by a few damped Gauss-Newton steps to where the joints are nearest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from lightgesture.synth.skeleton import (
    ANGLE_LIMITS_MAX,
    ANGLE_LIMITS_MIN,
    JOINT_COUNT,
    MEAN_PROPORTIONS,
    THUMB_TWIST_DEG,
    TWIST_FREE_RADIAL_DEG,
    TWIST_PER_ADDUCTION_DEG,
    TWIST_PER_PALMAR_DEG,
    FloatArray,
    Proportions,
)

PALM: Final = (0, 5, 9, 13, 17)
"""Joints of the stiff part: the wrist and the four MCP joints."""
THUMB_WEIGHTS: Final = np.array([0.5, 1.0, 1.5])
"""How much the distances of the thumb's MCP joint, IP joint and tip count: the tip tells most about a sign."""
THUMB_STEPS: Final = 12
"""Gauss-Newton steps; later ones move the thumb by less than a tenth of a millimetre."""
DAMPING: Final = 4.0
"""Added to the diagonal of the normal equations, square millimetres per square degree times 100."""
DIFFERENCE_DEG: Final = 0.5
"""Step of the numeric derivatives."""


@dataclass(frozen=True, slots=True, eq=False)
class FittedHands:
    """angles: (n, 5, 4), degrees, as in `HandPose`. rotations: (n, 3, 3), from the hand's frame to that of the points.
    scales: (n,), of a millimetre of the skeleton in units of the points. wrists: (n, 3), where its wrist lies.
    """

    angles: FloatArray
    rotations: FloatArray
    scales: FloatArray
    wrists: FloatArray


def fit_hands(points: FloatArray, proportions: Proportions = MEAN_PROPORTIONS) -> FittedHands:
    """The poses of right hands with joints at `points` (n, 21, 3), finite, in any unit and right-handed frame.

    A left hand is mirrored first. Hands whose joints all coincide give angles without meaning.
    """
    if points.ndim != 3 or points.shape[1:] != (JOINT_COUNT, 3):
        raise ValueError(f"joints of shape {points.shape}; they must be (n, {JOINT_COUNT}, 3)")
    rotations, scales, wrists = _palm_placement(points, proportions)
    own = np.einsum("nji,nkj->nki", rotations, points - wrists[:, None]) / scales[:, None, None]
    angles = np.empty((len(points), 5, 4))
    angles[:, 0] = _thumb_angles(own[:, 1:5], proportions)
    for finger in range(1, 5):
        first = 1 + 4 * finger
        bones = np.diff(own[:, first : first + 4], axis=1)
        angles[:, finger] = _finger_angles(bones, finger)
    return FittedHands(angles, rotations, scales, wrists)


def _palm_placement(
    points: FloatArray, proportions: Proportions
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Rotation, scale and place that lay the skeleton's palm on each of the hands'."""
    template = np.vstack([np.zeros(3), proportions.mcp])
    palm = points[:, PALM]
    middle, centre = template.mean(axis=0), palm.mean(axis=1)
    covariance = np.einsum("nki,kj->nij", palm - centre[:, None], template - middle)
    left, strength, right = np.linalg.svd(covariance)
    sign = np.ones((len(points), 3))
    sign[:, 2] = np.sign(np.linalg.det(left) * np.linalg.det(right))
    rotations = (left * sign[:, None]) @ right
    spread = float(((template - middle) ** 2).sum())
    scales = np.maximum((strength * sign).sum(axis=1) / spread, np.finfo(float).tiny)
    return rotations, scales, centre - scales[:, None] * (rotations @ middle)


def _finger_angles(bones: FloatArray, finger: int) -> FloatArray:
    """Angles (n, 4) of one finger from its bones (n, 3, 3) in the palm's frame; finger: 1 index .. 4 little."""
    low, high = ANGLE_LIMITS_MIN[finger], ANGLE_LIMITS_MAX[finger]
    x, y, z = bones[..., 0], bones[..., 1], bones[..., 2]
    # The plane holds z; its other axis is the main direction of the bones as seen from the palm.
    turn = 0.5 * np.arctan2(2.0 * (x * y).sum(axis=1), (y * y - x * x).sum(axis=1))
    abduction = np.clip(np.degrees(turn), low[1], high[1])
    along = np.sin(np.radians(abduction))[:, None] * x + np.cos(np.radians(abduction))[:, None] * y
    flexion, pip, dip = _bends(np.degrees(np.arctan2(z, along)), low[[0, 2, 3]], high[[0, 2, 3]])
    return np.column_stack([flexion, abduction, pip, dip])


def _bends(directions: FloatArray, low: FloatArray, high: FloatArray) -> list[FloatArray]:
    """How far each joint is bent for bones of these directions (n, k), degrees in their plane, within its range."""
    reached, bends = np.zeros(len(directions)), []
    for bone in range(directions.shape[1]):
        # Counted from the middle of the range, so that a bone that goes too far is not taken to go the other way.
        centre = 0.5 * (low[bone] + high[bone])
        bend = centre + (directions[:, bone] - reached - centre + 180.0) % 360.0 - 180.0
        bends.append(np.clip(bend, low[bone], high[bone]))
        reached = reached + bends[-1]
    return bends


def _thumb_angles(joints: FloatArray, proportions: Proportions) -> FloatArray:
    """Angles (n, 4) of thumbs whose joints (n, 4, 3) lie in the palm's frame, millimetres."""
    low, high = ANGLE_LIMITS_MIN[0], ANGLE_LIMITS_MAX[0]
    # From the skeleton's own joint: detectors put the first landmark beyond it.
    along = joints[:, 1] - proportions.cmc
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    saddle = np.degrees(
        np.column_stack([np.arctan2(along[:, 0], along[:, 1]), np.arcsin(np.clip(along[:, 2], -1.0, 1.0))])
    )
    saddle = np.clip(saddle, low[:2], high[:2])
    frames = _thumb_frames(saddle)
    bones = np.einsum("nji,nkj->nki", frames, np.diff(joints[:, 1:], axis=1))
    bends = _bends(np.degrees(np.arctan2(bones[..., 2], bones[..., 1])), low[2:], high[2:])
    angles = np.column_stack([saddle, *bends])
    for _ in range(THUMB_STEPS):
        angles = np.clip(angles + _thumb_step(angles, joints[:, 1:], proportions), low, high)
    return angles


def _thumb_step(angles: FloatArray, joints: FloatArray, proportions: Proportions) -> FloatArray:
    """Change of the angles (n, 4) that brings the thumb's last joints nearer to `joints` (n, 3, 3)."""
    weights = np.repeat(THUMB_WEIGHTS, 3)
    reached = _thumb_joints(angles, proportions).reshape(-1, 9)
    missing = (joints.reshape(-1, 9) - reached) * weights
    slopes = np.empty((len(angles), 9, 4))
    for angle in range(4):
        moved = angles.copy()
        moved[:, angle] += DIFFERENCE_DEG
        slopes[:, :, angle] = (_thumb_joints(moved, proportions).reshape(-1, 9) - reached) / DIFFERENCE_DEG
    slopes *= weights[:, None]
    normal = np.einsum("nki,nkj->nij", slopes, slopes) + 0.01 * DAMPING * np.eye(4)
    return np.linalg.solve(normal, np.einsum("nki,nk->ni", slopes, missing)[..., None])[..., 0]


def _thumb_joints(angles: FloatArray, proportions: Proportions) -> FloatArray:
    """MCP joint, IP joint and tip (n, 3, 3) of thumbs with angles (n, 4), as `skeleton.pose_skeleton` has them."""
    frames = _thumb_frames(angles[:, :2])
    joints = np.empty((len(angles), 3, 3))
    place, bend = np.broadcast_to(proportions.cmc, (len(angles), 3)), np.zeros(len(angles))
    for bone, length in enumerate(proportions.thumb):
        if bone:
            bend = bend + np.radians(angles[:, 1 + bone])
        place = place + length * (
            np.cos(bend)[:, None] * frames[:, :, 1] + np.sin(bend)[:, None] * frames[:, :, 2]
        )
        joints[:, bone] = place
    return joints


def _thumb_frames(saddle: FloatArray) -> FloatArray:
    """`skeleton.thumb_base_frame` (n, 3, 3) for many angles (n, 2) at a time."""
    radial, palmar = np.radians(saddle).T
    along = np.column_stack(
        [np.sin(radial) * np.cos(palmar), np.cos(radial) * np.cos(palmar), np.sin(palmar)]
    )
    normal = np.array([0.0, 0.0, 1.0]) - along[:, 2:] * along
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    across = np.cross(along, normal)
    adduction = np.maximum(TWIST_FREE_RADIAL_DEG - saddle[:, 0], 0.0)
    twist = -np.radians(
        THUMB_TWIST_DEG + TWIST_PER_PALMAR_DEG * saddle[:, 1] + TWIST_PER_ADDUCTION_DEG * adduction
    )
    cosine, sine = np.cos(twist)[:, None], np.sin(twist)[:, None]
    return np.stack([cosine * across - sine * normal, along, sine * across + cosine * normal], axis=2)
