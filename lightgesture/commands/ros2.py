"""`lightgesture ros2`: a node of ROS 2."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import LIVE
    from lightgesture.config.options import add_options

    parser.add_argument(
        "--raw", action="store_true", help="subscribe Image on image, not CompressedImage on image/compressed"
    )
    parser.add_argument(
        "--managed",
        action="store_true",
        help="wait for a lifecycle manager to configure and activate the node (default: it does so by itself)",
    )
    add_options(parser, LIVE)
    parser.add_argument(
        "--ros-args",
        nargs=argparse.REMAINDER,
        default=[],
        metavar="...",
        help="the rest is for ROS: -r image/compressed:=/camera/image/compressed -r __ns:=/rov -p hold_seconds:=0.4",
    )


def run(args: argparse.Namespace) -> int:
    """Run the node until a signal or a transition ends it."""
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted
    from lightgesture.ros.node2 import run_node
    from lightgesture.ros.running import refuse_useless

    settings = load_settings(args)
    refuse_useless(settings)
    words = ["--ros-args", *args.ros_args] if args.ros_args else []
    with native_messages_muted():
        return run_node(settings, args.raw, args.managed, words)
