"""`lightgesture train regions`: the trees that tell hands from the rest of a picture."""

import argparse
from pathlib import Path

from lightgesture.commands.train import model_path
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError


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
    parser.add_argument("--quiet", action="store_true", help="no progress on stderr")


def run(args: argparse.Namespace) -> int:
    """Train and write the selector and its card."""
    from lightgesture.training.regions import train_regions

    out = model_path(args.out)
    if args.seed < 0:
        raise UsageError(f"--seed is {args.seed}; it must be 0 or more")
    train_regions(Path(args.data), out, args.seed, progress=(lambda _: None) if args.quiet else say)
    return ExitStatus.OK
