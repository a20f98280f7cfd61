"""`lightgesture completion`: what a shell needs to complete commands and options."""

import argparse

SHELLS = ("bash", "zsh", "tcsh")
"""Those that shtab writes for."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "shell", choices=SHELLS, help="shell that is to complete; its script goes to standard output"
    )


def run(args: argparse.Namespace) -> int:
    """Print the script."""
    from lightgesture.actions.completion import print_completion

    return print_completion(args.shell)
