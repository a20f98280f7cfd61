"""What our classifiers are compared with: `python -m lightgesture.benchmarks.studies.baselines contours|paper`.

contours: the textbook's way, the numbers of the hand's outline (Hu moments, hull, defects, radial signature) and a
radial machine, without gradients. It is written as a model file, a further row for `evaluate hands --model FILE`.
paper: the float network of the paper, trained on the pool of patches of `train cnn`.
Both are trained on `hands/train` and scored on `hands/val`; neither is shipped.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.reading.hands import (
    by_source_table,
    by_token_table,
    classify,
    confusion_table,
    summary_table,
)
from lightgesture.benchmarks.studies.options import (
    add_data_argument,
    add_pool_arguments,
    print_and_write,
    run_command,
    training_from,
)
from lightgesture.benchmarks.tables import Table
from lightgesture.config.parsers import positive
from lightgesture.console import say
from lightgesture.features.hog import HogSettings
from lightgesture.features.vector import VectorSettings
from lightgesture.models.svm import SvmClassifier
from lightgesture.training.datasets import find_data, read_hands
from lightgesture.training.model_files import write_svm_model
from lightgesture.training.pool.originals import Originals
from lightgesture.training.pool.patch_kinds import MARGIN, PATCH
from lightgesture.training.svm.machine import SvmSettings, train_svm
from lightgesture.training.time_left import tenths

CONTOURS, PAPER = "contours", "paper"


def contour_settings(centres: int, steps: int) -> SvmSettings:
    """The shipped machine's, without gradients: these are reckoned in the fewest cells, and none is kept."""
    features = VectorSettings(hog=HogSettings(rim=0, cell=16))
    return SvmSettings(features=features, directions=0, centres=centres, steps=steps)


def run_contours(args: argparse.Namespace) -> None:
    """Train on the pool, write the model file, score it on `hands/val`."""
    from lightgesture.benchmarks.studies.data import open_study
    from lightgesture.training.pool.pool_samples import pool_samples

    training = training_from(args)
    data = find_data(args.data)
    study = open_study(data, Path(args.pool), training, say)
    samples = pool_samples(
        study.pool,
        Originals(study.hands),
        np.ones(len(study.pool.tokens), bool),
        np.ones(len(study.hands), bool),
        training.pool,
        args.seed,
    )
    settings = contour_settings(args.centres, args.steps)
    model, _ = train_svm(samples, settings, classes=study.classes, seed=args.seed, progress=tenths(say))
    write_svm_model(model, Path(args.out))
    say(f"wrote {args.out}")
    tables = val_tables(SvmClassifier(model), CONTOURS, data)
    print_and_write(tables, args.json, {"centres": args.centres, "steps": args.steps, "seed": args.seed})


def run_paper(args: argparse.Namespace) -> None:
    """Train on the pool and score on `hands/val`."""
    from lightgesture.training.nets.checkpoints import need_torch

    need_torch()
    from lightgesture.benchmarks.paper.net import PaperNetClassifier, train_paper_net
    from lightgesture.benchmarks.studies.data import open_study

    training = training_from(args)
    data = find_data(args.data)
    study = open_study(data, Path(args.pool), training, say)
    net = train_paper_net(study.pool, MARGIN, study.classes, args.steps, args.seed, say)
    classifier = PaperNetClassifier(net, study.classes, PATCH)
    say(f"{classifier.weights} weights")
    tables = val_tables(classifier, "paper's network", data)
    print_and_write(
        tables, args.json, {"steps": args.steps, "seed": args.seed, "weights": classifier.weights}
    )


def val_tables(classifier: Classifier, name: str, data: Path) -> list[Table]:
    """The tables of `evaluate hands` that are about `hands/val`."""
    answers = classify(classifier, read_hands(data))
    sure = [answer for answer in answers if not answer.sample.doubtful]
    return [
        summary_table([("hands val", answers), ("hands val, none doubtful", sure)], name),
        by_token_table(answers, name),
        by_source_table(answers, name),
        confusion_table(answers, name),
    ]


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.studies.baselines",
        description="Train and score what we compare with.",
    )
    kinds = parser.add_subparsers(dest="kind", required=True)
    contours = kinds.add_parser(CONTOURS, help="numbers of the outline alone, with a radial machine")
    add_data_argument(contours)
    add_pool_arguments(contours)
    contours.add_argument(
        "--out", default="contours.npz", metavar="NPZ", help="model file (default: contours.npz)"
    )
    contours.add_argument(
        "--centres", type=positive, default=1000, metavar="N", help="of the machine (default 1000)"
    )
    contours.set_defaults(run=run_contours)
    paper = kinds.add_parser(PAPER, help="the paper's network in floating point; needs torch")
    add_data_argument(paper)
    add_pool_arguments(paper)
    paper.set_defaults(run=run_paper)
    for kind in (contours, paper):
        kind.add_argument("--json", metavar="FILE", help="write the rows here, too")
    return run_command(parser, argv, lambda args: args.run(args))


if __name__ == "__main__":
    sys.exit(main())
