"""The command line: which command, and what becomes of its errors.

A command is a module with `add_arguments(parser)` and `run(args) -> int`, imported only when it is the one
that was asked for, so that `lightgesture --help` is quick and loads none of the heavy libraries.
"""

import argparse
import importlib
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn, Protocol, cast

from lightgesture._version import __version__
from lightgesture.console import ReaderGoneError, drop_output, say
from lightgesture.errors import ExitStatus, InputError, UsageError, defect_of
from lightgesture.interruption import terminated_as_interrupted

COMMANDS = {
    "decode": ("lightgesture.commands.decode", "videos, folders of frames and bags to instructions"),
    "live": ("lightgesture.commands.live", "a camera or a stream to instructions, as they are signed"),
    "recognize": ("lightgesture.commands.recognize", "single pictures to hands and their tokens"),
    "calibrate": ("lightgesture.commands.calibrate", "some seconds of open hands to a colour profile"),
    "doctor": (
        "lightgesture.commands.doctor",
        "what runs on this machine, how fast, and what to do about what does not",
    ),
    "train": ("lightgesture.training.commands.train", "build a model from labelled pictures"),
    "evaluate": (
        "lightgesture.benchmarks.commands.evaluate",
        "score the models and the whole chain on labelled pictures or rendered dives",
    ),
    "grammar": ("lightgesture.commands.grammar", "check, show, draw or explain a grammar file"),
    "tags": ("lightgesture.commands.tags", "print the book of cards, and read it back"),
    "motions": ("lightgesture.commands.motions", "shapes that moved cards draw: show them, record another"),
    "export": ("lightgesture.commands.export", "nets, trees and language as flat files for another language"),
    "synth": ("lightgesture.synth.command", "render dives of a synthetic diver with their truth"),
}
"""Name of a command to its module and its line of help.

By their paths, so that the application imports none of the rooms that are built on it.
"""


EXTRAS = {
    "lightgesture.training": "train",
    "lightgesture.synth": "train",
    "lightgesture.benchmarks": "train",
    "torch": "train",
    "sklearn": "train",
    "matplotlib": "plots",
    "dask": "cluster",
    "distributed": "cluster",
    "rosbags": "bag",
    "pymavlink": "mavlink",
    "serial": "mavlink",
    "pupil_apriltags": "tags",
    "fpdf": "print",
    "pypdfium2": "tags",
}
"""Package that a command may lack, a later room or another's, to the extra that brings it."""


class Command(Protocol):
    """The interface of a command module."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None: ...

    def run(self, args: argparse.Namespace) -> int: ...


class Parser(argparse.ArgumentParser):
    """Tells what is wrong in one line, without the usage."""

    def error(self, message: str) -> NoReturn:
        """Leave with the exit status of wrong usage."""
        raise UsageError(f"{message}; see {self.prog} --help")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit status.

    0: all good. 1: some inputs failed, or the reader of the results went away; the other inputs are done.
    2: wrong usage or configuration. 130: interrupted, by Ctrl-C or SIGTERM; the results of finished inputs are kept.
    """
    arguments = sys.argv[1:] if argv is None else list(argv)
    return exit_status(lambda: _run(arguments), "the results of finished inputs are kept")


def exit_status(work: Callable[[], int], interrupted: str) -> int:
    """Do the work of a command line and return its exit status, or that of the error that ended it, told in one line.

    interrupted: what becomes of the results when the user interrupts.
    """
    try:
        with terminated_as_interrupted():
            return work()
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    except UsageError as error:
        say(str(error))
        return ExitStatus.USAGE
    except ModuleNotFoundError as error:
        say(_explain_missing(error))
        return ExitStatus.USAGE
    except KeyboardInterrupt:
        say(f"interrupted; {interrupted}")
        return ExitStatus.INTERRUPTED
    except (ReaderGoneError, BrokenPipeError):
        drop_output()
        return ExitStatus.SOME_FAILED
    except Exception as error:
        say(defect_of(error))
        return ExitStatus.SOME_FAILED


def _explain_missing(error: ModuleNotFoundError) -> str:
    """Which extra brings the package that is not there; one that no extra brings is a defect, and raised again."""
    name = error.name or ""
    for package, extra in EXTRAS.items():
        if name == package or name.startswith(f"{package}."):
            return f"{package} is needed and not installed; pip install 'lightgesture[{extra}]'"
    raise error


def _run(argv: list[str]) -> int:
    parser = Parser(
        prog="lightgesture",
        description="Read a diver's two-handed signs in video and turn them into robot instructions.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"lightgesture {__version__}")
    choices = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    # The options before the command take no value, so the first word without a dash is the command.
    chosen = next((word for word in argv if not word.startswith("-")), None)
    for name, (module, text) in COMMANDS.items():
        child = choices.add_parser(name, help=text, description=f"{name}: {text}", allow_abbrev=False)
        if name == chosen:
            command = cast(Command, importlib.import_module(module))
            command.add_arguments(child)
            child.set_defaults(run=command.run)
    try:
        args = parser.parse_args(argv)
    except SystemExit as leaving:  # --help and --version, printed
        return int(leaving.code or 0)
    return int(args.run(args))
