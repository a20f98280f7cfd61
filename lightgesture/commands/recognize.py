"""`lightgesture recognize`: single pictures to hands and their tokens."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import RECOGNIZE
    from lightgesture.config.options import add_options

    parser.add_argument("inputs", nargs="+", metavar="IMAGE", help="picture or glob")
    add_options(parser, RECOGNIZE)


def run(args: argparse.Namespace) -> int:
    """Recognize the pictures; 0 when all were read, 1 when some failed."""
    from lightgesture.actions.recognize import recognize
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted
    from lightgesture.sources import expand_inputs

    settings = load_settings(args)
    with native_messages_muted():
        return recognize(expand_inputs(args.inputs), settings)
