"""`lightgesture decode`: videos, folders of frames and bags to instructions."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import DECODE
    from lightgesture.config.options import add_options

    parser.add_argument(
        "inputs",
        nargs="*",
        metavar="INPUT",
        help="video, bag, folder of videos or of frames (natural order), - (standard input) or glob; none: the bundled "
        "clip",
    )
    add_options(parser, DECODE)


def run(args: argparse.Namespace) -> int:
    """Decode the inputs; 0 when all were, 1 when some failed."""
    from lightgesture.actions.decode import decode
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted
    from lightgesture.sources import expand_inputs

    settings = load_settings(args)
    with native_messages_muted():
        return decode(expand_inputs(args.inputs), settings)
