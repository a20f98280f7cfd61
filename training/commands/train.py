"""`lightgesture train`: build a model from labelled pictures."""

import argparse
import importlib
from pathlib import Path
from typing import Protocol, cast

from lightgesture.errors import UsageError

TARGETS = {
    "svm": (
        "lightgesture.training.commands.train_svm",
        "the classifier of hand patches without a net; needs no torch",
    ),
    "cnn": ("lightgesture.training.commands.train_cnn", "the small net that reads hand patches"),
    "look": (
        "lightgesture.training.commands.train_look",
        "a larger net for what a small net doubts; the small one is kept",
    ),
    "regions": (
        "lightgesture.training.commands.train_regions",
        "the selector that tells hands from the rest of a picture",
    ),
}
"""What can be trained: the module with its `add_arguments` and `run`, and its line of help."""


PRECISIONS = ("float32", "bfloat16")
"""Those of `training.nets.net_training`, which the commands do not import because it needs torch."""


class Target(Protocol):
    """The interface of a module of `TARGETS`."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None: ...

    def run(self, args: argparse.Namespace) -> int: ...


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what can be trained and the arguments of each."""
    choices = parser.add_subparsers(dest="target", metavar="MODEL", required=True)
    for name, (module, text) in TARGETS.items():
        child = choices.add_parser(name, help=text, description=f"train {name}: {text}", allow_abbrev=False)
        target = cast(Target, importlib.import_module(module))
        target.add_arguments(child)
        child.set_defaults(run_target=target.run)


def run(args: argparse.Namespace) -> int:
    """Train the chosen model; 0 when its files are written."""
    return int(args.run_target(args))


def model_path(text: str) -> Path:
    """The file to write, refused before hours are spent rather than after."""
    path = Path(text)
    if path.suffix != ".npz":
        raise UsageError(f"{text}: a model file ends in .npz; give another name with --out")
    if not path.parent.is_dir():
        raise UsageError(f"{path.parent}: no such folder; make it or give another path with --out")
    return path
