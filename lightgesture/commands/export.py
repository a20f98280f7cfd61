"""`lightgesture export`: nets, trees, language and constants as flat files for a port to another language."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "folder",
        metavar="DIR",
        help="folder to write: a new or an empty one, or one that export wrote before",
    )
    parser.add_argument(
        "--model", metavar="PATH", help="your own model file, instead of the shipped one of its kind"
    )
    parser.add_argument("--grammar", metavar="FILE", help="grammar file (default: the bundled one)")


def run(args: argparse.Namespace) -> int:
    """Write the folder; 0 when all of it is there, 2 when nothing is."""
    from pathlib import Path

    from lightgesture.actions.export import export
    from lightgesture.console import native_messages_muted, say
    from lightgesture.errors import ExitStatus

    with native_messages_muted():
        count = export(Path(args.folder), args.model, args.grammar)
    say(f"{args.folder}: wrote {count} files; README.md there tells how to read them")
    return ExitStatus.OK
