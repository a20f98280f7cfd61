"""How a diver with cards moves: cards raised, shown, turned and put away, or two of them moved in shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

import cv2
import numpy as np

from lightgesture.features.motion.matching import resampled
from lightgesture.features.motion.shapes import SHAPES
from lightgesture.synth.card_script import Step
from lightgesture.synth.cards import CARD_MM, CardState, place_on
from lightgesture.synth.diver import ArmState, DiverState
from lightgesture.synth.motion import DRIFT_HZ, Drift, Style
from lightgesture.synth.poses import token_pose
from lightgesture.synth.script import LOWERED_TURN, LOWERED_WRIST
from lightgesture.synth.skeleton import FloatArray
from lightgesture.synth.spec import CardSpec

Grip = Literal["left", "right", "both"]
"""Which hands hold a card, by the diver's own side."""

SIDEWAYS_MM: Final = 110.0
"""How far to its own side of where it is shown one hand holds a card."""

APART_MM: Final = 215.0
"""From the middle to each of two cards that are moved."""

LOWERED_MM: Final = (230.0, -330.0, 220.0)
"""Where a card is while it is not shown, lying flat."""

FLAT_DEG: Final = -85.0
"""Its pitch there: its face up."""

HELD_MM: Final = (50.0, CARD_MM[1] - 0.5 * CARD_MM[0] + 104.0, 8.0)
"""The wrist from the tag's centre: to the hand's own side, down, and before the card. So the fingers cover its lower
corner."""

MOST_PITCH_DEG: Final = 25.0
"""Most that a card leans forwards or back; the rest of a turn is to the side."""

SLOPPY: Final = {"stretch": 0.12, "turn_deg": 6.0, "wobble": 0.06, "gap": 0.05, "round": 0.012}
"""How people draw, standard deviations per unit of looseness: width against height as a logarithm, the whole turned,
waves as a share of the size, the end off the beginning likewise; and the share of the way over which corners are
rounded."""

CURVE_POINTS: Final = 200


class CardPerformance:
    """A diver who goes through steps; `state(frame, time_s)` may be asked in any order."""

    def __init__(
        self,
        steps: Sequence[Step],
        style: Style,
        cards: CardSpec,
        hands: tuple[int, int],
        rng: np.random.Generator,
    ) -> None:
        """hands: ids of the cards that the left and the right hand move."""
        self._steps, self._style, self._spec, self._ids = tuple(steps), style, cards, hands
        self._keys = [self._poses(step, rng) for step in self._steps]
        self._curves = [self._draw(step, rng) for step in self._steps]
        self._body = Drift(rng, 6, DRIFT_HZ)
        self._hands = Drift(rng, 6, 4.0 * DRIFT_HZ)
        grips: list[Grip] = ["left", "right", "both"]
        self._grips: list[Grip] = [grips[int(number)] for number in rng.integers(3, size=len(self._steps))]
        self._shape = token_pose("grip", rng, style.looseness)

    def state(self, frame: int, time_s: float) -> tuple[DiverState, tuple[CardState, ...], Step | None]:
        """The diver, the cards that may be in view, and the step; None on the way from one to the next."""
        style = self._style
        before, after, part = self._moment(frame)
        shake = style.tremor_mm * self._hands.at(time_s)
        cards = self._cards(before, after, part, frame, shake)
        drift = self._body.at(time_s)
        position = np.array([0.0, style.height_mm, style.distance_mm]) + drift[:3] * np.array(style.drift_mm)
        rotation = drift[3:] * np.array(style.drift_deg)
        arms = [self._arm(side, cards, self._held_by(before, after)) for side in (0, 1)]
        shown = tuple(card for card in cards if card is not None)
        step = self._steps[before] if before == after else None
        return DiverState(position, rotation, arms[0], arms[1]), shown, step

    def _moment(self, frame: int) -> tuple[int, int, float]:
        """Numbers of the steps before and after a frame, and the eased part of the way; equal inside a step."""
        for index, step in enumerate(self._steps):
            if frame < step.start:
                end = self._steps[index - 1].end
                part = (frame - end + 1) / (step.start - end + 1)
                return index - 1, index, part * part * (3.0 - 2.0 * part)
            if frame < step.end:
                return index, index, 0.0
        return len(self._steps) - 1, len(self._steps) - 1, 0.0

    def _held_by(self, before: int, after: int) -> Grip:
        """Which hands hold the card of the steps before and after a frame."""
        index = next((index for index in (after, before) if self._steps[index].id is not None), after)
        chosen = self._spec.hands
        return self._grips[index] if chosen == "any" else chosen

    def _poses(self, step: Step, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
        """Shift (3,) and turn (3,) that vary from word to word."""
        angle, axis = self._spec.tilt_deg * np.sqrt(rng.uniform()), rng.uniform(0.0, 2 * np.pi)
        if step.kind in ("ready", "motion"):
            angle *= 0.4
        # Wrists bend less forwards and back than a card turns to the sides; the fingers would come over the tag.
        pitch = float(np.clip(angle * np.sin(axis), -MOST_PITCH_DEG, MOST_PITCH_DEG))
        tilt = np.array([np.copysign(np.sqrt(max(angle**2 - pitch**2, 0.0)), np.cos(axis)), pitch])
        roll = rng.normal(0.0, self._spec.roll_deg)
        return rng.normal(0.0, 20.0, 3), np.array([tilt[0], tilt[1], roll])

    def _draw(self, step: Step, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
        """What each hand draws, (CURVE_POINTS, 2) mm, to the diver's right and up; zeros at rest."""
        pair = step.motion or ("still", "still")
        size = self._spec.motion_mm * np.exp(rng.normal(0.0, 0.12))
        curves = [drawn_shape(name, size, self._style.looseness, rng) for name in pair]
        return curves[0], curves[1]

    def _cards(
        self, before: int, after: int, part: float, frame: int, shake: FloatArray
    ) -> tuple[CardState | None, CardState | None]:
        """What the left and the right hand hold; a card in both hands is the right one's."""
        kinds = {self._steps[before].kind, self._steps[after].kind}
        if kinds & {"ready", "motion"}:
            return self._moved(0, before, after, part, frame, shake), self._moved(
                1, before, after, part, frame, shake
            )
        index = next((index for index in (after, before) if self._steps[index].id is not None), None)
        if index is None:
            return None, None
        grip, number = self._held_by(before, after), self._steps[index].id or 0
        sign = {"left": 1.0, "right": -1.0, "both": 0.0}[grip]
        shift, turn = self._keys[index]
        shown = np.array(self._spec.shown_mm) + np.array([sign * SIDEWAYS_MM, 0.0, 0.0]) + shift
        share = 1.0 if before == after else part if index == after else 1.0 - part
        place = 1 if grip != "left" else 0
        card = self._between(shown, turn, share, -1.0 if sign <= 0.0 else 1.0, number, shake[3 * place :][:3])
        return (None, card) if place else (card, None)

    def _moved(
        self, side: int, before: int, after: int, part: float, frame: int, shake: FloatArray
    ) -> CardState:
        """One of two cards: 0 the left hand's."""
        sign = 1.0 if side == 0 else -1.0
        up = [self._steps[index].kind != "lowered" for index in (before, after)]
        share = 1.0 if all(up) else part if up[1] else 1.0 - part
        # How they are held stays for a sentence: that of the first step after the last lowered hands.
        key = next(index for index in range(before, -1, -1) if self._steps[index].kind == "lowered")
        shift, turn = self._keys[key]
        shown = np.array(self._spec.shown_mm) + np.array([sign * APART_MM, 0.0, 0.0]) + shift
        step = self._steps[before]
        if before == after and step.kind == "motion":
            way = (frame - step.start + 1) / (step.end - step.start + 1)
            # A hand starts and stops gently.
            place = (0.5 - 0.5 * np.cos(np.pi * way)) * 0.6 + way * 0.4
            curve = self._curves[before][side]
            x, y = (
                np.interp(place * (CURVE_POINTS - 1), np.arange(CURVE_POINTS), curve[:, axis])
                for axis in (0, 1)
            )
            # The diver's right is at the body frame's negative x.
            shown = shown + np.array([-x, y, 0.0])
        return self._between(shown, turn * 0.4, share, sign, self._ids[side], shake[3 * side :][:3])

    def _between(
        self, shown: FloatArray, turn: FloatArray, share: float, sign: float, number: int, shake: FloatArray
    ) -> CardState:
        """A card on its way up: share 0 lowered, 1 shown."""
        lowered = np.array([sign * LOWERED_MM[0], LOWERED_MM[1], LOWERED_MM[2]])
        flat = np.array([0.0, FLAT_DEG, 0.0])
        centre = lowered + share * (shown - lowered) + shake
        return CardState(number, self._spec.side_mm, centre, flat + share * (turn - flat), self._spec.family)

    def _arm(self, side: int, cards: tuple[CardState | None, CardState | None], grip: Grip) -> ArmState:
        """One arm, 0 the left: at the card that it holds, or lowered."""
        sign = 1.0 if side == 0 else -1.0
        card = cards[side]
        if card is None and grip == "both":
            card = cards[1 - side]
        if card is None:
            wrist = np.array(LOWERED_WRIST) * np.array([sign, 1.0, 1.0])
            return ArmState(wrist, np.array(LOWERED_TURN), self._shape)
        wrist = place_on(card, sign * HELD_MM[0], -HELD_MM[1], HELD_MM[2])
        # The hand leans as the card does; turns are given as for a right hand.
        return ArmState(wrist, np.array([0.0, card.turn[1], sign * card.turn[2]]), self._shape)


def drawn_shape(name: str, size_mm: float, looseness: float, rng: np.random.Generator) -> FloatArray:
    """A shape as a person draws it, (CURVE_POINTS, 2) mm from its first point, `size_mm` from its middle to its sides;
    zeros for "still"."""
    if name not in SHAPES:
        return np.zeros((CURVE_POINTS, 2))
    ways = SHAPES[name]
    curve = resampled(ways[int(rng.integers(len(ways)))], CURVE_POINTS)
    curve = curve / max(float(np.ptp(curve, axis=0).max()), 1e-9) * 2.0
    curve = curve * np.exp(rng.normal(0.0, SLOPPY["stretch"] * looseness, 2))
    angle = np.radians(rng.normal(0.0, SLOPPY["turn_deg"] * looseness))
    curve = curve @ np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    curve = _smoothed(curve, SLOPPY["round"] * CURVE_POINTS * max(looseness, 0.2))
    part = np.linspace(0.0, 1.0, CURVE_POINTS)[:, None]
    waves = rng.normal(0.0, SLOPPY["wobble"] * looseness, (3, 2)) / np.arange(1, 4)[:, None]
    phases = rng.uniform(0.0, 2 * np.pi, (3, 2))
    wobble = sum(
        waves[order] * (np.sin(2 * np.pi * (order + 1) * part + phases[order]) - np.sin(phases[order]))
        for order in range(3)
    )
    curve = curve + wobble + part * rng.normal(0.0, SLOPPY["gap"] * looseness, 2)
    return np.asarray((curve - curve[0]) * size_mm)


def _smoothed(curve: FloatArray, sigma: float) -> FloatArray:
    """Corners rounded; the ends stay."""
    radius = max(int(3 * sigma), 1)
    kernel = cv2.getGaussianKernel(2 * radius + 1, sigma).ravel()
    ends = np.vstack([np.repeat(curve[:1], radius, axis=0), curve, np.repeat(curve[-1:], radius, axis=0)])
    return np.column_stack([np.convolve(ends[:, axis], kernel, mode="valid") for axis in (0, 1)])
