"""`lightgesture train regions`: the nets and trees that tell hands from the rest of a picture."""

import argparse
from pathlib import Path
from typing import Final

from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError
from lightgesture.training.commands.classifier import kept_text
from lightgesture.training.commands.train import PRECISIONS, model_path

KEPT: Final = {"classical": "nets", "learned": "classical trees", "verifier": "locator, refiner and trees"}
"""What each option that trains a part alone takes from the file that --start names."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "--data",
        required=True,
        metavar="DIR",
        help="data folder with hands/, webcam/, frames/ and negatives/ and their tables",
    )
    parser.add_argument(
        "--out", default="selector.npz", metavar="NPZ", help="selector file (default: selector.npz)"
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of all that is drawn (default: 0)")
    parser.add_argument(
        "--jobs", type=int, default=1, metavar="N", help="processes that compose (default: 1)"
    )
    parser.add_argument(
        "--steps",
        type=int,
        metavar="N",
        help="of the locator's training; the refiner's takes four fifths, the verifier's half as many (default: 10000)",
    )
    parser.add_argument(
        "--start",
        metavar="NPZ",
        help="selector whose nets go on learning, 'bundled' for the one that is used by default: a third of the steps "
        "suffices",
    )
    parser.add_argument(
        "--reader",
        default="cnn",
        metavar="NPZ",
        help="model of train look whose larger net the verifier learns on from (default: the bundled one)",
    )
    _add_parts_alone(parser)
    parser.add_argument(
        "--precision",
        choices=PRECISIONS,
        default="float32",
        help="of the training; bfloat16 is quicker on processors with instructions for it (avx512_bf16, amx)",
    )
    parser.add_argument(
        "--without",
        nargs="+",
        default=[],
        metavar="SOURCE",
        help="sources that are not trained on, for an evaluation on them",
    )
    parser.add_argument("--fold", metavar="I/N", help="leave out one fold of all sources too, such as 2/5")
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")


def _add_parts_alone(parser: argparse.ArgumentParser) -> None:
    alone = parser.add_mutually_exclusive_group()
    alone.add_argument(
        "--learned",
        action="store_true",
        help="train the learned choice alone; the classical one stays that of --start, which must be given",
    )
    alone.add_argument(
        "--classical",
        action="store_true",
        help="fit the trees of the classical choice alone; the rest stays that of --start, which must be given",
    )
    alone.add_argument(
        "--verifier",
        action="store_true",
        help="train the net that looks again at what is in doubt, and the trees of pairs with it; the rest stays that "
        "of --start, which must be given",
    )


def run(args: argparse.Namespace) -> int:
    """Train and write the selector and its card."""
    from lightgesture.features.find.selector_file import SelectorError
    from lightgesture.models import ModelError
    from lightgesture.training.pool.left_out import left_out
    from lightgesture.training.regions.nets import RegionTraining
    from lightgesture.training.regions.train import train_classical, train_regions, train_verifier
    from lightgesture.training.time_left import NeverSilent

    out = model_path(args.out)
    for name, value, least in (("seed", args.seed, 0), ("jobs", args.jobs, 1), ("steps", args.steps, 2)):
        if value is not None and value < least:
            raise UsageError(f"--{name} is {value}; it must be {least} or more")
    try:
        without = left_out(args.without, args.fold)
    except ValueError as error:
        raise UsageError(f"--fold: {error}") from error
    start = _start(args.start)
    for alone, kept in KEPT.items():
        if getattr(args, alone) and start is None:
            raise UsageError(
                f"--{alone} keeps the {kept} of another file; name it by --start, such as --start bundled"
            )
    settings = RegionTraining(precision=args.precision, start=start, reader=args.reader)
    if args.steps is not None:
        settings = settings.of_steps(args.steps)
    try:
        with NeverSilent((lambda _: None) if args.quiet else say) as progress:
            data = Path(args.data)
            if args.classical and start is not None:
                train_classical(data, out, start, args.seed, args.jobs, without, progress)
            elif args.verifier and start is not None:
                train_verifier(data, out, start, args.seed, args.jobs, without, settings, progress)
            else:
                train_regions(
                    *(data, out, args.seed, args.jobs, without, settings, progress),
                    keeps_classical=args.learned,
                )
    except SelectorError as error:
        raise UsageError(f"--start: {error}") from error
    except ModelError as error:
        raise UsageError(f"--reader: {error}") from error
    except KeyboardInterrupt:
        raise KeyboardInterrupt(kept_text(out)) from None
    return ExitStatus.OK


def _start(named: str | None) -> Path | None:
    from lightgesture.features.find.selector_file import BUNDLED

    return BUNDLED if named == "bundled" else Path(named) if named else None
