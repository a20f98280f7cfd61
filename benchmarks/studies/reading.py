"""What decides how well hands are read: `python -m lightgesture.benchmarks.studies.reading KIND --data DIR --pool DIR`.

folds: five nets, each without a fifth of the sources. subjects: people held out of sources that are trained on, the
paper's kind of test. outline: with and without the outline's numbers. augmentation: one alteration left out at a
time. sources: few people or many. sizes: three nets. steps: the learning curve. places: second looks at real
divers of places that nothing was learnt of. Every row is one training of
`train cnn` with a seed, from one pool (augmentation draws one for each row); what is done lies in the pool's folder,
and the same command goes on there.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

from lightgesture.benchmarks.studies.data import open_study
from lightgesture.benchmarks.studies.kinds import COUNTS, FOLDS, KINDS, POOLS, STEPS
from lightgesture.benchmarks.studies.options import (
    add_data_argument,
    add_pool_arguments,
    print_and_write,
    run_command,
    training_from,
)
from lightgesture.config.parsers import positive, whole
from lightgesture.console import say
from lightgesture.training.commands.train import PRECISIONS
from lightgesture.training.commands.train_cnn import SIZES
from lightgesture.training.datasets import find_data


def run(args: argparse.Namespace) -> None:
    """One study from the pool to its table."""
    from lightgesture.training.nets.checkpoints import need_torch

    svm_alone, svm = (getattr(args, name, False) for name in ("svm_alone", "svm"))
    if not svm_alone:
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
    settings = asdict(training)
    if svm or svm_alone:
        settings["svm"] = {"centres": args.svm_centres, "steps": args.svm_steps}
    print_and_write(tables, args.out, settings)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.studies.reading",
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
    for kind in ("folds", "subjects"):
        which = parsers[kind].add_mutually_exclusive_group()
        which.add_argument("--svm", action="store_true", help="train the SVM likewise")
        which.add_argument("--svm-alone", action="store_true", help="train no net, only the SVM")
        parsers[kind].add_argument(
            "--svm-steps", type=positive, default=10000, metavar="N", help="of the SVM (default 10000)"
        )
        parsers[kind].add_argument(
            "--svm-centres", type=positive, default=1000, metavar="N", help="of the SVM (default 1000)"
        )
    parsers["places"].add_argument(
        "--first",
        default="cnn",
        metavar="NPZ",
        help="model whose small net is kept (default: the bundled one)",
    )
    parsers["places"].add_argument(
        "--group",
        action="append",
        metavar="PLACE[,PLACE]",
        help="places that are held out together (repeatable; default: each alone)",
    )
    parsers["augmentation"].add_argument(
        "--only", choices=list(POOLS), action="append", help="this row alone (repeatable)"
    )
    for kind, words in (("sources", f"{COUNTS}, then all"), ("steps", f"{STEPS}")):
        parsers[kind].add_argument(
            "--counts", type=positive, nargs="+", metavar="N", help=f"numbers of {kind} (default {words})"
        )
    return run_command(parser, argv, run)


if __name__ == "__main__":
    sys.exit(main())
