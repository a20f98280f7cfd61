"""The stream of training samples: originals, altered copies, and regions that are no token."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lightgesture.models import NONE, TrainingSample
from lightgesture.training.augment import MIRRORED_TOKENS, AugmentSettings, augment
from lightgesture.training.light import relight
from lightgesture.training.negatives import NegativeSettings, Scene, missed_hand, negatives
from lightgesture.training.samples import LabelledHand


@dataclass(frozen=True, slots=True)
class StreamSettings:
    """copies: altered copies of each hand, 0 to 10. augment, negative: how they and the regions are made."""

    copies: int = 4
    augment: AugmentSettings = field(default_factory=AugmentSettings)
    negative: NegativeSettings = field(default_factory=NegativeSettings)


def stream(
    hands: Sequence[LabelledHand],
    backgrounds: Sequence[Scene],
    scenes: Sequence[Scene],
    settings: StreamSettings,
    seed: int,
) -> Iterator[TrainingSample]:
    """All samples, the same for the same seed.

    backgrounds: stand behind copies; without any, the hands' own pictures do. scenes: whole pictures with
    hands. Regions of both are `none` if that is among the hands' classes or there are no hands.
    """
    random = np.random.default_rng(seed)
    for hand in hands:
        yield TrainingSample(
            image=hand.image, box=hand.box, side=hand.side, token=hand.token, source=hand.source
        )
    pictures = [scene.image for scene in backgrounds] or [hand.image for hand in hands]
    unmirrored = replace(settings.augment, mirror=0.0)
    tokens = {hand.token for hand in hands}
    for _ in range(settings.copies):
        for hand in hands:
            known = MIRRORED_TOKENS.get(hand.token, hand.token) in tokens
            how = settings.augment if known else unmirrored
            image, box, token = augment(hand, pictures, how, random)
            yield TrainingSample(
                image=image, box=box, side=hand.side, token=token, source=hand.source, original=False
            )
    if not hands or any(hand.token == NONE for hand in hands):
        yield from _regions(hands, [*backgrounds, *scenes], settings, random)


def _regions(
    hands: Sequence[LabelledHand],
    scenes: Sequence[Scene],
    settings: StreamSettings,
    random: np.random.Generator,
) -> Iterator[TrainingSample]:
    """Regions that are no token, each a second time in other light."""
    for region in _plain_regions(hands, scenes, settings, random):
        yield region
        yield TrainingSample(
            image=relight(region.image, None, settings.augment.light, random),
            box=region.box,
            side=region.side,
            token=region.token,
            source=region.source,
            original=False,
        )


def _plain_regions(
    hands: Sequence[LabelledHand],
    scenes: Sequence[Scene],
    settings: StreamSettings,
    random: np.random.Generator,
) -> Iterator[TrainingSample]:
    yield from negatives(scenes, settings.negative, random)
    for hand in hands:
        if random.random() < settings.negative.missed:
            region = missed_hand(hand, settings.negative, random)
            if region is not None:
                yield region
