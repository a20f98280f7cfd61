"""Rendered hands for what real pictures lack: oblique views, fingers together, dark skin in dark rooms, water."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from lightgesture.models import TrainingSample
from lightgesture.synth.crops import CropMaker, CropSettings
from lightgesture.training.pictures.augment import AugmentSettings, shifted_box


@dataclass(frozen=True, slots=True)
class SyntheticSettings:
    """Rendered crops beside the real ones.

    crops: how they vary; views are turned further than people turn their hands for a camera, because those are rare
        among the real ones, a third of the rings are seen from the side, as divers show an ok to a camera, and nearly
        half of the hands hold their fingers together.
    sources: names over which the crops are spread, so that weighting by source and held-out folds treat them as that
        many people.
    """

    crops: CropSettings = field(
        default_factory=lambda: CropSettings(yaw=28.0, pitch=18.0, roll=16.0, sideways=0.35, together=0.45)
    )
    sources: int = 40


def synthetic_hands(
    count: int, seed: int, settings: SyntheticSettings, augment: AugmentSettings, *, original: bool = False
) -> Iterator[TrainingSample]:
    """`count` rendered hands of all tokens in turn and some `none`, boxes wrong by as much as those of copies.

    original: whether scores count them, as they must where there are no real hands.
    """
    random = np.random.default_rng(seed)
    maker = CropMaker(seed, "train", settings.crops)
    for index, crop in enumerate(maker.samples(count)):
        yield TrainingSample(
            image=crop.image,
            box=shifted_box(crop.box, augment, random),
            # A crop obeys the rule of upright crops: the thumb's direction in the picture names the token.
            side="left",
            token=crop.token,
            source=f"synthetic {index % settings.sources}",
            original=original,
        )
