"""`lightgesture manual`: the man page."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """It has none."""


def run(args: argparse.Namespace) -> int:  # noqa: ARG001 - likewise
    """Print it."""
    from lightgesture.actions.manual import print_manual

    return print_manual()
