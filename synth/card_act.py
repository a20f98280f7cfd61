"""A dive with cards in place of signs of the hands: who holds what where, drawn with its truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from lightgesture.fsm import Grammar, Sign, Signs
from lightgesture.records import CardSign
from lightgesture.synth.body import Camera
from lightgesture.synth.card_motion import CardPerformance
from lightgesture.synth.card_script import Step, card_steps, motion_steps
from lightgesture.synth.cards import CardState, DrawnCard, draw_card
from lightgesture.synth.diver import DiverLook, DiverState, draw_diver, rotation_matrix
from lightgesture.synth.motion import Style
from lightgesture.synth.raster import Float32
from lightgesture.synth.script import Timing
from lightgesture.synth.shading import Light
from lightgesture.synth.spec import SceneSpec
from lightgesture.synth.water import Water

LEAST_FACING: Final = 0.25
"""Cosine of the angle between a card's face and the line of sight above which a tag is told to be seen."""

FLAWLESS_MARGIN: Final = 127.0
"""Margin of a tag in the truth, grey levels."""


@dataclass(frozen=True, slots=True)
class Acted:
    """What was drawn. cover (h, w): of the diver. cards: the tags in view. signs: what a flawless reader tells."""

    state: DiverState
    cover: Float32
    cards: tuple[CardSign, ...]
    signs: Signs


class CardAct:
    """Cards shown or moved as a scene says."""

    def __init__(
        self,
        spec: SceneSpec,
        grammar: Grammar,
        style: Style,
        script: np.random.Generator,
        rng: np.random.Generator,
    ) -> None:
        timing = Timing(spec.hold, spec.passage, spec.pause)
        self.steps: list[Step]
        if spec.signing == "tags":
            self.steps = card_steps(grammar, spec.sentences, timing, script)
        else:
            self.steps = motion_steps(grammar, spec.sentences, timing, spec.fps, script)
        motions = grammar.motions
        ids = (0, 0) if motions is None else (motions.left, motions.right)
        self._performance = CardPerformance(self.steps, style, spec.cards, ids, rng)
        self._words = {} if grammar.tags is None else grammar.tags.words
        self._sides = {ids[0]: "left", ids[1]: "right"} if spec.signing == "tag-motion" else {}

    @property
    def frame_count(self) -> int:
        """Frames from lowered hands to lowered hands."""
        return self.steps[-1].end

    def draw(
        self,
        picture: Float32,
        look: DiverLook,
        camera: Camera,
        light: Light,
        water: Water | None,
        frame: int,
        time_s: float,
    ) -> Acted:
        """Draw the diver with the cards over a linear picture, in place."""
        state, cards, step = self._performance.state(frame, time_s)
        drawn: list[DrawnCard] = []

        def held(below: Float32, cover: Float32) -> None:
            body = rotation_matrix(state.rotation)
            drawn.extend(
                draw_card(below, cover, card, body, state.position, camera, light, water)
                for card in sorted(cards, key=_depth)
            )

        _, cover = draw_diver(picture, state, look, camera, light, water, held)
        size = (picture.shape[1], picture.shape[0])
        seen = [card for card in drawn if card.facing > LEAST_FACING and _is_inside(card, size)]
        word = step.word if step is not None and step.kind in ("card", "ready") else None
        is_seen = bool(seen) and (step is None or step.kind != "ready" or len(seen) == len(cards))
        sign = Signs(left=Sign(word, is_word=True)) if word is not None and is_seen else Signs()
        return Acted(state, cover, tuple(self._told(card, word) for card in seen), sign)

    def _told(self, card: DrawnCard, word: str | None) -> CardSign:
        side = self._sides.get(card.id)
        rounded = card.corners.round(1).tolist()
        return CardSign(
            side=side,
            id=card.id,
            word=self._words.get(card.id) if side is None else word,
            corners=tuple((x, y) for x, y in rounded),
            margin=FLAWLESS_MARGIN,
        )


def _depth(card: CardState) -> float:
    """What is nearer the camera is drawn later."""
    return float(card.centre[2])


def _is_inside(card: DrawnCard, size: tuple[int, int]) -> bool:
    return bool((card.corners >= 0.0).all() and (card.corners <= np.array(size) - 1.0).all())
