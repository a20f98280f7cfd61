"""What the commands that train a classifier share: the hands that the user names, and what is told of the model."""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from lightgesture.config.parsers import whole
from lightgesture.console import say
from lightgesture.errors import ExitStatus, UsageError

if TYPE_CHECKING:
    from lightgesture.training.nets.cnn import CnnTraining

MOST: Final = 10.0
"""Largest weight of the landmarks."""


def add_data_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare them."""
    parser.add_argument(
        "--data",
        metavar="CSV|DIR",
        help="manifest with the columns path and token, and if known a box (x,y,w,h or hx0..hy1), lm, set, side; "
        "or a folder with one folder of hand pictures a class",
    )
    parser.add_argument(
        "--backgrounds",
        action="append",
        default=[],
        metavar="DIR",
        help="pictures without hands: they stand behind altered copies and teach what is no token; repeatable",
    )
    parser.add_argument(
        "--scenes",
        metavar="CSV",
        help="whole pictures with boxes (columns file,x,y,w,h, if known face_boxes and set): what lies beside "
        "the hands teaches what is no token",
    )
    parser.add_argument(
        "--divers",
        metavar="CSV",
        help="pictures of real divers with boxes (columns file,sequence,kind,x,y,w,h,shape): their hands, and what dry "
        "hands look like on a dive",
    )
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="SOURCE",
        help="source of the manifest (column set) or dive (column sequence) that is left out; repeatable",
    )
    parser.add_argument(
        "--copies",
        type=whole,
        metavar="N",
        help="altered copies of each hand, and a third as many mild ones (default: 16); time and disk grow",
    )
    parser.add_argument(
        "--posed",
        type=whole,
        metavar="N",
        help="rendered hands in the poses of real ones, if `world_NAME.npz` beside the manifest NAME.csv tells their "
        "joints (default: none)",
    )
    parser.add_argument(
        "--seed", type=whole, default=0, metavar="N", help="of all that is drawn (default: 0)"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress and no summary on stderr")


def add_landmarks_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the weight of the second task of a net's training."""
    parser.add_argument(
        "--landmarks",
        type=_weight,
        metavar="WEIGHT",
        help="of the 21 landmarks that a net learns besides where they are known (column lm, rendered hands), such as "
        "0.3; the model holds nothing of it (default: 0, classes alone)",
    )


def _weight(text: str) -> float:
    value = float(text)
    if not 0.0 <= value <= MOST:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to {MOST:g}")
    return value


def kept_text(out: Path) -> str:
    """What becomes of an interrupted training of the model `out`."""
    folder = out.with_suffix(".parts")
    if not folder.is_dir():
        return "nothing was drawn or learnt yet"
    return f"{folder} keeps what was drawn and learnt; the same command goes on there"


def net_training(args: argparse.Namespace) -> "CnnTraining":
    """The training of a net on the hands that the arguments name. UsageError: they name none."""
    from lightgesture.training.nets.cnn import CnnTraining

    if args.data is None:
        raise UsageError("nothing to train on; name a manifest or a folder of pictures with --data")
    training = CnnTraining(
        data=Path(args.data),
        backgrounds=tuple(Path(folder) for folder in args.backgrounds),
        scenes=Path(args.scenes) if args.scenes else None,
        divers=Path(args.divers) if args.divers else None,
        without=tuple(args.without),
        seed=args.seed,
        jobs=args.jobs,
        precision=args.precision,
    )
    if args.landmarks is not None:
        training = replace(training, landmarks=args.landmarks)
    pool = training.pool
    if args.copies is not None:
        pool = replace(pool, copies=args.copies)
    if args.posed is not None:
        pool = replace(pool, posed=args.posed)
    if args.synthetic is not None:
        pool = replace(pool, rendered=args.synthetic)
    return replace(training, pool=pool)


def train_and_tell(
    train: Callable[[Callable[[str], None]], dict[str, Any]], out: Path, quiet: bool
) -> ExitStatus:
    """Train, then tell what its card says of the model in `out`.

    train: takes what tells the progress, and gives the card. quiet: tell nothing. Raises UsageError for samples that
    will not do, and what `train` raises.
    """
    from lightgesture.models import ModelError
    from lightgesture.training.card import summary
    from lightgesture.training.time_left import NeverSilent

    try:
        with NeverSilent((lambda _: None) if quiet else say) as progress:
            card = train(progress)
    except ModelError as error:
        raise UsageError(str(error)) from error
    except KeyboardInterrupt:
        raise KeyboardInterrupt(kept_text(out)) from None
    if not quiet:
        for line in summary(card, out):
            say(line)
    return ExitStatus.OK
