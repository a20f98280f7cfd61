"""Nets that have not learnt from a fold of the real dives, so that the trees that weigh them can learn from every dive.

A net is surer of the pictures that it learnt from than of others; trees that are fitted on these trust it too much.
Real dives are few, so none is kept from the nets for good: nets without a fold of the dives look at these, fold after
fold (Wolpert, "Stacked generalization", 1992), and the shipped nets learn from all of them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from lightgesture.features.find.learned import Places
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.datasets import fold_of
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pool.left_out import LeftOut
from lightgesture.training.regions.nets import Progress, RegionTraining, learn_nets
from lightgesture.training.regions.region_pictures import Material
from lightgesture.training.regions.trees import Seen, look

SHORTER: Final = 3
"""By how much fewer steps the nets of a fold take than the shipped ones."""


@dataclass(frozen=True, slots=True, eq=False)
class DiveFold:
    """folder: of its parts. nets: locator and refiner. pictures: of the dives that they learnt nothing from."""

    folder: Path
    nets: tuple[IntegerNetwork, IntegerNetwork]
    pictures: Sequence[BoxedPicture]

    @property
    def left_out(self) -> LeftOut:
        """What a card says of it."""
        return LeftOut(frozenset(source for picture in self.pictures for source in picture.sources))

    def seen(self) -> Iterator[Seen]:
        """Those pictures whose hands are all boxed, as these nets see them."""
        return look((one for one in self.pictures if not one.ignored), Places(*self.nets))


def dive_folds(
    material: Material,
    composed: list[BoxedPicture],
    folder: Path,
    seed: int,
    settings: RegionTraining,
    progress: Progress,
) -> Iterator[DiveFold]:
    """The folds one after the other; each dive is in one of them.

    material: with all dives. settings: of the shipped nets. folder: where the nets of each fold are kept.
    """
    folds = settings.dive_folds
    for number in range(folds):
        is_apart = [_fold(one.picture, folds) == number for one in material.divers]
        if not any(is_apart):
            continue
        progress(f"fold {number + 1} of {folds} of the dives")
        own = folder / f"fold{number + 1}"
        own.mkdir(exist_ok=True)
        left = [one for one, apart in zip(material.divers, is_apart, strict=True) if not apart]
        nets = learn_nets(replace(material, divers=left), composed, own, seed, shortened(settings), progress)
        pictures = [one.picture for one, apart in zip(material.divers, is_apart, strict=True) if apart]
        yield DiveFold(own, nets, pictures)


def shortened(settings: RegionTraining) -> RegionTraining:
    """The training of the nets of a fold."""
    return replace(
        settings,
        locator_steps=max(1, settings.locator_steps // SHORTER),
        refiner_steps=max(1, settings.refiner_steps // SHORTER),
    )


def _fold(picture: BoxedPicture, folds: int) -> int:
    """Number of the fold that holds the dive of a picture, from 0."""
    (source,) = picture.sources
    return fold_of(source, folds)
