"""A scene: spec in, frames with truth out. The same spec gives the same pixels, and frames may be asked in any order.

Each part draws from its own stream of the seed, so that changing the water does not change the diver.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.fsm import Grammar, load_grammar
from lightgesture.records import FrameRecord, Hand
from lightgesture.synth.backdrop import Backdrop, BackdropLook
from lightgesture.synth.body import BodyLook, Camera
from lightgesture.synth.camera import CameraLook, Sensor
from lightgesture.synth.diver import DiverLook, DrawnHand, draw_diver
from lightgesture.synth.hand import HandLook
from lightgesture.synth.motion import Performance, Style
from lightgesture.synth.script import Hold, Timing, make_timeline, tokens_at
from lightgesture.synth.shading import Light
from lightgesture.synth.skeleton import sample_proportions
from lightgesture.synth.skin import glove_tone, paint_atlas, skin_tone
from lightgesture.synth.spec import DiverSpec, SceneSpec
from lightgesture.synth.water import make_water

STREAMS = ("script", "diver", "motion", "backdrop", "camera", "drawn", "specks")
MIN_VISIBLE = 0.6
"""Share of a hand's outline that must be in the picture for its token to count; less is `partial`."""


@dataclass(frozen=True, slots=True)
class SceneFrame:
    """One frame: 8-bit BGR image and its truth."""

    image: NDArray[np.uint8]
    record: FrameRecord


def seed_streams(seed: int) -> dict[str, np.random.Generator]:
    """Independent generators, one for each part of a scene."""
    children = np.random.SeedSequence(seed).spawn(len(STREAMS))
    return {name: np.random.default_rng(child) for name, child in zip(STREAMS, children, strict=True)}


class Scene:
    """A rendered dive of known truth."""

    def __init__(self, spec: SceneSpec, grammar: Grammar | None = None, source: str | None = None) -> None:
        self.spec, self.grammar = spec, grammar or load_grammar()
        self.source = source
        streams = seed_streams(spec.seed)
        timing = Timing(spec.hold, spec.passage, spec.pause)
        self.timeline: list[Hold] = make_timeline(self.grammar, spec.sentences, timing, streams["script"])
        self.frame_count = self.timeline[-1].end
        self._performance = Performance(self.timeline, _style(spec), streams["motion"])
        self._camera = Camera(spec.camera.focal * spec.size[0], (0.5 * spec.size[0], 0.5 * spec.size[1]))
        self._look = diver_look(spec.diver, streams["diver"])
        self._water = make_water(spec.water.kind, spec.water.depth_m, spec.water.turbidity)
        self._light = _water_light(self._water.light, self._water.veil)
        back = spec.backdrop
        look = BackdropLook(back.floor, back.floor_m, back.surface_m, back.horizon, caustic=back.caustic)
        self._backdrop = Backdrop(look, self._water, self._camera.focal, spec.size, streams["backdrop"])
        self._sensor = Sensor(_camera_look(spec), streams["camera"])
        self._sensor.meter(self._backdrop.frame(0.0))

    def frames(self) -> Iterator[SceneFrame]:
        """All frames in order."""
        for index in range(self.frame_count):
            yield self.frame(index)

    def frame(self, index: int) -> SceneFrame:
        """One frame by number."""
        time_s = index / self.spec.fps
        state, moment = self._performance.state(index, time_s)
        picture = self._backdrop.frame(time_s)
        drawn = draw_diver(picture, state, self._look, self._camera, self._light, self._water)
        image = self._sensor.expose(picture, index, time_s)
        tokens = tokens_at(self.timeline, moment)
        hands = tuple(
            hand for hand in (_truth(item, token) for item, token in zip(drawn, tokens, strict=True)) if hand
        )
        return SceneFrame(image, FrameRecord(source=self.source, frame=index, time_s=time_s, hands=hands))


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
        suit_bgr=spec.suit, accent_bgr=spec.accent, skin_bgr=(blue, green, red), hood=spec.hood, mask=spec.mask,
        snorkel=spec.snorkel, regulator=spec.regulator, bare_arms=spec.sleeve_mm is None,
    )  # fmt: skip
    return DiverLook(body, hands[0], hands[1], spec.sleeve_mm)


def _style(spec: SceneSpec) -> Style:
    calm, amount = Style(), spec.motion.drift
    return Style(
        looseness=spec.diver.looseness,
        distance_mm=spec.diver.distance_mm,
        height_mm=spec.diver.height_mm,
        drift_mm=(calm.drift_mm[0] * amount, calm.drift_mm[1] * amount, calm.drift_mm[2] * amount),
        drift_deg=(calm.drift_deg[0] * amount, calm.drift_deg[1] * amount, calm.drift_deg[2] * amount),
        tremor_mm=spec.motion.tremor_mm,
    )


def _camera_look(spec: SceneSpec) -> CameraLook:
    camera, good = spec.camera, CameraLook()
    return CameraLook(
        target=camera.exposure, balance=camera.balance, shot=good.shot * camera.noise, read=good.read * camera.noise,
        blur_px=camera.blur_px, motion_px=camera.motion_px, jpeg=camera.jpeg, drift=camera.drift,
    )  # fmt: skip


def _water_light(light: NDArray[np.float32], veil: NDArray[np.float32]) -> Light:
    """Daylight from above, scattered light from around."""
    key, sky, ground = light * np.float32(0.85), light * np.float32(0.42), veil * np.float32(0.7)
    return Light(
        direction=(-0.25, -0.85, 0.55),
        key=(float(key[0]), float(key[1]), float(key[2])),
        sky=(float(sky[0]), float(sky[1]), float(sky[2])),
        ground=(float(ground[0]), float(ground[1]), float(ground[2])),
        shadow=0.45,
    )
