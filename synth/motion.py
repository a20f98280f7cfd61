"""How the diver moves: arms and hands through a timeline, body adrift in six degrees of freedom."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lightgesture.synth.diver import ArmState, DiverState
from lightgesture.synth.poses import SIDE_THUMB_TOKENS, TOKEN_LEAN_DEG, TOKEN_YAW_DEG, blend_poses, token_pose
from lightgesture.synth.script import ACTIVITIES, Hold, Moment, moment_at
from lightgesture.synth.skeleton import FloatArray

SPREAD_MM = 18.0
"""How far the place of the hands varies from sign to sign."""
TURN_DEG = (11.0, 10.0, 9.0)
"""The same of a hand's yaw, pitch and roll, per unit of looseness."""
DRIFT_HZ = 0.25
"""Of the body; hands tremble four times as quickly."""
DIP_MM = 45.0
"""How far hands sink between signs."""


@dataclass(frozen=True, slots=True)
class Style:
    """One diver's way of signing; lengths in millimetres, angles in degrees.

    wrist: where the left hand is held, body frame (the right one is its mirror image). looseness: of the shapes, see
    `poses.token_pose`. drift_mm / drift_deg: standard deviation of the body's drift. tremor_mm: of the hands.
    approach_mm: how much nearer the diver is at the end.
    """

    wrist: tuple[float, float, float] = (300.0, 70.0, 220.0)
    looseness: float = 0.8
    distance_mm: float = 1300.0
    height_mm: float = -60.0
    drift_mm: tuple[float, float, float] = (14.0, 12.0, 30.0)
    drift_deg: tuple[float, float, float] = (5.0, 3.0, 3.0)
    tremor_mm: float = 3.0
    approach_mm: float = 0.0


class Drift:
    """Smooth random motion of unit variance in `size` dimensions: a sum of sines, the same at every call."""

    def __init__(self, rng: np.random.Generator, size: int, frequency_hz: float, waves: int = 4) -> None:
        self._frequency = frequency_hz * rng.uniform(0.3, 2.0, (size, waves))
        self._phase = rng.uniform(0.0, 2.0 * np.pi, (size, waves))
        self._amplitude = np.sqrt(2.0 / waves)

    def at(self, time_s: float) -> FloatArray:
        """Value (size,) at a time in seconds."""
        waves = np.sin(2.0 * np.pi * self._frequency * time_s + self._phase)
        return np.asarray(self._amplitude * waves.sum(axis=1))


class Performance:
    """A diver who goes through a timeline; `state(frame, time_s)` may be asked in any order."""

    def __init__(
        self, timeline: Sequence[Hold], style: Style, rng: np.random.Generator, length_s: float
    ) -> None:
        self._length_s = max(length_s, 1e-3)
        self.timeline, self.style = tuple(timeline), style
        self._keys = [tuple(self._arm(hold, side, rng) for side in (0, 1)) for hold in self.timeline]
        self._body = Drift(rng, 6, DRIFT_HZ)
        self._hands = Drift(rng, 6, 4.0 * DRIFT_HZ)

    def state(self, frame: int, time_s: float) -> tuple[DiverState, Moment]:
        """Where everything is in a frame, and the moment of the timeline it belongs to."""
        moment, style = moment_at(self.timeline, frame), self.style
        drift, shake = self._body.at(time_s), style.tremor_mm * self._hands.at(time_s)
        arms = []
        for hand in (0, 1):
            arm = self._between(self._keys[moment.before][hand], self._keys[moment.after][hand], moment.part)
            wrist = arm.wrist + shake[3 * hand : 3 * hand + 3] + self._sway(moment, hand, time_s)
            arms.append(ArmState(wrist, arm.turn, arm.pose))
        distance = style.distance_mm - style.approach_mm * min(time_s / self._length_s, 1.0)
        position = np.array([0.0, style.height_mm, distance]) + drift[:3] * np.array(style.drift_mm)
        rotation = drift[3:] * np.array(style.drift_deg)
        return DiverState(position, rotation, arms[0], arms[1]), moment

    def _sway(self, moment: Moment, hand: int, time_s: float) -> FloatArray:
        """How far a busy hand is from its place; grows and fades during the passages."""
        offset = np.zeros(3)
        for index, share in ((moment.before, 1.0 - moment.part), (moment.after, moment.part)):
            if self.timeline[index].pair is None:
                activity = ACTIVITIES[self.timeline[index].activity][hand]
                phase = 2.0 * np.pi * activity.hz * time_s
                swing = np.array([np.sin(phase), np.cos(phase), np.cos(phase)])
                offset += share * swing * np.array(activity.sway) * (1.0 if hand == 0 else -1.0, 1.0, 1.0)
        return offset

    def _arm(self, hold: Hold, hand: int, rng: np.random.Generator) -> ArmState:
        """How one hand (0 left, 1 right) is held in a hold."""
        style, sign = self.style, np.array([1.0 if hand == 0 else -1.0, 1.0, 1.0])
        spread = rng.normal(0.0, SPREAD_MM, 3)
        turn = rng.normal(0.0, style.looseness, 3) * np.array(TURN_DEG)
        if hold.pair is None:
            activity = ACTIVITIES[hold.activity][hand]
            pose = token_pose(activity.shape, rng, style.looseness)
            return ArmState(np.array(activity.wrist) * sign + spread, turn + np.array(activity.turn), pose)
        token = hold.pair[hand]
        pose = token_pose(token, rng, style.looseness)
        # `left` shows the palm and `right` the back of either hand: so their thumbs point in and out.
        facing = 180.0 if token == SIDE_THUMB_TOKENS[1] else TOKEN_YAW_DEG.get(token, 0.0)
        lean = TOKEN_LEAN_DEG.get(token, 0.0) * (1.0 if token == SIDE_THUMB_TOKENS[0] else -1.0)
        return ArmState(np.array(style.wrist) * sign + spread, turn + np.array([facing, 0.0, lean]), pose)

    def _between(self, old: ArmState, new: ArmState, part: float) -> ArmState:
        if old is new or part <= 0.0:
            return old
        eased = part * part * (3.0 - 2.0 * part)
        wrist = old.wrist + eased * (new.wrist - old.wrist)
        wrist = wrist - np.array([0.0, 4.0 * part * (1.0 - part) * DIP_MM, 0.0])
        turn = old.turn + eased * (new.turn - old.turn)
        return ArmState(wrist, turn, blend_poses(old.pose, new.pose, part))
