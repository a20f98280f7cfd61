"""A diver in one moment: where the body floats, where the hands are and what shapes they make; drawn with truth.

Angles are in degrees, lengths in millimetres. `left` and `right` are the diver's own sides; a diver who faces the
camera has the right hand on image left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lightgesture.synth.body import SHOULDER, BodyLook, Camera, elbow_position, render_body, to_camera
from lightgesture.synth.hand import Box, HandImage, HandLook, mask_box, render_hand
from lightgesture.synth.raster import Float32
from lightgesture.synth.shading import Light
from lightgesture.synth.skeleton import (
    WRIST_LIMITS_MAX,
    WRIST_LIMITS_MIN,
    FloatArray,
    HandPose,
    rotation_x,
    rotation_y,
    rotation_z,
)
from lightgesture.synth.surface import Forearm, HandView
from lightgesture.synth.water import Water

SIDES = ("left", "right")
DRAWN_PAST_CUFF_MM = 65.0
"""How far the forearm of the finely drawn hand reaches over the arm of the coarser body."""
FADE_SHARE = 0.35
"""Last part of the forearm's drawn length over which it fades into the body's arm."""


@dataclass(frozen=True, slots=True)
class ArmState:
    """One arm: `wrist` (3,) in the body frame; `turn` (yaw, pitch, roll) of the hand against the camera, as for a
    right hand (a left hand is its mirror image); `pose` of the fingers.

    Yaw 0 shows the palm, 180 the back; positive roll leans the fingers to the thumb's side.
    """

    wrist: FloatArray
    turn: FloatArray
    pose: HandPose


@dataclass(frozen=True, slots=True)
class DiverState:
    """Body position before the camera (x right, y up, z depth) and rotation (yaw, pitch, roll), with both arms."""

    position: FloatArray
    rotation: FloatArray
    left: ArmState
    right: ArmState


@dataclass(frozen=True, slots=True)
class DiverLook:
    """One diver: body, hands (each its own atlas but one tone), length of bare forearm before the sleeve."""

    body: BodyLook
    left: HandLook
    right: HandLook
    sleeve_mm: float | None = 35.0


@dataclass(frozen=True, slots=True)
class DrawnHand:
    """Truth of one drawn hand: own side, box of the outline inside the picture, and the share of it that is inside."""

    side: str
    box: Box
    visible: float


def rotation_matrix(turn: FloatArray) -> FloatArray:
    """Rotation by yaw, then pitch, then roll (degrees)."""
    yaw, pitch, roll = (float(angle) for angle in turn)
    return np.asarray(rotation_z(-roll) @ rotation_x(pitch) @ rotation_y(yaw))


def align(start: FloatArray, target: FloatArray) -> FloatArray:
    """The smallest rotation (3, 3) that turns unit vector `start` to unit vector `target` (Rodrigues' formula)."""
    axis, cosine = np.cross(start, target), float(start @ target)
    if cosine < -0.9999:  # opposite: any axis across will do
        return np.asarray(-np.eye(3) + 2.0 * np.outer(across := _across(start), across))
    skew = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return np.asarray(np.eye(3) + skew + skew @ skew / (1.0 + cosine))


def _across(vector: FloatArray) -> FloatArray:
    other = np.eye(3)[int(np.argmin(np.abs(vector)))]
    normal = np.cross(vector, other)
    return np.asarray(normal / np.linalg.norm(normal), np.float64)


def settle_wrist(
    rotation: FloatArray, towards_elbow: FloatArray, left: bool
) -> tuple[FloatArray, FloatArray]:
    """Wrist flexion and deviation (2,) for a hand that should stand as `rotation`, and the rotation it can have.

    towards_elbow (3,): from the wrist, camera axes with z towards the camera. Where the joint's range does not
    suffice, the hand gives way, not the arm.
    """
    mirror = np.array([-1.0 if left else 1.0, 1.0, 1.0])
    local = (rotation.T @ towards_elbow) * mirror
    flexion = np.degrees(np.arcsin(np.clip(local[2], -1.0, 1.0)))
    deviation = np.degrees(np.arctan2(local[0], -local[1]))
    wrist = np.clip(np.array([flexion, deviation]), WRIST_LIMITS_MIN, WRIST_LIMITS_MAX)
    forearm = rotation_z(float(wrist[1])) @ rotation_x(-float(wrist[0]))
    reached = rotation @ (-forearm[:, 1] * mirror)
    return np.asarray(wrist, np.float64), align(reached, towards_elbow) @ rotation


def draw_arm_hand(
    state: DiverState, look: DiverLook, side: str, camera: Camera, light: Light
) -> tuple[HandImage, float]:
    """Render one hand of the diver; returns it and its distance in metres."""
    left = side == "left"
    arm = state.left if left else state.right
    sign = 1.0 if left else -1.0
    shoulder = SHOULDER * np.array([sign, 1.0, 1.0])
    elbow = elbow_position(shoulder, arm.wrist, sign)
    body = rotation_matrix(state.rotation)
    points = to_camera(np.stack([arm.wrist, elbow]), body, state.position)
    image, scale = camera.project(points)
    # The hand is drawn as if on the optical axis, so its forearm must run to where the elbow is seen.
    seen = (image[1] - image[0]) / scale[0]
    towards = np.array([seen[0], -seen[1], points[0, 2] - points[1, 2]])
    towards = towards / max(float(np.linalg.norm(towards)), 1e-6)
    turn = arm.turn * (np.array([-1.0, 1.0, -1.0]) if left else 1.0)
    distance = float(points[0, 2]) / 1000.0
    wrist, rotation = settle_wrist(rotation_matrix(turn), towards, left)
    pose = HandPose(arm.pose.angles, wrist)
    view = HandView(
        rotation, (float(image[0, 0]), float(image[0, 1])), float(scale[0]), float(points[0, 2]), left
    )
    length = look.body.cuff_mm + DRAWN_PAST_CUFF_MM
    forearm = Forearm(length_mm=length, sleeve_mm=look.sleeve_mm)
    hand = render_hand(pose, view, look.left if left else look.right, light, forearm)
    return dissolve(hand, image[0], image[1], length / float(np.linalg.norm(points[1] - points[0]))), distance


def dissolve(hand: HandImage, wrist: FloatArray, elbow: FloatArray, end: float) -> HandImage:
    """Let the forearm fade into the body's arm before `end` (share of the way from wrist to elbow, picture pixels)."""
    line = elbow - wrist
    squared = max(float(line @ line), 1.0)
    rows, columns = hand.alpha.shape
    x = (np.arange(columns) + hand.origin[0] + 0.5 - wrist[0]) * (line[0] / squared)
    y = (np.arange(rows) + hand.origin[1] + 0.5 - wrist[1]) * (line[1] / squared)
    keep = np.clip((end - x[None, :] - y[:, None]) / (FADE_SHARE * end), 0.0, 1.0).astype(np.float32)
    return replace(hand, alpha=hand.alpha * keep, radiance=hand.radiance * keep[..., None])


def draw_diver(
    picture: Float32,
    state: DiverState,
    look: DiverLook,
    camera: Camera,
    light: Light,
    water: Water | None,
    held: Callable[[Float32, Float32], None] | None = None,
) -> tuple[list[DrawnHand], Float32]:
    """Draw the diver over a linear picture (in place), through `water` if given.

    held: draws what the hands hold, before the body and behind the hands, into picture and coverage. Returns the truth
    of both hands and the coverage (h, w) of the whole diver.
    """
    size = (picture.shape[1], picture.shape[0])
    wrists = (state.left.wrist, state.right.wrist)
    radiance, cover = render_body(
        look.body, rotation_matrix(state.rotation), state.position, wrists, camera, size, light, water
    )
    picture *= 1.0 - cover[..., None]
    picture += radiance
    if held is not None:
        held(picture, cover)
    drawn = [(*draw_arm_hand(state, look, side, camera, light), side) for side in SIDES]
    for hand, distance, _ in sorted(drawn, key=lambda item: -item[1]):
        if water is not None:
            hand = replace(hand, radiance=water.see_through(hand.radiance, hand.alpha, distance))
        hand.paste(picture)
        hand.cover(cover)
    return [_seen(side, hand, size) for hand, _, side in drawn], cover


def _seen(side: str, hand: HandImage, size: tuple[int, int]) -> DrawnHand:
    """Truth of a hand in a picture of `size` (width, height): box of the part inside, and its share."""
    total = float(hand.hand.sum())
    x0, y0 = (max(-offset, 0) for offset in hand.origin)
    x1, y1 = max(size[0] - hand.origin[0], x0), max(size[1] - hand.origin[1], y0)
    inside = hand.hand[y0:y1, x0:x1]
    if total <= 0.0 or inside.size == 0:
        return DrawnHand(side, (0, 0, 0, 0), 0.0)
    box = mask_box(inside, (hand.origin[0] + x0, hand.origin[1] + y0))
    return DrawnHand(side, box, float(inside.sum()) / total if box[2] * box[3] else 0.0)
