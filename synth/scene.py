"""A scene: spec in, frames with truth out. The same spec gives the same pixels, and frames may be asked in any order.

Each part draws from its own stream of the seed, so that changing the water does not change the diver.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.fsm import Grammar, Signs, load_grammar
from lightgesture.records import FrameRecord, Hand
from lightgesture.synth.atlas import paint_atlas
from lightgesture.synth.backdrop import Backdrop, BackdropLook
from lightgesture.synth.body import MOUTH, BodyLook, Camera, to_camera
from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.card_act import CardAct
from lightgesture.synth.diver import DiverLook, DiverState, DrawnHand, draw_diver, rotation_matrix
from lightgesture.synth.hand import HandLook
from lightgesture.synth.motion import Performance, Style
from lightgesture.synth.room import Room, RoomLook
from lightgesture.synth.script import Hold, Timing, make_timeline, tokens_at
from lightgesture.synth.shading import daylight
from lightgesture.synth.skeleton import sample_proportions
from lightgesture.synth.skin import glove_tone, skin_tone
from lightgesture.synth.spec import DiverSpec, SceneSpec
from lightgesture.synth.specks import Bubbles, Particles, mirror_in_surface
from lightgesture.synth.water import Water, make_water

STREAMS = ("script", "diver", "motion", "backdrop", "camera", "drawn", "specks")
MIN_VISIBLE = 0.6
"""Share of a hand's outline that must be in the picture for its token to count; less is `partial`."""

BARE_CUFF_MM = 40.0
"""Where a bare forearm passes from the hand's rendering to the body's, from the wrist."""
DAYLIGHT = (-0.25, -0.85, 0.55)
"""Where light comes from under water, image axes."""


View = Callable[[DiverState], DiverState | None]
"""From where the diver is before a camera that stays to where the diver is before one that moved."""


@dataclass(frozen=True, slots=True)
class SceneFrame:
    """One frame: 8-bit BGR image and its truth."""

    image: NDArray[np.uint8]
    record: FrameRecord
    signs: Signs | None = None
    """What a flawless reader tells the decoder, where it is not what the hands of the record show."""


def seed_streams(seed: int) -> dict[str, np.random.Generator]:
    """Independent generators, one for each part of a scene."""
    children = np.random.SeedSequence(seed).spawn(len(STREAMS))
    return {name: np.random.default_rng(child) for name, child in zip(STREAMS, children, strict=True)}


class Scene:
    """A rendered dive of known truth."""

    def __init__(self, spec: SceneSpec, grammar: Grammar | None = None) -> None:
        self.spec, self.grammar = spec, grammar or load_grammar()
        streams = seed_streams(spec.seed)
        self.timeline: list[Hold] = []
        self.cards: CardAct | None = None
        if spec.signing == "hands":
            timing = Timing(spec.hold, spec.passage, spec.pause)
            self.timeline = make_timeline(self.grammar, spec.sentences, timing, streams["script"])
            self.frame_count = self.timeline[-1].end
            self._performance = Performance(
                self.timeline, _style(spec), streams["motion"], self.frame_count / spec.fps
            )
        else:
            self.cards = CardAct(spec, self.grammar, _style(spec), streams["script"], streams["motion"])
            self.frame_count = self.cards.frame_count
        self._camera = Camera(spec.camera.focal * spec.size[0], (0.5 * spec.size[0], 0.5 * spec.size[1]))
        self._look = diver_look(spec.diver, streams["diver"])
        self._build_surroundings(streams)
        blur = spec.camera.blur_px
        if self._water is not None:
            blur = float(
                np.hypot(blur, self._water.blur_sigma(spec.diver.distance_mm / 1000.0, spec.size[0]))
            )
        self._sensor = Sensor(_camera_look(spec, blur), spec.size, streams["camera"])
        self._sensor.meter(self._backdrop.frame(0.0))

    def _build_surroundings(self, streams: dict[str, np.random.Generator]) -> None:
        spec, back = self.spec, self.spec.backdrop
        self._particles: Particles | None = None
        self._bubbles: Bubbles | None = None
        self._water: Water | None = None
        self._backdrop: Backdrop | Room
        if spec.water.kind == "none":
            room = Room(RoomLook(**spec.room.model_dump()), spec.size, streams["backdrop"])
            self._backdrop, self._light = room, room.light(streams["backdrop"])
            return
        water = make_water(spec.water.kind, spec.water.depth_m, spec.water.turbidity)
        look = BackdropLook(back.floor, back.floor_m, back.surface_m, back.horizon, caustic=back.caustic)
        self._water, self._light = water, daylight(water, DAYLIGHT)
        self._backdrop = Backdrop(look, water, self._camera.focal, spec.size, streams["backdrop"])
        if back.particles:
            self._particles = Particles(back.particles, self._camera, spec.size, streams["specks"])
        if back.bubbles > 0.0:
            self._bubbles = Bubbles(back.bubbles, self._camera, streams["specks"])

    def frames(self) -> Iterator[SceneFrame]:
        """All frames in order."""
        for index in range(self.frame_count):
            yield self.frame(index)

    def frame(self, index: int, view: View | None = None) -> SceneFrame:
        """One frame by number; beyond the last one the diver stays with lowered hands.

        view: where the diver of the script is seen by a camera that moves; None from it: out of the picture.
        """
        time_s = index / self.spec.fps
        if self.cards is not None:
            return self._frame_of_cards(self.cards, index, time_s)
        state, moment = self._performance.state(index, time_s)
        picture = self._backdrop.frame(time_s)
        seen = state if view is None else view(state)
        if seen is None:
            image = self._sensor.expose(picture, index, time_s)
            return SceneFrame(image, FrameRecord(source=None, frame=index, time_s=time_s))
        state = seen
        drawn, cover = draw_diver(picture, state, self._look, self._camera, self._light, self._water)
        if self._water is not None:
            self._draw_water_effects(picture, cover, state, time_s, self._water)
        image = self._sensor.expose(picture, index, time_s)
        tokens = tokens_at(self.timeline, moment)
        hands = tuple(
            hand for hand in (_truth(item, token) for item, token in zip(drawn, tokens, strict=True)) if hand
        )
        return SceneFrame(image, FrameRecord(source=None, frame=index, time_s=time_s, hands=hands))

    def diver(self, index: int) -> DiverState:
        """Where the diver of the script is in a frame, before a camera that stays."""
        return self._performance.state(index, index / self.spec.fps)[0]

    def _frame_of_cards(self, cards: CardAct, index: int, time_s: float) -> SceneFrame:
        picture = self._backdrop.frame(time_s)
        acted = cards.draw(picture, self._look, self._camera, self._light, self._water, index, time_s)
        if self._water is not None:
            self._draw_water_effects(picture, acted.cover, acted.state, time_s, self._water)
        image = self._sensor.expose(picture, index, time_s)
        record = FrameRecord(source=None, frame=index, time_s=time_s, signs=acted.cards)
        return SceneFrame(image, record, acted.signs)

    def _draw_water_effects(
        self,
        picture: NDArray[np.float32],
        cover: NDArray[np.float32],
        state: DiverState,
        time_s: float,
        water: Water,
    ) -> None:
        back = self.spec.backdrop
        if back.surface_m > 0.0 and isinstance(self._backdrop, Backdrop):
            drop = self._camera.focal * back.surface_m * 1000.0 / float(state.position[2])
            line = back.horizon * self.spec.size[1] - drop
            mirror_in_surface(picture, cover, line, self._backdrop.ripples, time_s)
        if self._bubbles is not None:
            rotation = rotation_matrix(state.rotation)
            mouth = to_camera(np.array([MOUTH]), rotation, state.position)[0]
            self._bubbles.draw(picture, time_s, mouth, water)
        if self._particles is not None:
            self._particles.draw(picture, time_s, water)


def _truth(drawn: DrawnHand, token: str | None) -> Hand | None:
    """The record of a hand; None where nothing of it is in the picture."""
    if drawn.visible <= 0.0:
        return None
    reason = None if token is not None else "unknown_shape"
    if drawn.visible < MIN_VISIBLE:
        token, reason = None, "partial"
    return Hand(side=drawn.side, token=token, confidence=1.0, box=drawn.box, track=None, reason=reason)


def diver_look(spec: DiverSpec, rng: np.random.Generator) -> DiverLook:
    """Everything that stays the same about a diver."""
    tone = glove_tone(spec.glove) if spec.glove is not None else skin_tone(spec.monk, spec.blood)
    skin = skin_tone(spec.monk, spec.blood)
    proportions = sample_proportions(rng)
    hands = [
        HandLook(proportions, tone, paint_atlas(rng, spec.glove is not None), spec.suit) for _ in range(2)
    ]
    blue, green, red = (float(value) for value in skin.back)
    body = BodyLook(
        suit_bgr=spec.suit, accent_bgr=spec.accent, mask_bgr=spec.accent,
        skin_bgr=(blue, green, red), hood=spec.hood, mask=spec.mask,
        snorkel=spec.snorkel, regulator=spec.regulator, bare_arms=spec.sleeve_mm is None,
        cuff_mm=BARE_CUFF_MM if spec.sleeve_mm is None else spec.sleeve_mm,
    )  # fmt: skip
    return DiverLook(body, hands[0], hands[1], spec.sleeve_mm)


def _style(spec: SceneSpec) -> Style:
    calm, amount = Style(), spec.motion.drift
    return Style(
        wrist=spec.diver.wrist_mm,
        looseness=spec.diver.looseness,
        distance_mm=spec.diver.distance_mm,
        height_mm=spec.diver.height_mm,
        drift_mm=(calm.drift_mm[0] * amount, calm.drift_mm[1] * amount, calm.drift_mm[2] * amount),
        drift_deg=(calm.drift_deg[0] * amount, calm.drift_deg[1] * amount, calm.drift_deg[2] * amount),
        tremor_mm=spec.motion.tremor_mm,
        approach_mm=spec.motion.approach_mm,
    )


def _camera_look(spec: SceneSpec, blur_px: float) -> CameraLook:
    camera, good = spec.camera, CameraLook()
    return CameraLook(
        target=camera.exposure, balance=camera.balance, shot=good.shot * camera.noise, read=good.read * camera.noise,
        blur_px=blur_px, motion_px=camera.motion_px, jpeg=camera.jpeg, drift=camera.drift,
    )  # fmt: skip
