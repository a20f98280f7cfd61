"""The command line: which command, and what becomes of its errors.

A command is a module with `add_arguments(parser)` and `run(args) -> int`, imported only when it is the one
that was asked for, so that `lightgesture --help` is quick and loads none of the heavy libraries.
"""

import argparse
import importlib
import importlib.util
import sys
from collections.abc import Callable, Collection, Sequence
from typing import Protocol, cast

from lightgesture._version import __version__
from lightgesture.console import ReaderGoneError, drop_output, fail, messages_shown, say
from lightgesture.errors import ExitStatus, InputError, UsageError, defect_of
from lightgesture.interruption import terminated_as_interrupted
from lightgesture.parser import Parser, parse

COMMANDS = {
    "decode": ("lightgesture.commands.decode", "videos, folders of frames and bags to instructions"),
    "live": ("lightgesture.commands.live", "a camera or a stream to instructions, as they are signed"),
    "ros2": ("lightgesture.commands.ros2", "a node of ROS 2: pictures of a topic in, instructions out"),
    "ros1": ("lightgesture.commands.ros1", "the same for ROS 1"),
    "recognize": ("lightgesture.commands.recognize", "single pictures to hands and their tokens"),
    "calibrate": ("lightgesture.commands.calibrate", "some seconds of open hands to a colour profile"),
    "signs": (
        "lightgesture.commands.signs",
        "the signs of the language or of a sentence, to read or to print",
    ),
    "practice": (
        "lightgesture.commands.practice",
        "sentences to sign before a camera, and what was read of them",
    ),
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
    "config": ("lightgesture.commands.config", "write a configuration file with every option"),
    "completion": ("lightgesture.commands.completion", "what a shell needs to complete commands and options"),
    "manual": ("lightgesture.commands.manual", "the man page"),
    "simulate": (
        "lightgesture.synth.pool.command",
        "a pool: diver, decoder, executor and vehicle; film and table",
    ),
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
    "mujoco": "sim",
    "pymavlink": "mavlink",
    "serial": "mavlink",
    "fpdf": "print",
    "gpiozero": "lamp",
    "pupil_apriltags": "tags",
    "pypdfium2": "tags",
}
"""Package that a command may lack, a later room or another's, to the extra that brings it."""


class Command(Protocol):
    """The interface of a command module."""

    def add_arguments(self, parser: argparse.ArgumentParser) -> None: ...

    def run(self, args: argparse.Namespace) -> int: ...


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
    with messages_shown():
        try:
            with terminated_as_interrupted():
                return work()
        except InputError as error:
            fail(str(error))
            return ExitStatus.SOME_FAILED
        except UsageError as error:
            fail(str(error))
            return ExitStatus.USAGE
        except ModuleNotFoundError as error:
            fail(_explain_missing(error))
            return ExitStatus.USAGE
        except KeyboardInterrupt as error:
            say(f"interrupted; {' '.join(map(str, error.args)) or interrupted}")
            return ExitStatus.INTERRUPTED
        except (ReaderGoneError, BrokenPipeError):
            drop_output()
            return ExitStatus.SOME_FAILED
        except Exception as error:
            fail(defect_of(error))
            return ExitStatus.SOME_FAILED


def _explain_missing(error: ModuleNotFoundError) -> str:
    """Which extra brings the package that is not there; one that no extra brings is a defect, and raised again."""
    name = error.name or ""
    for package, extra in EXTRAS.items():
        if name == package or name.startswith(f"{package}."):
            return f"{package} is needed and not installed; pip install 'lightgesture[{extra}]'"
    raise error


def make_parser(chosen: Collection[str]) -> Parser:
    """The parser of the command line, with the arguments of the commands that are `chosen`; the others are named."""
    parser = Parser(
        prog="lightgesture",
        description="Read a diver's two-handed signs in video and turn them into robot instructions.",
    )
    parser.add_argument("--version", action="version", version=f"lightgesture {__version__}")
    choices = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, (module, text) in COMMANDS.items():
        child = choices.add_parser(name, help=text, description=f"{name}: {text}")
        if name in chosen:
            command = cast(Command, importlib.import_module(module))
            command.add_arguments(child)
            child.set_defaults(run=command.run)
    return parser


def present_commands() -> list[str]:
    """Those whose modules are installed; a lean installation lacks later rooms."""
    return [name for name, (module, _) in COMMANDS.items() if _is_present(module)]


def _is_present(module: str) -> bool:
    try:
        return importlib.util.find_spec(module) is not None
    except ModuleNotFoundError:
        return False


def _run(argv: list[str]) -> int:
    # The options before the command take no value, so the first word without a dash is the command.
    chosen = next((word for word in argv if not word.startswith("-")), "")
    try:
        args = parse(make_parser([chosen]), argv)
    except SystemExit as leaving:  # --help and --version, printed
        return int(leaving.code or 0)
    try:
        return int(args.run(args))
    except KeyboardInterrupt as error:
        if error.args or args.command == "decode":
            raise
        raise KeyboardInterrupt("what was finished is kept") from None
