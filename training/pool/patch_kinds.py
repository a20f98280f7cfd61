"""What a pool of patches is made of: copies of hands, hidden hands, regions that are no hand, rendered hands."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.models import NONE
from lightgesture.synth.crops import CropMaker, CropSettings
from lightgesture.training.pictures.augment import MILD, AugmentSettings, augment, shifted_box
from lightgesture.training.pictures.hidden_hands import hide
from lightgesture.training.pool.altered import altered, behind, relit
from lightgesture.training.pool.diver_kinds import resting, sea, shown
from lightgesture.training.pool.negatives import missed_hand, negatives
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.posed import posed
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


Draw = Callable[[Originals, PoolSettings, int, int, Random], Iterator[TrainingSample]]


def _copies(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return altered(originals, originals.hands[first:last], settings.augment, random)


def _mild(
    originals: Originals, _settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    return altered(originals, originals.hands[first:last], MILD, random)


def _hidden(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    pictures = behind(originals)
    for hand in originals.hands[first:last]:
        if random.random() < HIDDEN:
            copy = augment(hand, pictures, settings.augment, random)
            image, box = hide(copy.image, copy.box, pictures, random)
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
                yield relit(region, settings.augment.light, random)


def _regions(
    originals: Originals, settings: PoolSettings, first: int, last: int, random: Random
) -> Iterator[TrainingSample]:
    scenes = [*originals.backgrounds, *originals.scenes, *originals.divers.scenes]
    for number in range(first, last):
        for region in negatives(scenes[number : number + 1], random):
            if not scenes[number].hands:
                # Water differs from picture to picture as people do from source to source, and weighs like them.
                region = replace(region, source=f"{region.source} {number}")
            yield relit(region, settings.augment.light, random)


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
            landmarks=np.asarray(crop.landmarks, np.float32),
        )


KINDS: Mapping[str, Draw] = {
    "hands": _copies,
    "missed": _missed,
    "regions": _regions,
    "rendered": _rendered,
    "hidden": _hidden,
    "mild": _mild,
    "sea": sea,
    "shown": shown,
    "resting": resting,
    "posed": posed,
}
"""What draws the samples of a kind from the originals `first` to `last`; the place in this table seeds it."""
COPIED = ("hands", "mild", "sea")
"""Kinds with one sample for each hand."""
