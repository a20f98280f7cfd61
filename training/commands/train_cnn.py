"""`lightgesture train cnn`: the small net that reads hand patches."""

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from lightgesture.config.parsers import whole
from lightgesture.errors import UsageError
from lightgesture.training.commands.classifier import (
    add_data_arguments,
    add_landmarks_argument,
    net_training,
    train_and_tell,
)
from lightgesture.training.commands.train import PRECISIONS, model_path

if TYPE_CHECKING:
    from lightgesture.training.nets.cnn import CnnTraining

SIZES = ("small", "medium", "large")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    add_data_arguments(parser)
    parser.add_argument("--out", default="cnn.npz", metavar="NPZ", help="model file (default: cnn.npz)")
    parser.add_argument(
        "--size",
        choices=SIZES,
        default="medium",
        help="of the net; a larger one reads better and takes longer",
    )
    parser.add_argument(
        "--outline", action="store_true", help="let the net look at the numbers of the hand's outline, too"
    )
    parser.add_argument("--steps", type=whole, metavar="N", help="of the training (default: 60000)")
    parser.add_argument(
        "--teachers",
        type=whole,
        metavar="N",
        help="larger nets that are learnt from; 0: learn from the labels alone (default: 2)",
    )
    parser.add_argument("--teacher-steps", type=whole, metavar="N", help="of each of these (default: 4000)")
    parser.add_argument(
        "--precision",
        choices=PRECISIONS,
        default="float32",
        help="of the training; bfloat16 takes two thirds of the time on processors with instructions for it "
        "(avx512_bf16, amx) and several times as long on others",
    )
    add_landmarks_argument(parser)
    parser.add_argument(
        "--synthetic", type=whole, metavar="N", help="rendered hands beside the real ones (default: 12000)"
    )
    parser.add_argument(
        "--jobs",
        type=whole,
        default=1,
        metavar="N",
        help="processes that draw, and larger nets that learn at a time (default: 1); changes nothing else",
    )


def run(args: argparse.Namespace) -> int:
    """Train, write the model and its card, and tell the scores of sources held out."""
    from lightgesture.training.nets.cnn import train_cnn_to_file

    out = model_path(args.out)
    training = _training(args)
    return train_and_tell(lambda progress: train_cnn_to_file(training, out, progress), out, args.quiet)


def _training(args: argparse.Namespace) -> "CnnTraining":
    training = net_training(args)
    for name in ("steps", "teacher_steps", "jobs", "copies"):
        if getattr(args, name) == 0:
            raise UsageError(f"--{name.replace('_', '-')} is 0; it must be 1 or more")
    training = replace(training, size=args.size, contours=args.outline)
    for name in ("steps", "teachers", "teacher_steps"):
        if (value := getattr(args, name)) is not None:
            training = replace(training, **{name: value})
    return training
