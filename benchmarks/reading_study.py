"""What decides how well hands are read: `python -m lightgesture.benchmarks.reading_study KIND --data DIR --pool DIR`.

folds: five nets, each without a fifth of the sources. subjects: people held out of sources that are trained on, the
paper's kind of test. outline: with and without the outline's numbers. augmentation: one alteration left out at a
time. sources: few people or many. sizes: three nets. Every row is one training of `train cnn` with a seed, from one
pool (augmentation draws one for each row); what is done lies in the pool's folder, and the same command goes on there.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from lightgesture.benchmarks.study_cli import (
    add_data_argument,
    add_pool_arguments,
    positive,
    print_and_write,
    run_command,
    training_from,
    whole,
)
from lightgesture.benchmarks.study_data import (
    Mask,
    Study,
    answers_of,
    draw_pool,
    held_out_subjects,
    open_study,
    rows_of_sources,
    val_answers,
)
from lightgesture.benchmarks.study_pools import POOLS
from lightgesture.benchmarks.study_rows import (
    COLUMNS,
    NOTE,
    Rows,
    card_folds,
    fit_row,
    mean_and_worst,
    scored_cells,
)
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.commands.train_cnn import PRECISIONS, SIZES
from lightgesture.console import say
from lightgesture.datasets import find_data, fold_of
from lightgesture.errors import InputError
from lightgesture.models.loading import SHIPPED
from lightgesture.training.cnn import CnnTraining, read_originals
from lightgesture.training.kept_sources import kept_out
from lightgesture.training.patch_pool import rows_without

FOLDS = 5
SUBJECTS_ONE_IN = 5
COUNTS = (10, 30, 100, 200)
"""Numbers of training sources of the curve, before all of them."""


def folds(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """A net for each fold of the sources; the SVM's held-out answers, from its card, in the same folds."""
    number = np.array([fold_of(str(source), FOLDS) for source in study.sources])
    rows: Rows = []
    for fold in args.fold or range(FOLDS):
        held = number == fold
        # With few sources a fold may have none.
        if held.any():
            chosen = rows_without(study.pool, study.sources, held)
            rows.append(fit_row(study, f"cnn fold {fold}", chosen, held, training, folder))
    rows += mean_and_worst("cnn", rows)
    card = Path(args.svm_card)
    if card.is_file():
        svm = card_folds(card, FOLDS)
        rows += [*svm, *mean_and_worst("svm", svm)]
    return [Table("folds", f"{FOLDS} folds over the sources of hands/train", COLUMNS, tuple(rows), NOTE)]


def subjects(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """One net without some people of sources that are trained on, and if wanted the SVM likewise."""
    held = held_out_subjects([str(source) for source in study.sources], study.subjects, SUBJECTS_ONE_IN)
    if not held.any():
        raise InputError(f"{study.data}: names no source with two subjects or more; this study needs some")
    chosen = rows_without(study.pool, study.sources, held)
    rows = [fit_row(study, "cnn", chosen, held, training, folder)]
    if args.svm:
        rows.append(_svm_row(study, held, training, args))
    title = "Held-out subjects of sources that are trained on"
    return [Table("subjects", title, COLUMNS, tuple(rows), NOTE)]


def _svm_row(study: Study, held: Mask, training: CnnTraining, args: argparse.Namespace) -> dict[str, Cell]:
    """The SVM on the other hands, with the same backgrounds and scenes as the shipped one."""
    from lightgesture.models.svm import SvmClassifier
    from lightgesture.models.train_svm import SvmSettings, train_svm
    from lightgesture.training.stream import StreamSettings, stream

    originals = read_originals(training, ())
    hands = [study.hands[place] for place in np.flatnonzero(~held).tolist()]
    how = StreamSettings() if args.copies is None else StreamSettings(copies=min(args.copies, 10))
    samples = stream(hands, originals.backgrounds, originals.scenes, how, args.seed)
    say("svm: training")
    model, _ = train_svm(samples, SvmSettings(centres=args.centres), classes=study.classes, seed=args.seed)
    classifier = SvmClassifier(model)
    return {
        "row": "svm",
        "sources": len({hand.source for hand in hands}),
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
            originals = read_originals(training, study.rows)
        say(f"{name}: drawing its pool")
        pool = draw_pool(originals, settings, training, place / "pool", say)
        own = replace(study, pool=pool)
        rows.append(_on_sources(own, name, replace(training, pool=settings), place))
    return [Table("augmentation", "What each alteration of the pictures buys", COLUMNS, tuple(rows), NOTE)]


def sources(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """Nets of few and of many sources; each number's sources hold those of the smaller numbers."""
    held = kept_out(study.hands, training.one_in)
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
    held = kept_out(study.hands, training.one_in)
    return fit_row(study, name, rows_without(study.pool, study.sources, held), held, training, folder)


Kind = Callable[[Study, CnnTraining, Path, argparse.Namespace], list[Table]]
KINDS: dict[str, Kind] = {
    "folds": folds,
    "subjects": subjects,
    "outline": outline,
    "augmentation": augmentation,
    "sources": sources,
    "sizes": sizes,
}


def run(args: argparse.Namespace) -> None:
    """One study from the pool to its table."""
    from lightgesture.training.checkpoints import need_torch

    need_torch()
    training = replace(
        training_from(args),
        size=args.size,
        contours=args.outline,
        teachers=args.teachers,
        teacher_steps=args.teacher_steps,
        precision=args.precision,
    )
    study = open_study(find_data(args.data), Path(args.pool), training, say)
    folder = Path(args.pool) / "studies"
    folder.mkdir(parents=True, exist_ok=True)
    tables = KINDS[args.kind](study, training, folder, args)
    print_and_write(tables, args.out, asdict(training))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.reading_study",
        description="Trainings that tell what matters.",
    )
    kinds = parser.add_subparsers(dest="kind", required=True)
    parsers = {kind: kinds.add_parser(kind, help=make.__doc__) for kind, make in KINDS.items()}
    for own in parsers.values():
        add_data_argument(own)
        add_pool_arguments(own)
        own.add_argument(
            "--teachers", type=whole, default=0, metavar="N", help="larger nets to learn from (default 0)"
        )
        own.add_argument(
            "--teacher-steps", type=positive, default=2500, metavar="N", help="of each (default 2500)"
        )
        own.add_argument(
            "--precision", choices=PRECISIONS, default="float32", help="see train cnn (default float32)"
        )
        own.add_argument("--size", choices=SIZES, default="medium", help="of the net (default medium)")
        own.add_argument("--outline", action="store_true", help="the net looks at the outline's numbers, too")
        own.add_argument("--out", metavar="FILE.json", help="write rows and settings here, too")
    parsers["folds"].add_argument(
        "--fold", type=int, choices=range(FOLDS), action="append", help="this fold alone (repeatable)"
    )
    parsers["folds"].add_argument(
        "--svm-card",
        default=str(SHIPPED["svm"].with_suffix(".json")),
        metavar="JSON",
        help="whose answers to add",
    )
    parsers["subjects"].add_argument("--svm", action="store_true", help="train the SVM likewise")
    parsers["subjects"].add_argument(
        "--centres", type=positive, default=5000, metavar="N", help="of the SVM (default 5000)"
    )
    parsers["augmentation"].add_argument(
        "--only", choices=list(POOLS), action="append", help="this row alone (repeatable)"
    )
    parsers["sources"].add_argument(
        "--counts",
        type=positive,
        nargs="+",
        metavar="N",
        help=f"numbers of sources (default {COUNTS}, then all)",
    )
    return run_command(parser, argv, run)


if __name__ == "__main__":
    sys.exit(main())
