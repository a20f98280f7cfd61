"""Training pictures of real hands on the synthetic diver, under water and in rooms, real and rendered."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from lightgesture.features.types import Box, Image
from lightgesture.synth.body import MOUTH, BodyLook, Camera, to_camera
from lightgesture.synth.camera import CameraLook, photographed
from lightgesture.synth.diver import ArmState, DiverState, rotation_matrix
from lightgesture.synth.hand import HAND_LENGTH_MM
from lightgesture.synth.raster import Float32
from lightgesture.synth.skeleton import HandPose
from lightgesture.synth.specks import Bubbles, mirror_in_surface
from lightgesture.synth.variety import ACCENTS, SUITS
from lightgesture.synth.water import Water
from lightgesture.training.pictures.composites import (
    BARE_ARM_SHARE,
    DARK_SHARE,
    EMPTY_SHARE,
    LAMP_SHARE,
    OTHER_HAND_SHARE,
    SINGLE_SHARE,
    SIZE,
    WATER_SHARE,
    Background,
    Composer,
    Composite,
)
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.real_hands import Shown, draw_diver, skin_colour
from lightgesture.training.pictures.surroundings import (
    Scenery,
    Surroundings,
    darken,
    light_of_room,
    light_under_water,
    water_of_picture,
)

NO_POSE = HandPose(np.zeros((5, 4)), np.zeros(2))
"""The fingers are those of a photograph."""
SIDES = ("right", "left")
THUMB_TOKENS = ("left", "right")
HEAD_MM = (0.0, 215.0, 20.0)
"""Middle of the head in the body frame of `synth.body`, chin to crown."""
HEAD_HALF_MM = (92.0, 125.0)
"""Half its width and height."""


DRAWN_SHARE: Final = 0.25
"""Of pictures, those with the simple bodies of `Composer`, which know fewer restraints."""
RENDERED_SHARE: Final = 0.4
"""Of the others, those before rendered water or rooms instead of real pictures."""
HAND_HEIGHT: Final = (0.09, 0.45)
"""Of a stretched hand over the picture's height, drawn evenly in the logarithm."""
WRIST_MM: Final = ((110.0, 420.0), (-230.0, 230.0), (120.0, 330.0))
"""Range of the left wrist in the body frame, each axis; the right one likewise, mirrored."""
APART_MM: Final = 35.0
"""How far the two hands differ in it, standard deviation."""
BEFORE_FACE_SHARE: Final = 0.15
"""Of pictures, those with the hands before or beside the face."""
INWARD_SHARE: Final = 0.75
"""Of hands, those whose thumb points to the body, as palms have it."""
MIRRORED_SHARE: Final = 0.3
BUBBLE_SHARE: Final = 0.25
"""Of pictures under water, those with the diver's image in the surface, and those with bubbles."""
TURN_DEG: Final = 10.0
"""Lean of the hands, standard deviation."""
BODY_DEG: Final = (12.0, 6.0, 5.0)
"""Yaw, pitch and roll of the body, standard deviations."""
LEAST_VISIBLE: Final = 0.67
"""Share of a hand inside the picture from which it is given a box."""


class DiverComposer(Composer):
    """Draws pictures without end, as `Composer` does; a share of them are the simpler pictures of `Composer` itself.

    Tokens are those that the diver shows, by the diver's own sides.
    """

    def __init__(
        self,
        cutouts: Sequence[Cutout],
        waters: Sequence[Background],
        rooms: Sequence[Background],
        size: tuple[int, int] = SIZE,
        seed: int = 0,
    ) -> None:
        """As `Composer`; seed: of the rendered surroundings, which are drawn here, once."""
        super().__init__(cutouts, waters, rooms, size)
        self._surroundings = Surroundings(size, np.random.default_rng(seed))

    def compose(self, rng: np.random.Generator) -> Composite:
        """One picture; the same state of `rng` gives the same pixels on one machine and version."""
        if rng.random() < DRAWN_SHARE:
            return super().compose(rng)
        width, height = self._size
        draw = rng.random()
        is_wet, is_dark = draw < WATER_SHARE, draw > 1.0 - DARK_SHARE
        camera = Camera(float(rng.uniform(0.75, 1.1)) * width, (0.5 * width, 0.5 * height))
        state = self._state(camera, rng)
        sources: set[str] = set()
        scenery = self._scenery(is_wet, is_dark, float(state.position[2]) / 1000.0, rng, sources)
        hands = self.draw_pair(rng)
        sources |= {hand.source for hand in hands.values()}
        look = body_look(hands["left"], is_wet, BARE_ARM_SHARE, rng)
        if rng.random() < SINGLE_SHARE:
            del hands[SIDES[int(rng.integers(2))]]
        elif rng.random() < EMPTY_SHARE:
            if rng.random() < 0.5:
                return Composite(photograph(scenery.picture, rng), (), (), (), frozenset(sources))
            hands.clear()
        shown = {side: Shown([cutout], [1.0]) for side, cutout in hands.items()}
        picture = scenery.picture
        pasted, cover = draw_diver(picture, state, look, shown, camera, scenery.light, scenery.water)
        if scenery.water is not None:
            self._add_water_effects(picture, cover, state, camera, scenery.water, rng)
        kept = [hand for hand in pasted if hand.visible >= LEAST_VISIBLE]
        return Composite(
            photograph(picture, rng),
            tuple(hand.box for hand in kept),
            tuple(hands[hand.side].token for hand in kept),
            (head_box(state, camera),),
            frozenset(sources),
        )

    def _add_water_effects(
        self,
        picture: Float32,
        cover: Float32,
        state: DiverState,
        camera: Camera,
        water: Water,
        rng: np.random.Generator,
    ) -> None:
        """Now and then the diver's image in the surface, and bubbles from the mouth, over a linear picture."""
        time_s = float(rng.uniform(2.0, 60.0))
        if rng.random() < MIRRORED_SHARE:
            top = float(cover.max(axis=1).argmax())
            line = top - float(rng.uniform(-0.03, 0.1)) * cover.shape[0]
            mirror_in_surface(picture, cover, line, self._surroundings.ripples, time_s)
        if rng.random() < BUBBLE_SHARE:
            bubbles = Bubbles(float(rng.uniform(8.0, 45.0)), camera, rng)
            mouth = to_camera(np.array([MOUTH]), rotation_matrix(state.rotation), state.position)[0]
            bubbles.draw(picture, time_s, mouth, water)

    def _scenery(
        self, is_wet: bool, is_dark: bool, distance_m: float, rng: np.random.Generator, sources: set[str]
    ) -> Scenery:
        """Where the diver is: rendered or a real picture, some with things that stand about."""
        if rng.random() < RENDERED_SHARE:
            scenery = self._surroundings.dive(rng) if is_wet else self._surroundings.room(rng)
        else:
            coded = self._background(self._waters if is_wet else self._rooms, rng, sources)
            unit = float(rng.uniform(15.0, 60.0))
            self._put_things(coded, unit, rng, sources)
            picture = np.asarray(np.power(coded, np.float32(2.2)), np.float32)
            if is_wet:
                water = water_of_picture(picture, distance_m, rng)
                scenery = Scenery(picture, light_under_water(water, rng), water)
            else:
                scenery = Scenery(picture, light_of_room(picture, rng), None)
        return darken(scenery, rng, LAMP_SHARE) if is_dark else scenery

    def draw_pair(self, rng: np.random.Generator) -> dict[str, Cutout]:
        """Two hands of one person by the diver's sides, tokens as the diver shows them."""
        own = self._by_source[self._sources[int(rng.integers(len(self._sources)))]]
        first = own[int(rng.integers(len(own)))]
        is_other = rng.random() < OTHER_HAND_SHARE
        second = own[int(rng.integers(len(own)))] if is_other else first
        return {"right": self._turned(first, True, rng), "left": self._turned(second, False, rng)}

    def _turned(self, cutout: Cutout, is_right: bool, rng: np.random.Generator) -> Cutout:
        """A crop as one of the diver's hands; where the thumb does not decide the token it mostly points inwards."""
        if cutout.token in THUMB_TOKENS:
            # A right hand is the mirror image of a left one that shows the same.
            return replace(cutout.mirrored(), token=cutout.token) if is_right else cutout
        # The thumb of most crops points to image right, which is inwards on a right hand.
        is_inward = rng.random() < INWARD_SHARE
        return cutout if is_inward == is_right else cutout.mirrored()

    def _state(self, camera: Camera, rng: np.random.Generator) -> DiverState:
        """Where diver and hands are, so that the hands have the wanted size and lie about the picture."""
        width, height = self._size
        base = np.array([rng.uniform(*axis) for axis in WRIST_MM])
        if rng.random() < BEFORE_FACE_SHARE:
            base = np.array([rng.uniform(70.0, 140.0), rng.uniform(30.0, 160.0), rng.uniform(200.0, 300.0)])
        arms = []
        for sign in (1.0, -1.0):
            wrist = (base + rng.normal(0.0, APART_MM, 3)) * (sign, 1.0, 1.0)
            turn = np.array([0.0, 0.0, rng.normal(0.0, TURN_DEG)])
            arms.append(ArmState(wrist, turn, NO_POSE))
        share = float(np.exp(rng.uniform(*np.log(HAND_HEIGHT))))
        depth = HAND_LENGTH_MM * camera.focal / (share * height)
        # The hands' middle goes anywhere in the inner part of the picture.
        x = rng.uniform(-0.22, 0.22) * width * depth / camera.focal
        y = rng.uniform(-0.2, 0.3) * height * depth / camera.focal - base[1] - 0.4 * HAND_LENGTH_MM
        position = np.array([x, y, depth + base[2]])
        return DiverState(position, rng.normal(0.0, BODY_DEG), arms[0], arms[1])


def head_box(state: DiverState, camera: Camera) -> Box:
    """Where the diver's head is in the picture, also where something covers it, pixels."""
    place = to_camera(np.array([HEAD_MM]), rotation_matrix(state.rotation), state.position)
    (centre,), (px_per_mm,) = camera.project(place)
    half_width, half_height = (half * float(px_per_mm) for half in HEAD_HALF_MM)
    left, top = round(float(centre[0]) - half_width), round(float(centre[1]) - half_height)
    return left, top, round(2 * half_width), round(2 * half_height)


def body_look(hand: Cutout, is_wet: bool, bare_arms: float, rng: np.random.Generator) -> BodyLook:
    """Clothes for the owner of a hand; face and bare arms (a share `bare_arms`) have its colour."""
    regulator = is_wet and rng.random() < 0.5
    blue, green, red = (min(value * float(rng.uniform(0.75, 1.0)), 0.8) for value in skin_colour(hand))
    hair = rng.uniform(0.005, 0.12)
    suit = SUITS[int(rng.integers(len(SUITS)))]
    if rng.random() < 0.3:
        suit = (float(rng.uniform(0.01, 0.6)), float(rng.uniform(0.01, 0.6)), float(rng.uniform(0.01, 0.6)))
    return BodyLook(
        suit_bgr=suit,
        accent_bgr=ACCENTS[int(rng.integers(len(ACCENTS)))],
        skin_bgr=(blue, green, red),
        hood_bgr=(hair * 0.7, hair * 0.85, hair),
        mask_bgr=ACCENTS[int(rng.integers(len(ACCENTS)))] if rng.random() < 0.6 else (0.02, 0.02, 0.02),
        hood=is_wet and rng.random() < 0.5,
        mask=is_wet and rng.random() < 0.85,
        snorkel=is_wet and not regulator and rng.random() < 0.6,
        regulator=regulator,
        bare_arms=rng.random() < bare_arms,
    )


def photograph(picture: Float32, rng: np.random.Generator) -> Image:
    """A linear picture (used up) as a camera of changing quality keeps it: about as bright as it is."""
    level = float(np.clip(picture.mean(), 0.03, 0.5))
    look = CameraLook(
        target=level * float(rng.uniform(0.7, 1.3)),
        balance=float(rng.uniform(0.0, 0.4)),
        drift=0.0,
        shot=0.0006 * float(rng.uniform(0.2, 5.0)),
        read=0.004 * float(rng.uniform(0.2, 3.0)),
        blur_px=float(rng.uniform(0.0, 1.2)),
        motion_px=float(rng.uniform(2.0, 4.0)) if rng.random() < 0.15 else 0.0,
        jpeg=int(rng.integers(35, 96)) if rng.random() < 0.5 else 0,
    )
    return photographed(picture, look, rng)
