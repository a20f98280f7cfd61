"""Real divers for nets that look for hands: as they are, or with other hands in the place of theirs.

A thousand pictures of real divers show a hundred signs. Their hands at rest hang where signs would be shown, before
real suits, hoses and water: put there in the colour and sharpness of the hand that it covers, a dry hand's sign looks
like a sign of that dive.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from lightgesture.features.types import Box, Float, Image
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.composites import paste
from lightgesture.training.pictures.cutouts import Cutout

Random = np.random.Generator

SIGN_SHARE: Final = 0.3
"""Of the pictures drawn, those in which a sign is shown, which are a tenth of all."""
CHANGED_SHARE: Final = 0.5
"""Of the pictures drawn, those whose hands may be changed."""
CHANGED_HANDS: Final = 0.7
"""Of the hands in these, those that are."""
SIZE: Final = (0.9, 1.35)
"""Size of the new hand over the one that it covers."""
TURN: Final = 25.0
"""Standard deviation of its turn, degrees."""
SHADING: Final = (0.25, 0.8)
"""Exponent of its own shading: less of it is left the more water lies before it."""
BRIGHTNESS: Final = 0.3
"""Standard deviation of the logarithm of its brightness over that of the hand that it covers."""
COLOUR: Final = 0.06
"""Standard deviation of the logarithm of each channel's."""
BLUR: Final = (0.3, 1.3)
"""Standard deviation of its blur, pixels."""
REACH: Final = 2.2
"""Side of the part of the picture that is touched, over the hand's."""


@dataclass(frozen=True, slots=True, eq=False)
class RealDiver:
    """picture: of a real diver. shows_sign: whether one of its hands shows a sign."""

    picture: BoxedPicture
    shows_sign: bool


class RealDivers:
    """Draws pictures of real divers without end."""

    def __init__(self, divers: Sequence[RealDiver], hands: Sequence[Cutout]) -> None:
        """divers, hands: at least one each."""
        self.pictures = [one.picture for one in divers]
        self._signs = [place for place, one in enumerate(divers) if one.shows_sign]
        self._hands = hands

    def draw(self, rng: Random) -> tuple[int, BoxedPicture]:
        """One picture and its number in `pictures`; signs often, every second with changed hands."""
        place = int(rng.integers(len(self.pictures)))
        if self._signs and rng.random() < SIGN_SHARE:
            place = self._signs[int(rng.integers(len(self._signs)))]
        picture = self.pictures[place]
        if picture.boxes and rng.random() < CHANGED_SHARE:
            picture = with_other_hands(picture, self._hands, rng)
        return place, picture


def with_other_hands(picture: BoxedPicture, hands: Sequence[Cutout], rng: Random) -> BoxedPicture:
    """The picture with some of its hands covered by others."""
    image = picture.image.copy()
    boxes = []
    for box in picture.boxes:
        new = None
        if rng.random() < CHANGED_HANDS:
            hand = hands[int(rng.integers(len(hands)))]
            new = _cover(image, box, hand.mirrored() if rng.random() < 0.5 else hand, rng)
        boxes.append(box if new is None else new)
    return replace(picture, image=image, boxes=tuple(boxes))


def _cover(image: Image, box: Box, hand: Cutout, rng: Random) -> Box | None:
    """Put a hand over another, whose box it is; the new box, None where it does not show."""
    x, y, width, height = box
    side = max(width, height)
    rows, columns = image.shape[:2]
    left, top = (
        max(0, round(x + width / 2 - REACH * side / 2)),
        max(0, round(y + height / 2 - REACH * side / 2)),
    )
    right, bottom = min(columns, left + round(REACH * side)), min(rows, top + round(REACH * side))
    down, across = height // 4, width // 4
    middle = image[
        max(0, y + down) : max(1, y + height - down), max(0, x + across) : max(1, x + width - across)
    ]
    if right - left < 8 or bottom - top < 8 or not middle.size:
        return None
    part = image[top:bottom, left:right]
    canvas = part.astype(np.float32) / np.float32(255.0)
    dressed = _coloured(hand, middle.reshape(-1, 3).mean(axis=0) / 255.0, rng)
    centre = x + width / 2 - left, y + height / 2 - top
    found = paste(
        canvas, dressed, centre, side * rng.uniform(*SIZE), rng.normal(0.0, TURN), rng.uniform(*BLUR)
    )
    if found is None:
        return None
    part[:] = np.clip(canvas * 255.0, 0.0, 255.0).astype(np.uint8)
    return found[0] + left, found[1] + top, found[2], found[3]


def _coloured(hand: Cutout, colour: Float, rng: Random) -> Cutout:
    """The hand in a dive's colour (blue, green, red, 0 to 1) with a part of its own shading."""
    brightness = hand.image.astype(np.float32).mean(axis=2)
    level = max(float((brightness * hand.alpha).sum() / max(float(hand.alpha.sum()), 1.0)), 1.0)
    shading = np.power(np.maximum(brightness / level, 0.05), rng.uniform(*SHADING))[..., None]
    gains = np.exp(rng.normal(0.0, BRIGHTNESS) + rng.normal(0.0, COLOUR, 3))
    seen = np.clip(shading * np.maximum(colour, 0.01) * gains * 255.0, 0.0, 255.0)
    return replace(hand, image=seen.astype(np.uint8))
