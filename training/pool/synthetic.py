"""Rendered hands for what real pictures lack: oblique views, fingers together, dark skin in dark rooms, water."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from lightgesture.models import TrainingSample
from lightgesture.synth.crops import CropMaker, CropSettings
from lightgesture.training.pictures.augment import AugmentSettings, shifted_box

CROPS: Final = CropSettings(yaw=28.0, pitch=18.0, roll=16.0, sideways=0.35, together=0.45)
"""Views are turned further than people turn their hands for a camera, because those are rare among the real ones, a
third of the rings are seen from the side, as divers show an ok to a camera, and nearly half of the hands hold their
fingers together."""
SOURCES: Final = 40
"""Names over which the crops are spread, so that weighting by source and held-out folds treat each as a
person."""


def synthetic_hands(
    count: int, seed: int, augment: AugmentSettings, *, original: bool = False
) -> Iterator[TrainingSample]:
    """`count` rendered hands of all tokens in turn and some `none`, boxes wrong by as much as those of copies.

    original: whether scores count them, as they must where there are no real hands.
    """
    random = np.random.default_rng(seed)
    maker = CropMaker(seed, "train", CROPS)
    for index, crop in enumerate(maker.samples(count)):
        yield TrainingSample(
            image=crop.image,
            box=shifted_box(crop.box, augment, random),
            # A crop obeys the rule of upright crops: the thumb's direction in the picture names the token.
            side="left",
            token=crop.token,
            source=f"synthetic {index % SOURCES}",
            original=original,
        )
