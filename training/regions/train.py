"""The training of the selector from end to end: pictures, nets, the trees of either choice, the file and its card."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from lightgesture.features.compiled.loops import best_loops
from lightgesture.features.find.selector_file import ClassicalParts, load_classical, load_learned
from lightgesture.training.model_files import write_classical, write_selector
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch
from lightgesture.training.nets.spent_time import SpentTime
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pool.left_out import CARD_KEY, LeftOut
from lightgesture.training.regions.bank import make_bank
from lightgesture.training.regions.card import extend_card, told_of, write_card
from lightgesture.training.regions.learned import (
    Pictures,
    learn_choice,
    read_pictures,
    tree_pictures,
    verified_choice,
)
from lightgesture.training.regions.nets import Progress, RegionTraining
from lightgesture.training.regions.region_pictures import Material, variants
from lightgesture.training.regions.trees import fit_pairs, fit_regions

CLASSICAL_VIEWS: Final = 2
"""Views of a whole frame, under water, in the dark or mirrored, from which the classical trees learn beside itself."""
CLASSICAL_COMPOSED: Final = 2000
"""Composed pictures for them; real ones teach them more."""


def train_regions(
    data: Path,
    out: Path,
    seed: int = 0,
    jobs: int = 1,
    without: LeftOut | None = None,
    settings: RegionTraining | None = None,
    progress: Progress = lambda _: None,
    *,
    keeps_classical: bool = False,
) -> None:
    """Train the selector and write it with its card (`out` with the suffix .json).

    keeps_classical: the classical choice is that of the settings' `start`, which must be given, and is not fitted too.

    What is done already lies in a folder beside `out` and is used when the same command runs again; it may be removed
    when the file is written. Raises InputError, UsageError.
    """
    need_torch()
    settings, without = settings or RegionTraining(), without or LeftOut()
    start, reader = settings.start_digest(), settings.reader_digest()
    told = {CARD_KEY: without.to_card(), "settings": repr(settings), "start": start, "reader": reader}
    folder = checkpoint_folder(out, {"seed": seed, **told})
    with SpentTime(folder) as spent:
        progress = spent.kept_by(progress)
        pictures = read_pictures(data, without, seed, jobs, folder, progress)
        learned = learn_choice(pictures, folder, seed, settings, progress)
        if keeps_classical:
            classical = load_classical(settings.start)
        else:
            progress("fitting the classical trees")
            classical = _classical(data, pictures, without, seed)
        write_selector(classical, learned, out)
        write_card(
            *(out, seed, without, settings, pictures, spent.whole_seconds),
            start=start,
            reader=reader,
            keeps_classical=keeps_classical,
        )


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
    pictures = read_pictures(data, without, seed, jobs, folder, progress, CLASSICAL_COMPOSED)
    progress("fitting the classical trees")
    write_classical(_classical(data, pictures, without, seed), start, out)
    extend_card(start, out, "classical_trees", {"fitted_apart_from_the_nets": True, **told_of(without, seed)})


def train_verifier(
    data: Path,
    out: Path,
    start: Path,
    seed: int = 0,
    jobs: int = 1,
    without: LeftOut | None = None,
    settings: RegionTraining | None = None,
    progress: Progress = lambda _: None,
) -> None:
    """Train the verifier and the trees of pairs, which know what it says; all else of the file is that of `start`, and
    the card is its card with a word of this. What is done lies in a folder beside `out`.

    Raises InputError, SelectorError, UsageError.
    """
    need_torch()
    settings, without = replace(settings or RegionTraining(), start=start), without or LeftOut()
    known, classical = load_learned(start), load_classical(start)
    told = {
        "steps": settings.verifier_steps,
        "went_on_from_the_larger_net_of_sha256": settings.reader_digest(),
    }
    kept = {
        CARD_KEY: without.to_card(),
        "start": settings.start_digest(),
        "precision": settings.precision,
    }
    folder = checkpoint_folder(out, {"seed": seed, **told, **kept})
    with SpentTime(folder) as spent:
        progress = spent.kept_by(progress)
        pictures = read_pictures(data, without, seed, jobs, folder, progress)
        parts = known.locator, known.refiner, known.places
        learned = verified_choice(pictures, *parts, folder, seed, settings, progress)
        write_selector(classical, learned, out)
        told |= {"seconds": spent.whole_seconds, **told_of(without, seed)}
        extend_card(start, out, "verifier", told)


def _classical(data: Path, pictures: Pictures, without: LeftOut, seed: int) -> ClassicalParts:
    bank, loops = make_bank(data, seed, without), best_loops()

    def of_regions() -> Iterator[BoxedPicture]:
        return classical_pictures(pictures.for_nets, pictures.composed, seed + 1)

    first, second = fit_regions(of_regions, bank, loops, seed)
    _, of_pairs = tree_pictures(pictures.for_trees, pictures.unseen, seed)
    return fit_pairs(of_pairs, first, second, bank, loops, seed)


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
