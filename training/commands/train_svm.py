"""`lightgesture train svm`: the support vector machine that reads hand patches."""

import argparse
from dataclasses import replace
from pathlib import Path

from lightgesture.config.parsers import whole
from lightgesture.errors import UsageError
from lightgesture.training.commands.classifier import add_data_arguments, train_and_tell
from lightgesture.training.commands.train import model_path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    add_data_arguments(parser)
    parser.add_argument(
        "--synthetic",
        type=whole,
        default=0,
        metavar="N",
        help="rendered hands beside the real ones, or alone without --data (default: 0)",
    )
    parser.add_argument("--out", default="svm.npz", metavar="NPZ", help="model file (default: svm.npz)")
    parser.add_argument(
        "--centres",
        type=whole,
        metavar="N",
        help="vectors of the machine (default: 2000); size grows with them",
    )
    parser.add_argument("--steps", type=whole, metavar="N", help="of the training (default: 40000)")
    parser.add_argument(
        "--jobs",
        type=whole,
        default=1,
        metavar="N",
        help="processes that draw (default: 1); changes nothing else",
    )


def run(args: argparse.Namespace) -> int:
    """Train, write the model and its card, and tell the scores of sources held out."""
    from lightgesture.training.svm.machine import SvmSettings
    from lightgesture.training.svm.train import SvmTraining, train_svm_to_file
    from lightgesture.training.time_left import tenths

    if args.data is None and not args.synthetic:
        raise UsageError("nothing to train on; name pictures with --data or a number of rendered hands")
    for name in ("copies", "centres", "jobs"):
        if getattr(args, name) == 0:
            raise UsageError(f"--{name} is 0; it must be 1 or more")
    out = model_path(args.out)
    training = SvmTraining(
        data=Path(args.data) if args.data else None,
        backgrounds=tuple(Path(folder) for folder in args.backgrounds),
        scenes=Path(args.scenes) if args.scenes else None,
        divers=Path(args.divers) if args.divers else None,
        without=tuple(args.without),
        seed=args.seed,
        jobs=args.jobs,
    )
    pool, svm = replace(training.pool, rendered=args.synthetic), SvmSettings()
    if args.copies is not None:
        pool = replace(pool, copies=args.copies)
    if args.posed is not None:
        pool = replace(pool, posed=args.posed)
    if args.centres is not None:
        svm = replace(svm, centres=args.centres)
    if args.steps is not None:
        svm = replace(svm, steps=args.steps)
    training = replace(training, pool=pool, svm=svm)
    return train_and_tell(
        lambda progress: train_svm_to_file(training, out, tenths(progress)), out, args.quiet
    )
