"""Copies of hands before other places, and regions in other light."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import cv2
import numpy as np

from lightgesture.features.types import Image
from lightgesture.training.pictures.augment import CANVAS, MIRRORED_TOKENS, AugmentSettings, Finish, augment
from lightgesture.training.pictures.light import LightSettings, relight
from lightgesture.training.pool.originals import Originals
from lightgesture.training.pool.samples import LabelledHand
from lightgesture.training.samples import TrainingSample

Random = np.random.Generator


def altered(
    originals: Originals,
    hands: Sequence[LabelledHand],
    settings: AugmentSettings,
    random: Random,
    finish: Finish | None = None,
) -> Iterator[TrainingSample]:
    """A copy of each hand; finish: what is done to its picture in place of other light."""
    pictures = behind(originals)
    tokens = {hand.token for hand in originals.hands}
    unmirrored = replace(settings, mirror=0.0)
    for hand in hands:
        known = MIRRORED_TOKENS.get(hand.token, hand.token) in tokens
        copy = augment(hand, pictures, settings if known else unmirrored, random, finish)
        yield TrainingSample(
            image=copy.image,
            box=copy.box,
            side=hand.side,
            token=copy.token,
            source=hand.source,
            original=False,
            landmarks=copy.landmarks,
        )


def behind(originals: Originals) -> list[Image]:
    """What may stand behind a hand: water and rooms, or where there is neither, what stands behind other hands."""
    scenes = [scene.image for scene in (*originals.backgrounds, *originals.scenes, *originals.divers.scenes)]
    return scenes or [one.image for one in originals.hands]


def relit(region: TrainingSample, light: LightSettings, random: Random) -> TrainingSample:
    """A region cut out with something around it and in other light."""
    x, y, width, height = region.box
    reach = max(width, height)
    rows, columns = region.image.shape[:2]
    left, top = max(0, x - reach), max(0, y - reach)
    part = region.image[top : min(rows, y + height + reach), left : min(columns, x + width + reach)]
    scale = min(1.0, 1.5 * CANVAS / max(part.shape[:2]))
    if scale < 1.0:
        part = np.asarray(cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)
    box = (
        round((x - left) * scale),
        round((y - top) * scale),
        max(2, round(width * scale)),
        max(2, round(height * scale)),
    )
    image = relight(part, None, light, random)
    landmarks = region.landmarks
    if landmarks is not None:
        landmarks = ((landmarks + 0.5 - (left, top)) * scale - 0.5).astype(np.float32)
    return replace(region, image=image, box=box, original=False, landmarks=landmarks)
