"""What a pool of patches is made of: copies of hands, hidden hands, regions that are no hand, rendered hands."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.types import Image
from lightgesture.models import CLASSES, NONE
from lightgesture.synth.crops import CropMaker, CropSettings
from lightgesture.training.pictures.augment import (
    CANVAS,
    MILD,
    MIRRORED_TOKENS,
    AugmentSettings,
    augment,
    shifted_box,
)
from lightgesture.training.pictures.hidden_hands import hide
from lightgesture.training.pictures.light import relight
from lightgesture.training.pool.negatives import Scene, missed_hand, negatives, read_backgrounds, read_scenes
from lightgesture.training.pool.samples import HandRow, LabelledHand, load_hand
from lightgesture.training.samples import TrainingSample

Random = np.random.Generator

PATCH: Final = PatchSettings()
"""What a model sees of a hand."""
MARGIN: Final = 2
"""Pixels that are kept on each side of a patch, by which it is shifted in training."""
KEPT: Final = PatchSettings(PATCH.size + 2 * MARGIN, PATCH.context * (PATCH.size + 2 * MARGIN) / PATCH.size)
"""A patch with its margin."""
CONTOUR: Final = ContourSettings()
"""Numbers of the outline, which go with each patch."""
SMALLEST_HAND: Final = 12
"""Longer side of the smallest box that a model reads, pixels."""
HIDDEN: Final = 0.5
"""Share of the rounds in which a copy of each hand is added of which too little is seen."""
MISSED: Final = 0.3
"""Share of the rounds in which a box is laid beside each hand."""
CROPS: Final = CropSettings(yaw=28.0, pitch=18.0, roll=16.0, sideways=0.35, together=0.45)
"""How rendered hands vary: turned further than people turn their hands for a camera, because such views are rare among
the pictures; a third of the rings are seen from the side, as divers show an ok to a camera, and nearly half of the
hands hold their fingers together."""
RENDERED_SOURCES: Final = 40
"""Names over which rendered hands are spread: weights and held-out folds treat them as so many people."""
RENDERED_SOURCE: Final = "synthetic"
"""Beginning of these names."""


@dataclass(frozen=True, slots=True)
class PoolSettings:
    """How much is drawn and how."""

    copies: int = 24
    """Altered copies of each hand, 1 to 100; time and disk grow with them."""
    mild_share: float = 1 / 3
    """Copies of each hand besides that are hardly altered, over `copies`, 0 to 1; none read plain pictures worse."""
    rounds: int = 8
    """How often regions that are no hand are drawn from each picture, 1 to 100."""
    rendered: int = 12000
    """Rendered hands beside the real ones, of the signs that both know."""
    augment: AugmentSettings = field(
        default_factory=lambda: AugmentSettings(
            rotation=18.0, scale=0.11, shift=0.06, narrowed=0.2, background=0.6
        )
    )
    """How far copies go; mild copies go as far as `augment.MILD`."""

    @property
    def mild_copies(self) -> int:
        """Of each hand."""
        return round(self.mild_share * self.copies)


@dataclass(frozen=True, slots=True, eq=False)
class Originals:
    """What copies are made of. hands: labelled. backgrounds: pictures without hands. scenes: whole pictures."""

    hands: Sequence[LabelledHand]
    backgrounds: Sequence[Scene] = ()
    scenes: Sequence[Scene] = ()

    @property
    def rendered_classes(self) -> frozenset[str]:
        """Classes of which rendered hands can be had, all where there are no hands.

        Beside own signs there is no rendered `none`: shapes that the ten tokens lack may be just these signs.
        """
        found = {hand.token for hand in self.hands}
        known = found & set(CLASSES) if found else set(CLASSES)
        return frozenset(known - {NONE} if found - known else known)


def read_originals(rows: Sequence[HandRow], backgrounds: Sequence[Path], scenes: Path | None) -> Originals:
    """All pictures that a classifier is trained on, read once.

    backgrounds: folders of pictures without hands. scenes: table of whole pictures with boxes of hands and faces.
    Raises InputError.
    """
    return Originals(
        [load_hand(row) for row in rows],
        [scene for folder in backgrounds for scene in read_backgrounds(folder)],
        read_scenes(scenes) if scenes else (),
    )


Draw = Callable[[Originals, PoolSettings, int, int, Random], Iterator[TrainingSample]]


def _copies(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return _altered(originals, settings.augment, first, last, random)


def _mild(
    originals: Originals, _settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return _altered(originals, MILD, first, last, random)


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
        if random.random() < HIDDEN:
            image, box, _ = augment(hand, pictures, settings.augment, random)
            image, box = hide(image, box, pictures, random)
            yield TrainingSample(
                image=image, box=box, side=hand.side, token=NONE, source=hand.source, original=False
            )


def _missed(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    for hand in originals.hands[first:last]:
        if random.random() < MISSED:
            region = missed_hand(hand, random)
            if region is not None:
                yield _relit(region, settings, random)


def _regions(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    scenes = [*originals.backgrounds, *originals.scenes]
    for number in range(first, last):
        for region in negatives(scenes[number : number + 1], random):
            if not scenes[number].hands:
                # Water differs from picture to picture as people do from source to source, and weighs like them.
                region = replace(region, source=f"{region.source} {number}")
            yield _relit(region, settings, random)


def _rendered(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    wanted = originals.rendered_classes
    for sample in rendered_hands(last - first, int(random.integers(2**31)), settings.augment):
        if sample.token in wanted:
            yield sample


def rendered_hands(count: int, seed: int, augment: AugmentSettings) -> Iterator[TrainingSample]:
    """`count` rendered hands of all tokens in turn and some `none`, boxes wrong by as much as those of copies.

    They hold what real pictures lack: oblique views, fingers together, dark skin in dark rooms, water.
    """
    random = np.random.default_rng(seed)
    for index, crop in enumerate(CropMaker(seed, "train", CROPS).samples(count)):
        yield TrainingSample(
            image=crop.image,
            box=shifted_box(crop.box, augment, random),
            # A crop obeys the rule of upright crops: the thumb's direction in the picture names the token.
            side="left",
            token=crop.token,
            source=f"{RENDERED_SOURCE} {index % RENDERED_SOURCES}",
            original=False,
        )


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
