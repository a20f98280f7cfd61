"""What a pool of patches is made of: copies of hands, hidden hands, regions that are no hand, rendered hands."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.types import Image
from lightgesture.models import NONE, TrainingSample
from lightgesture.training.pictures.augment import CANVAS, MILD, MIRRORED_TOKENS, AugmentSettings, augment
from lightgesture.training.pictures.hidden_hands import hide
from lightgesture.training.pictures.light import relight
from lightgesture.training.pool.negatives import NegativeSettings, Scene, missed_hand, negatives
from lightgesture.training.pool.samples import LabelledHand
from lightgesture.training.pool.synthetic import synthetic_hands

Random = np.random.Generator


@dataclass(frozen=True, slots=True)
class PoolSettings:
    """How much is drawn and how.

    copies: altered copies of each hand, 1 to 100. mild_share: copies of each hand besides that are hardly altered, over
    `copies`, 0 to 1. rounds: how often regions that are no hand are drawn from each picture. hidden: share of the
    rounds in which a copy of each hand is added of which too little is seen, 0 to 1.
    patch: of the net. margin: pixels that are kept on each side of a patch, by which it is shifted in training.
    contour: numbers of the outline, which go with each patch. rendered: number of rendered hands. augment, mild,
    negative: how copies, mild copies and regions are made.
    """

    copies: int = 24
    mild_share: float = 1 / 3
    rounds: int = 8
    hidden: float = 0.5
    patch: PatchSettings = field(default_factory=PatchSettings)
    margin: int = 2
    contour: ContourSettings = field(default_factory=ContourSettings)
    rendered: int = 12000
    augment: AugmentSettings = field(
        default_factory=lambda: AugmentSettings(
            rotation=18.0, scale=0.11, shift=0.06, narrowed=0.2, background=0.6
        )
    )
    mild: AugmentSettings = MILD
    negative: NegativeSettings = field(default_factory=NegativeSettings)

    @property
    def mild_copies(self) -> int:
        """Of each hand."""
        return round(self.mild_share * self.copies)

    @property
    def kept(self) -> PatchSettings:
        """A patch with its margin."""
        size = self.patch.size + 2 * self.margin
        return PatchSettings(size, self.patch.context * size / self.patch.size)


@dataclass(frozen=True, slots=True, eq=False)
class Originals:
    """What copies are made of. hands: labelled. backgrounds: pictures without hands. scenes: whole pictures."""

    hands: Sequence[LabelledHand]
    backgrounds: Sequence[Scene] = ()
    scenes: Sequence[Scene] = ()


Draw = Callable[[Originals, PoolSettings, int, int, Random], Iterator[TrainingSample]]


def _copies(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return _altered(originals, settings.augment, first, last, random)


def _mild(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return _altered(originals, settings.mild, first, last, random)


def _altered(
    originals: Originals, settings: AugmentSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    pictures = _behind(originals)
    tokens = {hand.token for hand in originals.hands}
    unmirrored = replace(settings, mirror=0.0)
    for hand in originals.hands[first:last]:
        known = MIRRORED_TOKENS.get(hand.token, hand.token) in tokens
        image, box, token = augment(hand, pictures, settings if known else unmirrored, random)
        yield TrainingSample(
            image=image, box=box, side=hand.side, token=token, source=hand.source, original=False
        )


def _behind(originals: Originals) -> list[Image]:
    """What may stand behind a hand: water and rooms, or where there is neither, what stands behind other hands."""
    scenes = [scene.image for scene in (*originals.backgrounds, *originals.scenes)]
    return scenes or [one.image for one in originals.hands]


def _hidden(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    pictures = _behind(originals)
    for hand in originals.hands[first:last]:
        if random.random() < settings.hidden:
            image, box, _ = augment(hand, pictures, settings.augment, random)
            image, box = hide(image, box, pictures, random)
            yield TrainingSample(
                image=image, box=box, side=hand.side, token=NONE, source=hand.source, original=False
            )


def _missed(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    for hand in originals.hands[first:last]:
        if random.random() < settings.negative.missed:
            region = missed_hand(hand, settings.negative, random)
            if region is not None:
                yield _relit(region, settings, random)


def _regions(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    scenes = [*originals.backgrounds, *originals.scenes]
    for number in range(first, last):
        for region in negatives(scenes[number : number + 1], settings.negative, random):
            if not scenes[number].hands:
                # Water differs from picture to picture as people do from source to source, and weighs like them.
                region = replace(region, source=f"{region.source} {number}")
            yield _relit(region, settings, random)


def _rendered(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    seed = int(random.integers(2**31))
    tokens = {hand.token for hand in originals.hands}
    for sample in synthetic_hands(last - first, seed, settings.augment):
        if not tokens or sample.token in tokens:
            yield sample


KINDS: Mapping[str, Draw] = {
    "hands": _copies,
    "missed": _missed,
    "regions": _regions,
    "rendered": _rendered,
    "hidden": _hidden,
    "mild": _mild,
}
"""What draws the samples of a kind from the originals `first` to `last`; the place in this table seeds it."""
COPIED = ("hands", "mild")
"""Kinds with one sample for each hand."""


def _relit(region: TrainingSample, settings: PoolSettings, random: Random) -> TrainingSample:
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
    image = relight(part, None, settings.augment.light, random)
    return replace(region, image=image, box=box, original=False)
