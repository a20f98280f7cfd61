"""What `completion` does: the whole command line as a script that completes it in a shell."""

import argparse
from typing import Final

from lightgesture.cli import make_parser, present_commands
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus
from lightgesture.parser import arguments, children

FILES: Final = frozenset(
    {"FILE", "INPUT", "IMAGE", "SOURCE", "PATH", "NPZ", "CSV", "SCENE", "VIDEO", "PAIRS"}
)
FOLDERS: Final = frozenset({"DIR", "FOLDER"})
"""Words in the metavar of an argument that names a file, or a folder."""


def print_completion(shell: str) -> ExitStatus:
    """Print the script of a shell, of `commands.completion.SHELLS`."""
    import shtab

    parser = make_parser(present_commands())
    _say_what_is_a_file(parser, shtab.FILE, shtab.DIRECTORY)
    print_line(shtab.complete(parser, shell=shell))
    return ExitStatus.OK


def _say_what_is_a_file(parser: argparse.ArgumentParser, file: object, folder: object) -> None:
    """Tell shtab which arguments name files and folders, and which are one of a few words."""
    for action in arguments(parser):
        words = str(action.metavar or "").split("|")
        if any(word.split(".")[0] in FILES for word in words):
            action.complete = file  # type: ignore[attr-defined]
        elif FOLDERS & set(words):
            action.complete = folder  # type: ignore[attr-defined]
        elif (
            action.choices is None
            and len(words) > 1
            and all(word.islower() or word.isdigit() for word in words)
        ):
            action.choices = words
    for _, child, _ in children(parser):
        _say_what_is_a_file(child, file, folder)
