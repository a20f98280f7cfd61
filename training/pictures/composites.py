"""Pictures of two-handed people composed for training: real hands, drawn bodies, any water or room.

Whole pictures of bare-handed divers hardly exist, so cut-out hands are put in pairs on drawn arms, suits and
heads before real backgrounds, and the whole goes through water or into a dark, back-lit room.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np

from lightgesture.features.types import Box, Float, Image
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.drawn import draw_body, lamp_spots, put_decoys, put_structures
from lightgesture.training.pictures.light import attenuate, expose

SIZE: Final = (320, 240)
"""Width and height of a composed picture, pixels."""
HAND_HEIGHT: Final = (0.09, 0.42)
"""Least and most height of an upright hand over the picture's height, drawn evenly in the logarithm."""
SPREAD: Final = (0.8, 2.4)
"""Distance of the hands from the body's axis in hand heights."""
LIFT: Final = (-0.5, 1.6)
"""Height of the hands over the shoulders in hand heights."""
WATER_SHARE: Final = 0.45
"""Of pictures, those under water."""
DARK_SHARE: Final = 0.3
"""Those in a dark room."""
LAMP_SHARE: Final = 0.4
"""Of dark pictures, those with a spot of light on something else."""
SINGLE_SHARE: Final = 0.2
"""Of pictures, those with one hand."""
EMPTY_SHARE: Final = 0.15
"""Of the others, those in which nobody shows a hand, in every second because nobody is there."""
OTHER_HAND_SHARE: Final = 0.5
"""Of pictures, those whose two hands show different signs."""
BARE_ARM_SHARE: Final = 0.35
"""Those with bare forearms."""
STRUCTURE_SHARE: Final = 0.3
"""Those with poles, gates or boxes such as stand in test pools."""
DECOYS: Final = 4
"""Most objects of another picture, often red or skin-coloured, that stand about."""


@dataclass(frozen=True, slots=True, eq=False)
class Background:
    """image: uint8 (h, w, 3) BGR, without a hand. source: the person, room and camera it comes from."""

    image: Image
    source: str


@dataclass(frozen=True, slots=True, eq=False)
class Composite:
    """image: uint8 (h, w, 3) BGR. boxes: outlines of the hands. tokens: one for each box. faces: boxes of heads that
    face the camera, also where a hand covers them; those of a background are not known. sources: whose pictures
    the hands and the background are, so that they can be held out."""

    image: Image
    boxes: tuple[Box, ...]
    tokens: tuple[str, ...]
    faces: tuple[Box, ...]
    sources: frozenset[str]


def paste(
    canvas: Float, cutout: Cutout, centre: tuple[float, float], height: float, turn: float, blur: float = 0.0
) -> Box | None:
    """Put a hand on the canvas (values 0 to 1), `height` pixels high and turned by `turn` degrees; the box
    of what can be seen of it, None where that is less than two thirds. blur: its standard deviation, pixels."""
    x, y, w, h = cutout.box
    scale = height / max(h, 0.75 * w)
    matrix = cv2.getRotationMatrix2D((x + w / 2, y + h / 2), turn, scale)
    matrix[:, 2] += np.array([centre[0] - x - w / 2, centre[1] - y - h / 2])
    size = canvas.shape[1], canvas.shape[0]
    alpha = np.asarray(cv2.warpAffine(cutout.alpha, matrix, size, flags=cv2.INTER_AREA), np.float32)
    image = np.asarray(cv2.warpAffine(cutout.image, matrix, size, flags=cv2.INTER_AREA), np.float32) / 255.0
    if blur:
        alpha = np.asarray(cv2.GaussianBlur(alpha, (0, 0), blur), np.float32)
        image = np.asarray(cv2.GaussianBlur(image, (0, 0), blur), np.float32)
    canvas += alpha[..., None] * (image - canvas)
    visible = (alpha > 0.5).astype(np.uint8)
    if visible.sum() < 0.67 * (cutout.alpha > 0.5).sum() * scale * scale:
        return None
    left, top, width, tall = cv2.boundingRect(visible)
    return left, top, width, tall


def _inside(value: float, size: int, margin: float) -> float:
    """`value` moved to at least `margin` from both ends of 0 to `size`."""
    return min(max(value, margin), max(size - margin, margin))


def _shown(hands: Sequence[Cutout], rng: np.random.Generator) -> list[Cutout | None]:
    """Of the two hands those that are shown: now and then one alone, or none."""
    if rng.random() < SINGLE_SHARE:
        return [None, hands[1]]
    if rng.random() < EMPTY_SHARE:
        return [None, None]
    return [*hands]


class Composer:
    """Draws pictures without end from hands and backgrounds."""

    def __init__(
        self,
        cutouts: Sequence[Cutout],
        waters: Sequence[Background],
        rooms: Sequence[Background],
        size: tuple[int, int] = SIZE,
    ) -> None:
        """cutouts: at least one. waters, rooms: backgrounds; either may be empty, not both. size: (width, height)."""
        self._by_source: dict[str, list[Cutout]] = {}
        for cutout in cutouts:
            self._by_source.setdefault(cutout.source, []).append(cutout)
        self._sources = sorted(self._by_source)
        self._waters = list(waters) or list(rooms)
        self._rooms = list(rooms) or list(waters)
        self._size = size

    def _background(
        self, pictures: Sequence[Background], rng: np.random.Generator, sources: set[str]
    ) -> Float:
        """Part of one of the pictures at the composite's size, values 0 to 1; its source is added to `sources`."""
        background = pictures[int(rng.integers(len(pictures)))]
        sources.add(background.source)
        picture = background.image
        height, width = picture.shape[:2]
        share = rng.uniform(0.5, 1.0)
        wide, tall = max(2, int(width * share)), max(2, int(height * share))
        x, y = rng.integers(0, width - wide + 1), rng.integers(0, height - tall + 1)
        part = cv2.resize(picture[y : y + tall, x : x + wide], self._size, interpolation=cv2.INTER_AREA)
        if rng.random() < 0.5:
            part = part[:, ::-1]
        return np.asarray(part, np.float32) / np.float32(255.0)

    def _put_things(self, canvas: Float, unit: float, rng: np.random.Generator, sources: set[str]) -> None:
        """What stands about and is no hand, where a hand is `unit` pixels high; used pictures go into `sources`."""
        put_decoys(canvas, unit, DECOYS, lambda: self._background(self._rooms, rng, sources), rng)
        if rng.random() < STRUCTURE_SHARE:
            put_structures(canvas, unit, rng)

    def _hands(self, rng: np.random.Generator) -> list[Cutout]:
        """Two hands of one person, image-left first: the second is the mirror image of a left hand."""
        own = self._by_source[self._sources[rng.integers(len(self._sources))]]
        first = own[rng.integers(len(own))]
        second = own[rng.integers(len(own))] if rng.random() < OTHER_HAND_SHARE else first
        hands = [first.mirrored(), second]
        return hands if rng.random() < 0.5 else [second.mirrored(), first]

    def compose(self, rng: np.random.Generator) -> Composite:
        """One picture; the same state of `rng` gives the same pixels on one machine and version."""
        draw = rng.random()
        wet, dark = draw < WATER_SHARE, draw > 1.0 - DARK_SHARE
        sources: set[str] = set()
        canvas = self._background(self._waters if wet else self._rooms, rng, sources)
        if not wet and rng.random() < 0.3:
            canvas = np.asarray(cv2.GaussianBlur(canvas, (0, 0), rng.uniform(0.5, 4.0)), np.float32)
        width, height = self._size
        unit = float(height * np.exp(rng.uniform(*np.log(HAND_HEIGHT))))
        self._put_things(canvas, unit, rng, sources)
        axis, shoulder = rng.uniform(0.3, 0.7) * width, rng.uniform(0.3, 0.85) * height
        hands = self._hands(rng)
        sources |= {hand.source for hand in hands}
        shown = _shown(hands, rng)
        places = self._places(axis, shoulder, unit, rng)
        chosen = [(hand, place) for hand, place in zip(shown, places, strict=True) if hand is not None]
        person = canvas.copy()
        faces: tuple[Box, ...] = ()
        if chosen or rng.random() < 0.5:
            wrists = [(x, y + 0.35 * unit) for _, (x, y) in chosen]
            skin = hands[0].image[hands[0].alpha > 0.9].mean(axis=0).astype(np.float32) / 255.0
            faces = (draw_body(person, axis, shoulder, unit, wrists, skin, BARE_ARM_SHARE, rng),)
        boxes, tokens = [], []
        for hand, place in chosen:
            box = paste(person, hand, place, unit * rng.uniform(0.85, 1.15), rng.normal(0, 10))
            if box is not None:
                boxes.append(box)
                tokens.append(hand.token)
        if wet:
            person = self._submerge(person, canvas, rng)
        elif dark:
            person = self._darken(person, canvas, rng)
        return Composite(expose(person, rng), tuple(boxes), tuple(tokens), faces, frozenset(sources))

    def _places(
        self, axis: float, shoulder: float, unit: float, rng: np.random.Generator
    ) -> list[tuple[float, float]]:
        """Middles of the image-left and the image-right hand, about as high and as far out as one another."""
        (width, height), lift, spread = self._size, rng.uniform(*LIFT), rng.uniform(*SPREAD)
        places = []
        for sign in (-1.0, 1.0):
            x = axis + sign * unit * (spread + rng.normal(0, 0.2))
            y = shoulder - unit * (lift + rng.normal(0, 0.25))
            places.append((_inside(x, width, 0.4 * unit), _inside(y, height, 0.4 * unit)))
        return places

    @staticmethod
    def _submerge(person: Float, background: Float, rng: np.random.Generator) -> Float:
        """The person takes on the colour of water that is already in the background, or all goes under."""
        if rng.random() < 0.3:
            return attenuate(person, rng)
        changed = (np.abs(person - background).max(axis=2) > 1e-3).astype(np.float32)[..., None]
        mean = background.reshape(-1, 3).mean(axis=0)
        pull = np.array([rng.uniform(0.1, 0.6), rng.uniform(0.1, 0.6), rng.uniform(0.3, 0.9)], np.float32)
        tinted = person * (1.0 - pull) + pull * mean * (0.4 + person)
        return np.asarray(background + changed * (tinted - background), np.float32)

    @staticmethod
    def _darken(person: Float, background: Float, rng: np.random.Generator) -> Float:
        """A person against the light: far darker than lamps and windows, about as dark as the room."""
        changed = (np.abs(person - background).max(axis=2) > 1e-3).astype(np.float32)[..., None]
        light = rng.uniform(0.02, 0.22)
        room = np.power(background, 2.2) * rng.uniform(0.05, 0.3)
        if rng.random() < LAMP_SHARE:
            room *= lamp_spots(room.shape[:2], rng)[..., None]
        glow = np.power(background, 2.2) * (background.min(axis=2, keepdims=True) > rng.uniform(0.6, 0.95))
        room = np.maximum(room, glow)
        shaded = np.power(person, 2.2) * light
        return np.asarray(np.power(room + changed * (shaded - room), 1 / 2.2), np.float32)
