"""The training of the selector from end to end: pictures, nets, the trees of either choice, the file and its card."""

import json
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from lightgesture.errors import InputError
from lightgesture.features.compiled import best_loops
from lightgesture.features.find.learned import Places
from lightgesture.features.find.selector_file import ClassicalParts, LearnedParts, load_learned
from lightgesture.results.atomic import replacing
from lightgesture.training.model_files import write_classical, write_selector
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pool.left_out import CARD_KEY, LeftOut
from lightgesture.training.pool.picture_pool import Ingredients, compose_pool
from lightgesture.training.regions.bank import make_bank
from lightgesture.training.regions.card import write_card
from lightgesture.training.regions.nets import Progress, RegionTraining, learn_nets
from lightgesture.training.regions.region_pictures import (
    COMPOSED,
    ONE_IN,
    UNSEEN,
    Material,
    read_material,
    variants,
)
from lightgesture.training.regions.trees import (
    fit_pairs,
    fit_place_pairs,
    fit_places,
    fit_regions,
    look,
)

CLASSICAL_VIEWS: Final = 2
"""Views of a whole frame, under water, in the dark or mirrored, from which the classical trees learn beside itself."""
CLASSICAL_COMPOSED: Final = 2000
"""Composed pictures for them; real ones teach them more."""
PAIR_SHARE: Final = 0.4
"""Of all pictures for trees, those for pairs."""


def train_regions(
    data: Path,
    out: Path,
    seed: int = 0,
    jobs: int = 1,
    without: LeftOut | None = None,
    settings: RegionTraining | None = None,
    progress: Progress = lambda _: None,
) -> None:
    """Train the selector and write it with its card (`out` with the suffix .json).

    What is done already lies in a folder beside `out` and is used when the same command runs again; it may be removed
    when the file is written. Raises InputError, UsageError.
    """
    need_torch()
    settings, without, started = settings or RegionTraining(), without or LeftOut(), time.monotonic()
    told = {CARD_KEY: without.to_card(), "settings": repr(settings), "start": settings.origin}
    folder = checkpoint_folder(out, {"seed": seed, **told})
    progress("reading whole frames and cutting out hands")
    material = read_material(data, without, seed)
    for_nets, for_trees = material.parted(ONE_IN)
    if not all((part.frames and part.empty and part.hands) for part in (for_nets, for_trees)):
        raise InputError(f"{data}: too little is left to train on; leave out fewer sources")
    progress("composing pictures")
    composed = _compose(for_nets, COMPOSED, seed + 1, jobs, folder / "composed.npy")
    unseen = _compose(for_trees, UNSEEN, seed + 2, jobs, folder / "unseen.npy")
    nets = learn_nets(for_nets, composed, folder, seed, settings, progress)
    progress("fitting the trees that weigh both nets")
    first, second = _tree_pictures(for_trees, unseen, seed)
    places = fit_places(look(first, Places(*nets)), seed)
    pairs = fit_place_pairs(look(second, Places(*nets)), places, seed)
    progress("fitting the classical trees")
    classical = _classical(data, for_nets, composed, second, without, seed)
    write_selector(classical, LearnedParts(*nets, places, pairs), out)
    write_card(out, seed, without, settings, material, time.monotonic() - started)


def train_classical(
    data: Path,
    out: Path,
    start: Path,
    seed: int = 0,
    jobs: int = 1,
    without: LeftOut | None = None,
    progress: Progress = lambda _: None,
) -> None:
    """Fit the classical trees alone; all else of the file is that of `start`, byte for byte, and the card is its card
    with a word of this. A few minutes once the pictures are composed, which lie in a folder beside `out`.

    Raises InputError, SelectorError, UsageError.
    """
    without = without or LeftOut()
    load_learned(start)
    told = {CARD_KEY: without.to_card(), "classical": True}
    folder = checkpoint_folder(out, {"seed": seed, **told})
    progress("reading whole frames and cutting out hands")
    material = read_material(data, without, seed)
    for_nets, for_trees = material.parted(ONE_IN)
    progress("composing pictures")
    composed = _compose(for_nets, CLASSICAL_COMPOSED, seed + 1, jobs, folder / "composed.npy")
    unseen = _compose(for_trees, UNSEEN, seed + 2, jobs, folder / "unseen.npy")
    progress("fitting the classical trees")
    second = _tree_pictures(for_trees, unseen, seed)[1]
    write_classical(_classical(data, for_nets, composed, second, without, seed), start, out)
    card = start.with_suffix(".json")
    content = json.loads(card.read_text(encoding="utf-8")) if card.is_file() else {}
    content["classical_trees"] = {
        "fitted_apart_from_the_nets": True,
        CARD_KEY: without.to_card(),
        "seed": seed,
    }
    with replacing(out.with_suffix(".json")) as temporary:
        temporary.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def _compose(material: Material, count: int, seed: int, jobs: int, path: Path) -> list[BoxedPicture]:
    ingredients = Ingredients(material.hands, material.waters(), material.rooms())
    return compose_pool(ingredients, count, seed, jobs, path)


def _tree_pictures(
    material: Material, unseen: list[BoxedPicture], seed: int
) -> tuple[list[BoxedPicture], list[BoxedPicture]]:
    """Pictures for the trees of places and, of others, for those of pairs; whole frames in several lights."""
    rng = np.random.default_rng(seed)
    single = [*material.empty, *unseen, *(one.picture for one in material.divers if not one.picture.ignored)]
    whole, order = len(material.frames), rng.permutation(len(material.frames) + len(single))
    parts: tuple[list[BoxedPicture], list[BoxedPicture]] = [], []
    for place, index in enumerate(order):
        part = parts[place < PAIR_SHARE * len(order)]
        if index < whole:
            part.extend(variants(material.frames[index], rng))
        else:
            part.append(single[index - whole])
    return parts


def _classical(
    data: Path,
    material: Material,
    composed: list[BoxedPicture],
    for_pairs: list[BoxedPicture],
    without: LeftOut,
    seed: int,
) -> ClassicalParts:
    bank, loops = make_bank(data, seed, without), best_loops()

    def pictures() -> Iterator[BoxedPicture]:
        return classical_pictures(material, composed, seed + 1)

    first, second = fit_regions(pictures, bank, loops, seed)
    return fit_pairs(for_pairs, first, second, bank, loops, seed)


def classical_pictures(
    material: Material, composed: Sequence[BoxedPicture], seed: int
) -> Iterator[BoxedPicture]:
    """What the trees of regions learn from; the same arguments give the same pictures."""
    rng = np.random.default_rng(seed)
    for picture in material.frames:
        views = list(variants(picture, rng))
        yield views[0]
        yield from (views[1 + index] for index in rng.permutation(len(views) - 1)[:CLASSICAL_VIEWS])
    yield from material.empty
    yield from (one.picture for one in material.divers if not one.picture.ignored)
    yield from composed[:CLASSICAL_COMPOSED]
