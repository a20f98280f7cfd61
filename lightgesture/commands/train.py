"""`lightgesture train`: build a model from labelled pictures."""

import argparse
import importlib
from typing import Protocol, cast

TARGETS = {
    "svm": ("lightgesture.commands.train_svm", "the classifier of hand patches, quick to train"),
    "regions": (
        "lightgesture.commands.train_regions",
        "the selector that tells hands from the rest of a picture",
    ),
}
"""What can be trained: the module with its `add_arguments` and `run`, and its line of help."""


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
