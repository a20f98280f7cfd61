"""`lightgesture train look`: a larger net for what a model doubts."""

import argparse
from dataclasses import replace
from pathlib import Path

from lightgesture.config.parsers import positive, whole
from lightgesture.training.commands.classifier import (
    add_data_arguments,
    add_landmarks_argument,
    net_training,
    train_and_tell,
)
from lightgesture.training.commands.train import PRECISIONS, model_path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    add_data_arguments(parser)
    parser.add_argument(
        "--first",
        default="cnn",
        metavar="NPZ",
        help="model whose small net is kept (default: the bundled one)",
    )
    parser.add_argument(
        "--beside",
        action="store_true",
        help="the larger nets of --first stay, too, and the mean of all counts (without: the new one alone)",
    )
    parser.add_argument("--out", default="cnn.npz", metavar="NPZ", help="model file (default: cnn.npz)")
    parser.add_argument(
        "--steps", type=positive, default=20000, metavar="N", help="of the larger net (default: 20000)"
    )
    parser.add_argument(
        "--precision", choices=PRECISIONS, default="float32", help="of the training, see train cnn"
    )
    add_landmarks_argument(parser)
    parser.add_argument(
        "--synthetic",
        type=whole,
        default=12000,
        metavar="N",
        help="rendered hands beside the real ones (default: 12000)",
    )
    parser.add_argument(
        "--jobs", type=positive, default=1, metavar="N", help="processes that draw (default: 1)"
    )


def run(args: argparse.Namespace) -> int:
    """Train, write the model and its card, and tell the scores of sources held out."""
    from lightgesture.models.loading import SHIPPED
    from lightgesture.training.nets.look import train_look_to_file

    training = replace(net_training(args), teacher_steps=args.steps)
    out, first = model_path(args.out), SHIPPED.get(args.first, Path(args.first))
    return train_and_tell(
        lambda progress: train_look_to_file(training, first, out, progress, beside=args.beside),
        *(out, args.quiet),
    )
