"""`lightgesture config`: a configuration file with every option of the decoding commands."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import DECODING
    from lightgesture.config.options import add_options

    parser.add_argument(
        "file",
        metavar="FILE",
        help="file to write, or - for standard output; what is there is never overwritten",
    )
    add_options(parser, *DECODING)


def run(args: argparse.Namespace) -> int:
    """Write the file; 0, or 2 where an option is wrong or the file is there."""
    from lightgesture.actions.config import write_config

    return write_config(args)
