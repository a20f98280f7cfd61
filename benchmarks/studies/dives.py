"""The finder on dives that it has not seen: `python -m lightgesture.benchmarks.studies.dives --parts DIR --start FILE
--reader FILE`.

The dives of the real divers are dealt into folds. For each fold a finder is trained from the rest, nets and trees, and
finds and reads the pictures of its own fold; the tables have every picture once. The finder must start from a file that
has seen no diver, or from random weights, and the verifier from a reader that has seen none (`--reader`). With
`--pool` a larger net is trained for each fold, too, that reads its pictures beside the small net of the model that is
named; without, that model reads, which may have seen all dives: what the tables say of reading counts for models alone
that have not.

What is done lies in the folder of parts, and the same command goes on there: composed pictures, the nets of each fold
and its selector, `foldN.npz`, which `evaluate divers --selector FILE --dive NAME` takes.
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from lightgesture.benchmarks.divers.pictures import DiverFrame, read_divers
from lightgesture.benchmarks.divers.report import evaluate_folds, save_rows
from lightgesture.benchmarks.divers.scoring import DiverMethod
from lightgesture.benchmarks.methods import reading_method
from lightgesture.benchmarks.progress import progress_bar
from lightgesture.benchmarks.studies.data import open_study, training_of
from lightgesture.benchmarks.studies.options import add_data_argument, print_and_write, run_command
from lightgesture.benchmarks.studies.places import second_look_without
from lightgesture.config.parsers import positive, whole
from lightgesture.console import say
from lightgesture.errors import UsageError
from lightgesture.features.find.selector_file import load_classical
from lightgesture.models import Classifier, load_classifier
from lightgesture.models.cnn import CnnClassifier
from lightgesture.models.loading import DEFAULT
from lightgesture.training.commands.train import PRECISIONS
from lightgesture.training.datasets import find_data, fold_of
from lightgesture.training.model_files import write_selector
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch
from lightgesture.training.pool.divers import SOURCE
from lightgesture.training.pool.left_out import LeftOut
from lightgesture.training.regions.learned import Pictures, learn_choice, read_pictures
from lightgesture.training.regions.nets import RegionTraining

FOLDS: Final = 5
"""Parts into which the dives are dealt."""
STEPS: Final = 1600
"""Of the locator of a fold, between a quarter and a third of those of the shipped one."""
LOOK_STEPS: Final = 6000
"""Of the larger net of a fold, a third of those of the shipped ones."""
VERIFIER_STEPS: Final = 1.5
"""Of the verifier over those of the locator: about half of those of the shipped one."""


def fold_of_dive(dive: str) -> int:
    """The fold that holds a dive out, 0 to `FOLDS` - 1."""
    return fold_of(f"{SOURCE} {dive}", FOLDS)


def fold_number(text: str) -> int:
    """A fold by its number; ArgumentTypeError for another word."""
    if text not in map(str, range(FOLDS)):
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to {FOLDS - 1}")
    return int(text)


def run(args: argparse.Namespace) -> None:
    """Train what is missing, then find and read every picture by the finder that has not seen its dive."""
    need_torch()
    data, parts = find_data(args.data), Path(args.parts)
    start = None if args.start is None else Path(args.start)
    settings = RegionTraining(precision=args.precision, start=start, reader=args.reader).of_steps(args.steps)
    settings = replace(settings, verifier_steps=round(VERIFIER_STEPS * args.steps))
    # Before pictures are composed, which takes minutes: a reader that does not serve is told at once.
    reader_of, frames = _readers(args, data), read_divers(data)
    pictures = read_pictures(data, LeftOut(), args.seed, args.jobs, parts, say)
    folds: list[tuple[DiverMethod, list[DiverFrame]]] = []
    for fold in args.fold or range(FOLDS):
        file = _selector(pictures, parts, fold, args.seed, settings)
        own = [frame for frame in frames if fold_of_dive(frame.dive) == fold]
        name, classifier = f"fold {fold}", reader_of(own)
        folds.append((DiverMethod(name, reading_method(name, classifier, str(file)), classifier), own))
    report, scored = evaluate_folds(folds, progress_bar)
    save_rows(parts, scored.hands, scored.frames)
    told = {"steps": args.steps, "start": settings.start_digest(), "reader": settings.reader_digest()}
    print_and_write(report.tables, args.out, {**told, "seed": args.seed})


def _readers(args: argparse.Namespace, data: Path) -> Callable[[Sequence[DiverFrame]], Classifier]:
    """What gives the reader of some pictures: the model that is named, or with a pool one that has not seen their
    dives."""
    known = load_classifier(args.model)
    if args.pool is None:
        return lambda _: known
    if not isinstance(known, CnnClassifier):
        raise UsageError(f"{args.model}: is no net; --pool trains a larger net beside a small one")
    folder, first = Path(args.pool) / "studies", known.model
    training = training_of(data, seed=args.seed, jobs=args.jobs, steps=args.look_steps, teachers=0)
    training = replace(training, precision=args.precision)
    study = open_study(data, Path(args.pool), training, say)
    folder.mkdir(parents=True, exist_ok=True)
    return lambda frames: CnnClassifier(second_look_without(study, first, frames, training, folder))


def _selector(pictures: Pictures, parts: Path, fold: int, seed: int, settings: RegionTraining) -> Path:
    """The file of a finder that has not seen the dives of a fold."""
    file = parts / f"fold{fold}.npz"
    told = {
        "seed": seed,
        "fold": fold,
        "settings": repr(replace(settings, start=None, reader="")),
        "start": settings.start_digest(),
        "reader": settings.reader_digest(),
    }
    folder = checkpoint_folder(file, told)
    if not file.is_file():
        say(f"fold {fold}: training a finder without its dives")
        rest = pictures.without_divers(lambda source: fold_of(source, FOLDS) == fold)
        write_selector(load_classical(), learn_choice(rest, folder, seed, settings, say), file)
    return file


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.studies.dives",
        description="The finder on dives of real divers that it has not seen.",
    )
    add_data_argument(parser)
    parser.add_argument(
        "--parts", required=True, metavar="DIR", help="folder of what is composed and trained"
    )
    parser.add_argument("--start", metavar="FILE", help="selector from which the nets go on; it saw no diver")
    parser.add_argument(
        "--steps", type=positive, default=STEPS, metavar="N", help=f"of each locator (default {STEPS})"
    )
    parser.add_argument(
        "--fold", type=fold_number, action="append", metavar="N", help="only this one; may be repeated"
    )
    parser.add_argument(
        "--reader",
        required=True,
        metavar="NPZ",
        help="model of train look whose larger net the verifier learns on from; it saw no diver",
    )
    parser.add_argument(
        "--model", default=DEFAULT, help="reads what is found; of --pool its small net (default cnn)"
    )
    parser.add_argument(
        "--pool",
        metavar="DIR",
        help="patches with divers, as train look leaves them: reads by larger nets that have not seen a fold's dives",
    )
    parser.add_argument(
        "--look-steps",
        type=positive,
        default=LOOK_STEPS,
        metavar="N",
        help=f"of each of them (default {LOOK_STEPS})",
    )
    parser.add_argument("--precision", choices=PRECISIONS, default="float32", help="see train regions")
    parser.add_argument(
        "--jobs", type=positive, default=1, metavar="N", help="processes that compose (default 1)"
    )
    parser.add_argument("--seed", type=whole, default=0, metavar="N", help="of all that is drawn (default 0)")
    parser.add_argument("--out", metavar="FILE.json", help="write rows and settings here, too")
    return run_command(parser, argv, run)


if __name__ == "__main__":
    sys.exit(main())
