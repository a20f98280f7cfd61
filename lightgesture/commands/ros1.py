"""`lightgesture ros1`: a node of ROS 1."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import LIVE
    from lightgesture.config.options import add_options

    parser.add_argument(
        "words",
        nargs="*",
        metavar="NAME:=VALUE",
        help="for ROS: image/compressed:=/camera/image/compressed __ns:=/rov _hold_seconds:=0.4",
    )
    parser.add_argument(
        "--raw", action="store_true", help="subscribe Image on image, not CompressedImage on image/compressed"
    )
    add_options(parser, LIVE)


def run(args: argparse.Namespace) -> int:
    """Run the node until a signal ends it."""
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted
    from lightgesture.ros.node1 import run_node
    from lightgesture.ros.running import refuse_useless

    settings = load_settings(args)
    refuse_useless(settings)
    with native_messages_muted():
        return run_node(settings, args.raw, args.words)
