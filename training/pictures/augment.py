"""Altered copies of labelled hands: what the pictures of the training sources do not show.

None of the sources is under water or in a dark room, few show oblique hands, and every box is exact. The
copies turn, stretch and mirror the hand, exchange what stands behind it, put it under water or before a
bright window, and shift its box as a selector would.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image
from lightgesture.models import NONE
from lightgesture.training.pictures.cutouts import draw_hand
from lightgesture.training.pictures.light import LightSettings, relight
from lightgesture.training.pool.samples import LabelledHand, landmark_box

MIRRORED_TOKENS = {"left": "right", "right": "left"}
"""A mirrored thumb points the other way; every other sign keeps its name."""

UPRIGHT = {*MIRRORED_TOKENS, NONE}
"""What lying on its side may turn into something else: a thumb up becomes a thumb to the side."""
LYING: Final = (55.0, 100.0)
"""Degrees by which a hand is turned that lies on its side."""

Random = np.random.Generator


CANVAS: Final = 96
"""Side of a copy, pixels."""
REACH: Final = 1.7
"""Side of the canvas over the longer side of the hand's box, large enough for a shifted and enlarged box."""
NARROWEST: Final = 0.6
"""Least factor by which a copy's width shrinks, see `AugmentSettings.narrowed`."""
FINGER_WIDTH: Final = 0.3
"""Of the drawn mask over the palm's length; wider keeps a rim of the old background, narrower cuts fingers."""


@dataclass(frozen=True, slots=True)
class AugmentSettings:
    """How far copies go."""

    mirror: float = 0.5
    """Share of mirrored copies, 0 to 1."""
    rotation: float = 14.0
    """Standard deviation, degrees, 0 to 90."""
    lying: float = 0.0
    """Share of copies, 0 to 1, that lie on their side, of signs that are the same there."""
    stretch: float = 0.14
    """Standard deviation of the logarithm of the aspect, 0 to 0.5."""
    narrowed: float = 0.0
    """Share of copies, 0 to 1, whose width shrinks besides, as that of a hand turned about its long axis does."""
    shear: float = 0.10
    """Standard deviation, a share of the height, 0 to 0.5."""
    background: float = 0.5
    """Share of copies before another background, 0 to 1."""
    shift: float = 0.05
    """Standard deviation of the error of the box's place, a share of its side, 0 to 0.3."""
    scale: float = 0.08
    """Standard deviation of the logarithm of the error of the box's side, 0 to 0.3."""
    light: LightSettings = field(default_factory=LightSettings)
    """Of copies."""


MILD = AugmentSettings(
    rotation=6.0,
    stretch=0.05,
    shear=0.03,
    background=0.0,
    shift=0.02,
    scale=0.04,
    light=LightSettings(
        gamma=0.1,
        contrast=0.08,
        gain=0.03,
        gradient=0.1,
        dark=0.0,
        backlit=0.0,
        water=0.0,
        blur=0.15,
        widest_blur=0.8,
        noise=3.0,
    ),
)
"""How far copies go that stay near their picture: a net that sees nothing but hard copies reads easy ones less well."""


@dataclass(frozen=True, slots=True, eq=False)
class _Canvas:
    """A hand on a square canvas. landmarks: float32 (21, 2) or None. corners: float32 (4, 2), of its box."""

    image: Image
    corners: NDArray[np.float32]
    landmarks: NDArray[np.float32] | None


Finish = Callable[[Image, NDArray[np.float32] | None, Random], Image]
"""What is done to a copy at last: picture, mask of the hand where known, generator -> picture."""


def augment(
    hand: LabelledHand,
    backgrounds: Sequence[Image],
    settings: AugmentSettings,
    random: Random,
    finish: Finish | None = None,
) -> tuple[Image, Box, str]:
    """One altered copy: picture, uint8 (CANVAS, CANVAS, 3), box of the hand in it with an error, token.

    backgrounds: pictures at least a few pixels wide, of any size, to stand behind the hand. finish: instead of other
    light.
    """
    canvas = _turned(hand, settings, random)
    token = hand.token
    if random.random() < settings.mirror:
        canvas = _mirrored(canvas)
        token = MIRRORED_TOKENS.get(token, token)
    mask = None
    image = canvas.image
    if canvas.landmarks is not None:
        mask = hand_mask(canvas.landmarks, CANVAS, FINGER_WIDTH)
        if len(backgrounds) and random.random() < settings.background:
            image = _before(image, mask, backgrounds[int(random.integers(len(backgrounds)))], random)
    image = relight(image, mask, settings.light, random) if finish is None else finish(image, mask, random)
    return image, shifted_box(_box(canvas), settings, random), token


def hand_mask(landmarks: NDArray[np.float32], size: int, finger_width: float) -> NDArray[np.float32]:
    """Soft mask of a hand and the beginning of its arm, float32 (size, size), 1 inside; landmarks (21, 2)."""
    mask = draw_hand((size, size), landmarks, finger_width)
    wrist, knuckle = landmarks[0], landmarks[9]
    # The arm goes on from the wrist away from the middle knuckle, so that no hand floats on a stump.
    end = np.rint(2 * wrist - knuckle).astype(int)
    width = max(1, round(0.5 * float(np.linalg.norm(landmarks[5] - landmarks[17]))))
    cv2.line(mask, np.rint(wrist).astype(int).tolist(), end.tolist(), 255, 2 * width)
    return np.asarray(cv2.GaussianBlur(mask, (5, 5), 0), np.float32) / np.float32(255)


def shifted_box(box: Box, settings: AugmentSettings, random: Random) -> Box:
    """The box as a selector might give it: shifted, and each side scaled on its own as well as both."""
    x, y, width, height = box
    common = random.normal(0.0, settings.scale)
    scales = np.exp(common + random.normal(0.0, 0.5 * settings.scale, 2))
    shift = random.normal(0.0, settings.shift, 2) * max(width, height)
    new_width, new_height = max(2, round(width * scales[0])), max(2, round(height * scales[1]))
    centre_x, centre_y = x + width / 2 + shift[0], y + height / 2 + shift[1]
    return round(centre_x - new_width / 2), round(centre_y - new_height / 2), new_width, new_height


def _turned(hand: LabelledHand, settings: AugmentSettings, random: Random) -> _Canvas:
    """The hand turned, stretched and sheared about the middle of its box, drawn on the canvas."""
    x, y, width, height = hand.box
    angle = np.deg2rad(random.normal(0.0, settings.rotation))
    if settings.lying and hand.token not in UPRIGHT and random.random() < settings.lying:
        angle += np.deg2rad(random.uniform(*LYING) * random.choice((-1.0, 1.0)))
    aspect = np.exp(random.normal(0.0, settings.stretch))
    if settings.narrowed and random.random() < settings.narrowed:
        aspect *= random.uniform(NARROWEST, 1.0)
    shear = random.normal(0.0, settings.shear)
    zoom = CANVAS / (REACH * max(width, height))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    matrix = zoom * turn @ np.array([[np.sqrt(aspect), shear], [0.0, 1 / np.sqrt(aspect)]])
    centre = np.array([x + width / 2, y + height / 2])
    offset = CANVAS / 2 - matrix @ centre
    affine = np.hstack([matrix, offset[:, None]])
    size = (CANVAS, CANVAS)
    image = cv2.warpAffine(hand.image, affine, size, flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    corners = np.array([[x, y], [x + width, y], [x, y + height], [x + width, y + height]])
    landmarks = None if hand.landmarks is None else (hand.landmarks @ matrix.T + offset).astype(np.float32)
    return _Canvas(np.asarray(image, np.uint8), (corners @ matrix.T + offset).astype(np.float32), landmarks)


def _mirrored(canvas: _Canvas) -> _Canvas:
    last = canvas.image.shape[1] - 1
    flip, move = np.float32([-1, 1]), np.float32([last, 0])  # type: ignore[arg-type]
    landmarks = None if canvas.landmarks is None else canvas.landmarks * flip + move
    return _Canvas(np.ascontiguousarray(canvas.image[:, ::-1]), canvas.corners * flip + move, landmarks)


def _box(canvas: _Canvas) -> Box:
    """Box of the turned hand: exact from landmarks, else a box of the first one's size about its corners' middle."""
    if canvas.landmarks is not None:
        return landmark_box(canvas.landmarks)
    low, high = canvas.corners.min(axis=0), canvas.corners.max(axis=0)
    return (
        round(float(low[0])),
        round(float(low[1])),
        round(float(high[0] - low[0])),
        round(float(high[1] - low[1])),
    )


def _before(image: Image, mask: NDArray[np.float32], background: Image, random: Random) -> Image:
    """The hand before a random part of another picture."""
    size = image.shape[0]
    rows, columns = background.shape[:2]
    side = max(2, int(min(rows, columns) * random.uniform(0.25, 1.0)))
    top, left = random.integers(rows - side + 1), random.integers(columns - side + 1)
    part = cv2.resize(
        background[top : top + side, left : left + side], (size, size), interpolation=cv2.INTER_AREA
    )
    if random.random() < 0.5:
        part = part[:, ::-1]
    blended = part + mask[..., None] * (image.astype(np.float32) - part)
    return blended.astype(np.uint8)
