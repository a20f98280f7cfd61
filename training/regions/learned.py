"""The learned choice from its pictures: the nets, and the trees that weigh what these say of people whom they have not
seen."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from lightgesture.errors import InputError
from lightgesture.features.find.learned import Places, PlaceScorer
from lightgesture.features.find.selector_file import LearnedParts
from lightgesture.features.find.trees import Trees
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pool.left_out import LeftOut
from lightgesture.training.pool.picture_pool import Ingredients, compose_pool
from lightgesture.training.regions.nets import Progress, RegionTraining, learn_nets, learn_verifier
from lightgesture.training.regions.region_pictures import (
    COMPOSED,
    ONE_IN,
    UNSEEN,
    Material,
    read_material,
    variants,
)
from lightgesture.training.regions.trees import fit_place_pairs, fit_places, look

PAIR_SHARE: Final = 0.4
"""Of all pictures for trees, those for pairs."""


@dataclass(frozen=True, slots=True, eq=False)
class Pictures:
    """for_nets, composed: what the nets learn from. for_trees, unseen: other people and water."""

    for_nets: Material
    for_trees: Material
    composed: list[BoxedPicture]
    unseen: list[BoxedPicture]

    def without_divers(self, is_left_out: Callable[[str], bool]) -> "Pictures":
        """The same without real divers of the sources of which `is_left_out` says so."""
        rest = [one for one in self.for_nets.divers if not any(map(is_left_out, one.picture.sources))]
        return replace(self, for_nets=replace(self.for_nets, divers=rest))


def read_pictures(
    data: Path,
    without: LeftOut,
    seed: int,
    jobs: int,
    folder: Path,
    progress: Progress,
    composed: int = COMPOSED,
) -> Pictures:
    """Everything of a data folder, less the sources left out, and so many composed pictures for the nets; those that
    lie in `folder` are used as they are. Raises InputError."""
    progress("reading whole frames and cutting out hands")
    for_nets, for_trees = read_material(data, without, seed).parted(ONE_IN)
    if not all((part.frames and part.empty and part.hands) for part in (for_nets, for_trees)):
        raise InputError(f"{data}: too little is left to train on; leave out fewer sources")
    progress("composing pictures")
    return Pictures(
        for_nets,
        for_trees,
        _compose(for_nets, composed, seed + 1, jobs, folder / "composed.npy"),
        _compose(for_trees, UNSEEN, seed + 2, jobs, folder / "unseen.npy"),
    )


def _compose(material: Material, count: int, seed: int, jobs: int, path: Path) -> list[BoxedPicture]:
    ingredients = Ingredients(material.hands, material.waters(), material.rooms())
    return compose_pool(ingredients, count, seed, jobs, path)


def learn_choice(
    pictures: Pictures, folder: Path, seed: int, settings: RegionTraining, progress: Progress
) -> LearnedParts:
    """Nets and trees; what is done of the nets lies in `folder`."""
    nets = learn_nets(pictures.for_nets, pictures.composed, folder, seed, settings, progress)
    progress("fitting the trees that weigh both nets")
    first, _ = tree_pictures(pictures.for_trees, pictures.unseen, seed)
    places = fit_places(look(first, Places(*nets)), seed)
    return verified_choice(pictures, *nets, places, folder, seed, settings, progress)


def verified_choice(
    pictures: Pictures,
    locator: IntegerNetwork,
    refiner: IntegerNetwork,
    places: Trees,
    folder: Path,
    seed: int,
    settings: RegionTraining,
    progress: Progress,
) -> LearnedParts:
    """Both nets and the trees of places as they are, with a verifier of what they leave in doubt, and with trees of
    pairs that know what it says."""
    verifier = learn_verifier(pictures.for_nets, pictures.composed, locator, folder, seed, settings, progress)
    progress("fitting the trees of pairs")
    _, second = tree_pictures(pictures.for_trees, pictures.unseen, seed)
    pairs = fit_place_pairs(look(second, Places(locator, refiner)), PlaceScorer(places, verifier), seed)
    return LearnedParts(locator, refiner, places, pairs, verifier)


def tree_pictures(
    material: Material, unseen: list[BoxedPicture], seed: int
) -> tuple[list[BoxedPicture], list[BoxedPicture]]:
    """Pictures for the trees of places and, of others, for those of pairs; whole frames in several lights."""
    rng = np.random.default_rng(seed)
    single = [*material.empty, *unseen]
    whole, order = len(material.frames), rng.permutation(len(material.frames) + len(single))
    parts: tuple[list[BoxedPicture], list[BoxedPicture]] = [], []
    for place, index in enumerate(order):
        part = parts[place < PAIR_SHARE * len(order)]
        if index < whole:
            part.extend(variants(material.frames[index], rng))
        else:
            part.append(single[index - whole])
    return parts
