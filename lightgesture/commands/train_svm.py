"""`lightgesture train svm`: the support vector machine that reads hand patches."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from lightgesture.commands.hand_data import add_data_arguments, count
from lightgesture.commands.train import model_path
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    add_data_arguments(parser)
    parser.add_argument(
        "--synthetic",
        type=count,
        default=0,
        metavar="N",
        help="rendered hands beside the real ones, or alone without --data (default: 0)",
    )
    parser.add_argument("--out", default="svm.npz", metavar="NPZ", help="model file (default: svm.npz)")
    parser.add_argument(
        "--copies",
        type=count,
        metavar="N",
        help="altered copies of each hand, and a third as many mild ones (default: 24); time and disk grow",
    )
    parser.add_argument(
        "--centres",
        type=count,
        metavar="N",
        help="vectors of the machine (default: 2000); size grows with them",
    )
    parser.add_argument("--steps", type=count, metavar="N", help="of the training (default: 40000)")
    parser.add_argument(
        "--jobs",
        type=count,
        default=1,
        metavar="N",
        help="processes that draw (default: 1); changes nothing else",
    )
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary on stderr")


def run(args: argparse.Namespace) -> int:
    """Train, write the model and its card, and tell the scores of sources held out."""
    from lightgesture.models import ModelError
    from lightgesture.models.train_svm import SvmSettings
    from lightgesture.training.card import summary
    from lightgesture.training.svm import SvmTraining, train_svm_to_file

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
        without=tuple(args.without),
        seed=args.seed,
        jobs=args.jobs,
    )
    pool, svm = replace(training.pool, rendered=args.synthetic), SvmSettings()
    if args.copies is not None:
        pool = replace(pool, copies=args.copies)
    if args.centres is not None:
        svm = replace(svm, centres=args.centres)
    if args.steps is not None:
        svm = replace(svm, descent=replace(svm.descent, steps=args.steps))
    try:
        with StepBars(args.quiet) as bars:
            card = train_svm_to_file(replace(training, pool=pool, svm=svm), out, bars.show)
    except ModelError as error:
        raise UsageError(str(error)) from error
    if not args.quiet:
        for line in summary(card, out):
            say(line)
    return ExitStatus.OK


class StepBars:
    """A progress bar for one step after the other on stderr; where that is no terminal, a line for every tenth."""

    def __init__(self, quiet: bool) -> None:
        from lightgesture.training.time_left import tenths

        self._quiet = quiet
        self._lines = None if sys.stderr.isatty() else tenths(say)
        self._step = ""
        self._bar: Any = None

    def __enter__(self) -> "StepBars":
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    def show(self, step: str, done: int, total: int) -> None:
        """`done` of `total` of a step are done; a total of 0 is not known."""
        if self._quiet:
            return
        if self._lines is not None:
            self._lines(step, done, total)
            return
        if step != self._step:
            from tqdm import tqdm

            self._close()
            self._bar = tqdm(desc=step, total=total or None, leave=False)
            self._step = step
        self._bar.update(done - self._bar.n)

    def _close(self) -> None:
        if self._bar is not None:
            self._bar.close()
