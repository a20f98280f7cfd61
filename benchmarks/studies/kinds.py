"""The studies of `studies.reading`, each a table whose rows are trainings from one pool."""

import argparse
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture.benchmarks.studies.data import (
    Mask,
    Study,
    answers_of,
    draw_pool,
    held_out_subjects,
    rows_of_sources,
    val_answers,
)
from lightgesture.benchmarks.studies.places import places
from lightgesture.benchmarks.studies.rows import (
    COLUMNS,
    NOTE,
    Rows,
    fit_row,
    mean_and_worst,
    scored_cells,
)
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.console import say
from lightgesture.errors import InputError
from lightgesture.training.commands.train_cnn import SIZES
from lightgesture.training.datasets import fold_of
from lightgesture.training.nets.cnn import CnnTraining
from lightgesture.training.pool.kept_hands import kept_out
from lightgesture.training.pool.originals import Originals, PoolSettings, read_originals
from lightgesture.training.pool.patch_pool import rows_without

Change = Callable[[PoolSettings], PoolSettings]
EVERYTHING, NOTHING = "everything", "nothing"
POSED = 20000
"""Hands in the poses of real ones in the row that has them."""

WITHOUT: Mapping[str, tuple[Mapping[str, float], Mapping[str, float]]] = {
    "no mirror": ({"mirror": 0.0}, {}),
    "no rotation": ({"rotation": 0.0}, {}),
    "no stretch, no shear": ({"stretch": 0.0, "shear": 0.0}, {}),
    "no other background": ({"background": 0.0}, {}),
    "no error of the box": ({"shift": 0.0, "scale": 0.0}, {}),
    "no tone": ({}, {"gamma": 0.0, "contrast": 0.0, "gain": 0.0, "gradient": 0.0}),
    "no darkness": ({}, {"dark": 0.0, "backlit": 0.0}),
    "no water": ({}, {"water": 0.0}),
    "no blur, no noise": ({}, {"blur": 0.0, "noise": 0.0}),
}
"""Fields of `AugmentSettings` and of `LightSettings` that are set to zero, by the name of the row."""


def changed(pool: PoolSettings, copy: Mapping[str, float], light: Mapping[str, float]) -> PoolSettings:
    """The same pool with other fields of its copies and of their light."""
    changes: dict[str, Any] = {**copy, "light": replace(pool.augment.light, **light)}
    return replace(pool, augment=replace(pool.augment, **changes))


def without_rendered(pool: PoolSettings) -> PoolSettings:
    """The same pool of pictures alone."""
    return replace(pool, rendered=0)


def with_posed(pool: PoolSettings) -> PoolSettings:
    """The same pool with rendered hands in the poses of real ones besides."""
    return replace(pool, posed=POSED)


def without_mild(pool: PoolSettings) -> PoolSettings:
    """The same pool without the copies that are hardly altered."""
    return replace(pool, mild_share=0.0)


def with_nothing(pool: PoolSettings) -> PoolSettings:
    """Copies as the pictures are, and no rendered hands."""
    for copy, light in WITHOUT.values():
        pool = changed(pool, copy, light)
    return without_mild(without_rendered(pool))


def _leaving_out(name: str) -> Change:
    return lambda pool: changed(pool, *WITHOUT[name])


POOLS: Mapping[str, Change] = {
    EVERYTHING: lambda pool: pool,
    **{name: _leaving_out(name) for name in WITHOUT},
    "no mild copies": without_mild,
    "no rendered hands": without_rendered,
    "posed hands": with_posed,
    NOTHING: with_nothing,
}
"""What becomes of a pool's settings, by the name of the row."""

FOLDS = 5
SUBJECTS_ONE_IN = 5
COUNTS = (10, 30, 100, 200)
"""Numbers of training sources of the curve, before all of them."""
STEPS = (1000, 3000, 10000)
"""Of the learning curve."""


def folds(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """A net for each fold of the sources, and if wanted the SVM likewise."""
    number = np.array([fold_of(str(source), FOLDS) for source in study.sources])
    rows: Rows = []
    svm: Rows = []
    for fold in args.fold or range(FOLDS):
        held = number == fold
        # With few sources a fold may have none.
        if held.any():
            chosen = rows_without(study.pool, study.sources, held)
            if not args.svm_alone:
                rows.append(fit_row(study, f"cnn fold {fold}", chosen, held, training, folder))
            if args.svm or args.svm_alone:
                svm.append(_svm_row(study, f"svm fold {fold}", chosen, held, training, args))
    rows += [*mean_and_worst("cnn", rows), *svm, *mean_and_worst("svm", svm)]
    return [Table("folds", f"{FOLDS} folds over the sources of hands/train", COLUMNS, tuple(rows), NOTE)]


def subjects(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """One net without some people of sources that are trained on, and if wanted the SVM likewise."""
    held = held_out_subjects([str(source) for source in study.sources], study.subjects, SUBJECTS_ONE_IN)
    if not held.any():
        raise InputError(f"{study.data}: names no source with two subjects or more; this study needs some")
    chosen = rows_without(study.pool, study.sources, held)
    rows: Rows = []
    if not args.svm_alone:
        rows.append(fit_row(study, "cnn", chosen, held, training, folder))
    if args.svm or args.svm_alone:
        rows.append(_svm_row(study, "svm", chosen, held, training, args))
    title = "Held-out subjects of sources that are trained on"
    return [Table("subjects", title, COLUMNS, tuple(rows), NOTE)]


def _svm_row(
    study: Study, name: str, chosen: Mask, held: Mask, training: CnnTraining, args: argparse.Namespace
) -> dict[str, Cell]:
    """The SVM on the same rows of the pool, and on the hands that they are copies of."""
    from lightgesture.models.svm import SvmClassifier
    from lightgesture.training.pool.pool_samples import pool_samples
    from lightgesture.training.svm.machine import SvmSettings, train_svm

    say(f"{name}: training")
    samples = pool_samples(study.pool, Originals(study.hands), chosen, ~held, training.pool, training.seed)
    settings = SvmSettings(centres=args.svm_centres, steps=args.svm_steps)
    model, _ = train_svm(samples, settings, classes=study.classes, seed=training.seed)
    classifier = SvmClassifier(model)
    return {
        "row": name,
        "sources": len(np.unique(study.sources[~held])),
        **scored_cells("held", answers_of(classifier, study, held)),
        **scored_cells("val", val_answers(classifier, study)),
    }


def outline(study: Study, training: CnnTraining, folder: Path, _args: argparse.Namespace) -> list[Table]:
    """The net with and without the numbers of the outline."""
    kinds = {"patch alone": False, "patch and outline": True}
    rows = [
        _on_sources(study, name, replace(training, contours=kind), folder) for name, kind in kinds.items()
    ]
    return [
        Table(
            "outline",
            "The outline's numbers as a second input",
            (*COLUMNS, "multiply_adds"),
            tuple(rows),
            NOTE,
        )
    ]


def sizes(study: Study, training: CnnTraining, folder: Path, _args: argparse.Namespace) -> list[Table]:
    """Three nets."""
    rows = [_on_sources(study, size, replace(training, size=size), folder) for size in SIZES]
    columns = (*COLUMNS, "multiply_adds", "weights")
    return [Table("sizes", "Size of the net", columns, tuple(rows), NOTE)]


def augmentation(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """A pool and a net for each alteration that is left out, beside one with all and one with none."""
    originals = None
    rows: Rows = []
    for name in args.only or POOLS:
        settings = POOLS[name](training.pool)
        place = folder / "_".join(name.split())
        if originals is None:
            originals = read_originals(
                study.rows, training.backgrounds, training.scenes, training.divers, training.without
            )
        say(f"{name}: drawing its pool")
        pool = draw_pool(originals, settings, training, place / "pool", say)
        own = replace(study, pool=pool)
        rows.append(_on_sources(own, name, replace(training, pool=settings), place))
    return [Table("augmentation", "What each alteration of the pictures buys", COLUMNS, tuple(rows), NOTE)]


def sources(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """Nets of few and of many sources; each number's sources hold those of the smaller numbers."""
    held = kept_out(study.hands)
    names = np.unique(study.sources[~held])
    order = np.random.default_rng(training.seed).permutation(len(names))
    counts = [count for count in args.counts or COUNTS if count < len(names)]
    rows: Rows = []
    unseen = rows_without(study.pool, study.sources, held)
    for count in [*counts, len(names)]:
        chosen = unseen & rows_of_sources(study.pool, study.sources, list(names[order[:count]]))
        rows.append(fit_row(study, f"{count} sources", chosen, held, training, folder))
    title = "Number of training sources (rendered hands and regions of other pictures always there)"
    return [Table("sources", title, COLUMNS, tuple(rows), NOTE)]


def _on_sources(study: Study, name: str, training: CnnTraining, folder: Path) -> dict[str, Cell]:
    """A row whose held-out hands are those of the shipped net's held-out sources."""
    held = kept_out(study.hands)
    return fit_row(study, name, rows_without(study.pool, study.sources, held), held, training, folder)


def steps(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """The learning curve: nets of few and of many steps, each with a whole cosine of its rate."""
    rows = [
        _on_sources(study, f"{count} steps", replace(training, steps=count), folder)
        for count in args.counts or STEPS
    ]
    return [Table("steps", "Steps of the training", COLUMNS, tuple(rows), NOTE)]


Kind = Callable[[Study, CnnTraining, Path, argparse.Namespace], list[Table]]
KINDS: dict[str, Kind] = {
    "folds": folds,
    "subjects": subjects,
    "outline": outline,
    "augmentation": augmentation,
    "sources": sources,
    "sizes": sizes,
    "steps": steps,
    "places": places,
}
