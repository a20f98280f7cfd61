"""Views of a posed hand: turned away from the camera as far as its sign can still be told."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from lightgesture.synth.poses import SIDE_THUMB_TOKENS, STRETCHED_DEG
from lightgesture.synth.skeleton import (
    FloatArray,
    HandPose,
    pose_skeleton,
    rotation_x,
    rotation_y,
    rotation_z,
)

LARGEST_TURN_DEG: Final = 75.0
"""Most that palm or back are turned away from the camera."""
PITCH_DEG: Final = 14.0
"""Standard deviation of the tilt towards and away from the camera."""
ROLL_DEG: Final = 12.0
"""Standard deviation of the turn in the picture."""
TRIES: Final = 8
"""Views that are tried, each of them turned less far than the last."""
THUMB_TOKENS: Final = frozenset({"5", "pic", *SIDE_THUMB_TOKENS})
"""Signs of which the thumb must be seen."""
TIPS_MAY_MEET: Final = frozenset({"ok", "none"})
"""Signs that are told without counting fingers, a ring by itself."""
LEAST_GAP: Final = 0.06
"""From the tip of a stretched finger to another one in the picture, palm lengths: a third of a finger's width."""
LEAST_REACH: Final = 0.55
"""Of a stretched finger in the picture over its own length: shorter, it points at the camera."""
LEAST_THUMB: Final = 0.28
"""From the thumb's tip to the palm and the index finger, palm lengths: clear of both by a part of its width."""
LEAST_ASIDE: Final = 0.4
"""How far a thumb points to the side that names its sign, over its own length."""
OTHER_SIDE: Final[Mapping[str, str]] = dict(zip(SIDE_THUMB_TOKENS, reversed(SIDE_THUMB_TOKENS), strict=True))
"""What a mirrored sign is called; every other one keeps its name."""


@dataclass(frozen=True, slots=True, eq=False)
class PosedHand:
    """A hand before the camera. rotation: (3, 3), as in `surface.HandView`. left: a left hand. token: what it shows in
    the picture, where `left` and `right` say to which side the thumb points."""

    pose: HandPose
    rotation: FloatArray
    left: bool
    token: str

    def mirrored(self) -> PosedHand:
        """What a mirror shows: the other hand, and of the two signs of the thumb the other one."""
        mirror = np.array([-1.0, 1.0, 1.0])
        rotation = self.rotation * mirror * mirror[:, None]
        return PosedHand(self.pose, rotation, not self.left, OTHER_SIDE.get(self.token, self.token))

    def turned(self, by: FloatArray) -> PosedHand:
        """Turned by a rotation (3, 3) of the camera's frame, the sign as it was."""
        return PosedHand(self.pose, by @ self.rotation, self.left, self.token)

    def turned_round(self) -> PosedHand:
        """Turned by half a turn about the picture's upright: its other face, the thumb to the other side."""
        rotation = rotation_y(180.0) @ self.rotation
        return PosedHand(self.pose, rotation, self.left, OTHER_SIDE.get(self.token, self.token))

    def turn_deg(self) -> float:
        """How far palm or back are turned away from the camera, degrees, 0 to 90."""
        return float(np.degrees(np.arccos(min(abs(float(self.rotation[2, 2])), 1.0))))


def turned_away(
    hand: PosedHand, rng: np.random.Generator, largest: float = LARGEST_TURN_DEG
) -> PosedHand | None:
    """The hand in another view, up to `largest` degrees, 0 to 90, in which its sign is told; None if none is found."""
    for attempt in range(TRIES):
        yaw = rng.uniform(-largest, largest) * (1.0 - attempt / TRIES)
        by = (
            rotation_z(rng.normal(0.0, ROLL_DEG))
            @ rotation_x(rng.normal(0.0, PITCH_DEG))
            @ rotation_y(float(yaw))
        )
        other = hand.turned(by)
        if other.turn_deg() <= largest and can_be_told(other):
            return other
    return None


def can_be_told(hand: PosedHand) -> bool:
    """Whether the picture shows what the sign is told by: stretched fingers apart, and the thumb where it matters."""
    points = pose_skeleton(hand.pose).points * ([-1.0 if hand.left else 1.0, 1.0, 1.0])
    palm = float(np.linalg.norm(points[9]))
    seen = (points @ hand.rotation.T)[:, :2] / palm
    if hand.token in THUMB_TOKENS and not _shows_thumb(seen, points / palm, hand.token):
        return False
    stretched = [
        finger
        for finger in range(1, 5)
        if hand.pose.angles[finger, 2] < STRETCHED_DEG and hand.pose.angles[finger, 0] < STRETCHED_DEG
    ]
    for finger in stretched:
        first, tip = 1 + 4 * finger, 4 + 4 * finger
        length = float(np.linalg.norm(points[tip] - points[first])) / palm
        if float(np.linalg.norm(seen[tip] - seen[first])) < LEAST_REACH * length:
            return False
    if hand.token in TIPS_MAY_MEET:
        return True
    return all(
        _distance(seen[4 + 4 * one], seen[1 + 4 * other], seen[4 + 4 * other]) >= LEAST_GAP
        for one in stretched
        for other in stretched
        if one != other
    )


def _shows_thumb(seen: FloatArray, points: FloatArray, token: str) -> bool:
    """Whether the thumb stands off the palm, and to the side that names the sign."""
    parts = [(0, 5), (5, 6), (5, 17), (0, 17), (6, 7)]
    if min(_distance(seen[4], seen[a], seen[b]) for a, b in parts) < LEAST_THUMB:
        return False
    if token not in SIDE_THUMB_TOKENS:
        return True
    aside = float(seen[4, 0] - seen[2, 0]) * (-1.0 if token == "left" else 1.0)
    return aside >= LEAST_ASIDE * float(np.linalg.norm(points[4] - points[2]))


def _distance(point: FloatArray, start: FloatArray, end: FloatArray) -> float:
    """From a point to a line from start to end."""
    along = end - start
    part = np.clip((point - start) @ along / max(float(along @ along), 1e-9), 0.0, 1.0)
    return float(np.linalg.norm(point - start - part * along))
