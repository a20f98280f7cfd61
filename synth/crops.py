"""Single labelled hands for training a classifier, in the form of real collections of hand crops.

Each sample is a square picture around one upright hand, its side 1.6 times the larger side of the box round the 21
landmarks. `left` and `right` say where the thumb points in the picture, whichever hand and face it is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.atlas import paint_atlas
from lightgesture.synth.camera import draw_camera, photographed
from lightgesture.synth.crop_surroundings import draw_surroundings, draw_water, part_of, window_of
from lightgesture.synth.hand import Box, HandImage, HandLook, render_hand
from lightgesture.synth.poses import (
    OTHER_SHAPES,
    SIDE_THUMB_TOKENS,
    TOKEN_LEAN_DEG,
    TOKEN_YAW_DEG,
    TOKENS,
    shows_palm,
    token_pose,
)
from lightgesture.synth.raster import Float32
from lightgesture.synth.shading import draw_light
from lightgesture.synth.skeleton import (
    FloatArray,
    HandPose,
    rotation_x,
    rotation_y,
    rotation_z,
    sample_proportions,
)
from lightgesture.synth.skin import glove_tone, skin_tone
from lightgesture.synth.surface import Forearm, HandView
from lightgesture.synth.variety import GLOVES, SUITS, Purpose, stream
from lightgesture.synth.views import PosedHand
from lightgesture.synth.water import Water

NONE = "none"
SIDE_THUMB_PITCH = 1.7
"""People tilt a fist with a stretched thumb more than other signs, because the forearm comes from the side."""
MARGIN = 1.6
"""Side of a crop against the larger side of the landmark box."""
PALM_SHARE: Final = 0.85
"""Share of palms among tokens other than left and right; the others show the back."""
GLOVE_SHARE: Final = 0.25
"""Share of gloved hands."""
NONE_SHARE: Final = 0.1
"""Share of shapes that are no token."""
TURN_DEG: Final = (15.0, 55.0)
"""How much further a ring that is seen from the side is turned, see `CropSettings.sideways`."""
LOOSENESS: Final = (0.4, 1.4)
"""See `poses.token_pose`."""
PX_PER_MM: Final = 0.62
"""Scale at which hands are rendered, doubled in between (`hand.SUPERSAMPLED_LENGTH_PX`)."""
QUICK_PX_PER_MM: Final = 0.88
"""Scale of posed hands: just so large that they are not doubled, half of the pixels."""
BACKDROPS: Final = 16
"""Surroundings of each kind, drawn once."""


@dataclass(frozen=True, slots=True)
class CropSettings:
    """How samples vary."""

    size: tuple[int, int] = (40, 112)
    """Smallest and largest side of a crop, pixels."""
    yaw: float = 20.0
    """Turn of the hand about its long axis: standard deviation, degrees, 0 to 60."""
    pitch: float = 14.0
    """Tilt towards the camera: standard deviation, degrees, 0 to 45."""
    roll: float = 13.0
    """Lean within the picture: standard deviation, degrees, 0 to 90."""
    sideways: float = 0.0
    """Share, 0 to 1, of rings of thumb and index that are turned further about their long axis, until the other fingers
    stand behind one another."""
    together: float = 0.0
    """Share, 0 to 1, of hands whose stretched fingers lie side by side."""
    backdrops: int = BACKDROPS
    """Surroundings of each kind, drawn once, 1 or more; a pair takes as long as ten hands."""
    atlases: int = 0
    """Textures of skin, and as many of gloves, that hands share, drawn once; 0: each has its own, which takes a third
    longer."""


@dataclass(frozen=True, slots=True)
class Crop:
    """image: uint8 (n, n, 3) BGR. token: one of the ten or "none". box: outline of the hand, pixels of `image`.
    landmarks: (21, 2), pixels. left: a left hand. palm: its palm is seen. cover: float32 (n, n), 0..1, of hand and arm.
    """

    image: NDArray[np.uint8]
    token: str
    box: Box
    landmarks: FloatArray
    left: bool
    palm: bool
    cover: Float32


class CropMaker:
    """Draws crops from one stream; `sample(token)` for one, `samples(count)` for a balanced stream."""

    def __init__(self, seed: int, purpose: Purpose = "train", settings: CropSettings | None = None) -> None:
        self.settings = settings or CropSettings()
        self._rng = stream(seed, purpose)
        self._rooms, self._dives = draw_surroundings(self._rng, self.settings.backdrops)
        self._atlases = [
            [paint_atlas(self._rng, glove) for _ in range(self.settings.atlases)] for glove in (False, True)
        ]

    def samples(self, count: int) -> Iterator[Crop]:
        """`count` crops, tokens in turn, with a share of `none` strewn in."""
        for index in range(count):
            if self._rng.uniform() < NONE_SHARE:
                yield self.sample(NONE)
            else:
                yield self.sample(TOKENS[index % len(TOKENS)])

    def sample(self, token: str) -> Crop:
        """One crop of a token, or of a shape outside the language for "none"."""
        rng, settings = self._rng, self.settings
        shape = str(rng.choice(list(OTHER_SHAPES))) if token == NONE else token
        left = bool(rng.uniform() < 0.5)
        palm = bool(rng.uniform() < PALM_SHARE)
        if token in SIDE_THUMB_TOKENS:
            palm = shows_palm(token, left, token == SIDE_THUMB_TOKENS[0])
        water = draw_water(self._rng)
        hand = self._render(shape, left, palm, water)
        side = int(rng.integers(settings.size[0], settings.size[1] + 1))
        return self._framed(hand, token, side, left, palm, water)

    def posed(self, hand: PosedHand, *, dry: bool = False, place: NDArray[np.uint8] | None = None) -> Crop:
        """One crop of a hand with known joints, as it is turned; dry: never seen through water. place: picture, BGR,
        part of which is behind the hand, in place of a rendered one."""
        rng, settings = self._rng, self.settings
        water = None if dry else draw_water(self._rng)
        look, arm = self._draw_look()
        view = self._view(hand.rotation, hand.left, QUICK_PX_PER_MM)
        image = self._seen(hand.pose, view, look, arm, water)
        side = int(rng.integers(settings.size[0], settings.size[1] + 1))
        palm = bool(hand.rotation[2, 2] > 0.0)
        return self._framed(image, hand.token, side, hand.left, palm, water, place)

    def _render(self, shape: str, left: bool, palm: bool, water: Water | None) -> HandImage:
        rng, settings = self._rng, self.settings
        look, arm = self._draw_look()
        yaw = TOKEN_YAW_DEG.get(shape, 0.0) + rng.normal(0.0, settings.yaw) + (0.0 if palm else 180.0)
        if shape in TOKEN_YAW_DEG and settings.sideways and rng.uniform() < settings.sideways:
            yaw += rng.uniform(*TURN_DEG)
        sign = -1.0 if left else 1.0
        lean = TOKEN_LEAN_DEG.get(shape, 0.0) * (-1.0 if left == palm else 1.0)
        rotation = (
            rotation_z(rng.normal(0.0, settings.roll) - lean)
            @ rotation_x(
                rng.normal(0.0, settings.pitch * (SIDE_THUMB_PITCH if shape in SIDE_THUMB_TOKENS else 1.0))
            )
            @ rotation_y(sign * yaw)
        )
        view = self._view(rotation, left)
        together = settings.together > 0.0 and bool(rng.uniform() < settings.together)
        pose = token_pose(shape, rng, float(rng.uniform(*LOOSENESS)), together=together)
        return self._seen(pose, view, look, arm, water)

    def _draw_look(self) -> tuple[HandLook, Forearm]:
        """Somebody's hand, bare or in a glove, and the sleeve below."""
        rng = self._rng
        if rng.uniform() < GLOVE_SHARE:
            tone = glove_tone(GLOVES[int(rng.integers(len(GLOVES)))])
        else:
            tone = skin_tone(
                float(rng.uniform(1.0, 9.5)), float(rng.uniform(0.3, 1.8)), float(rng.uniform(0.1, 0.9))
            )
        sleeve = SUITS[int(rng.integers(len(SUITS)))]
        look = HandLook(sample_proportions(rng), tone, self._atlas(tone.glove), sleeve)
        bare = None if rng.uniform() < 0.5 else float(rng.uniform(5.0, 80.0))
        return look, Forearm(110.0, bare)

    def _atlas(self, glove: bool) -> NDArray[np.uint8]:
        shared = self._atlases[glove]
        return shared[int(self._rng.integers(len(shared)))] if shared else paint_atlas(self._rng, glove)

    def _view(self, rotation: FloatArray, left: bool, px_per_mm: float = PX_PER_MM) -> HandView:
        return HandView(rotation, (0.0, 0.0), px_per_mm, float(self._rng.uniform(350.0, 1500.0)), left)

    def _seen(
        self, pose: HandPose, view: HandView, look: HandLook, arm: Forearm, water: Water | None
    ) -> HandImage:
        """The hand in some light, through the water before it."""
        rng = self._rng
        hand = render_hand(pose, view, look, draw_light(rng, water), arm)
        if water is None:
            return hand
        return replace(
            hand, radiance=water.see_through(hand.radiance, hand.alpha, float(rng.uniform(0.4, 1.6)))
        )

    def _framed(
        self,
        hand: HandImage,
        token: str,
        side: int,
        left: bool,
        palm: bool,
        water: Water | None,
        place: NDArray[np.uint8] | None = None,
    ) -> Crop:
        rng = self._rng
        low, high = hand.landmarks[:, :2].min(axis=0), hand.landmarks[:, :2].max(axis=0)
        extent = MARGIN * float((high - low).max())
        corner = 0.5 * (low + high) - 0.5 * extent + rng.normal(0.0, 0.02, 2) * extent
        whole = round(extent)
        shifted = replace(hand, origin=(hand.origin[0] - round(corner[0]), hand.origin[1] - round(corner[1])))
        if place is None:
            picture = window_of(self._rooms if water is None else self._dives, water, whole, rng)
        else:
            picture = part_of(place, whole, rng)
        shifted.paste(picture)
        scale = side / whole
        interpolation = cv2.INTER_AREA if scale < 1.0 else cv2.INTER_LINEAR
        picture = np.asarray(cv2.resize(picture, (side, side), interpolation=interpolation), np.float32)
        cover = np.zeros((whole, whole), np.float32)
        shifted.cover(cover)
        cover = np.asarray(cv2.resize(cover, (side, side), interpolation=interpolation), np.float32)
        image = photographed(picture, draw_camera(rng), rng)
        offset = (-round(corner[0]), -round(corner[1]))
        x, y, width, height = hand.box
        box = (
            round((x + offset[0]) * scale), round((y + offset[1]) * scale),
            max(round(width * scale), 1), max(round(height * scale), 1),
        )  # fmt: skip
        landmarks = (hand.landmarks[:, :2] + np.array(offset)) * scale
        return Crop(image, token, box, landmarks, left, palm, cover)
