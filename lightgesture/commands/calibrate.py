"""`lightgesture calibrate`: some seconds of open hands to a colour profile."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import CALIBRATE
    from lightgesture.config.options import add_options
    from lightgesture.config.parsers import seconds

    parser.add_argument(
        "source",
        metavar="SOURCE",
        help="video, folder of frames, bag, or what `live` takes (camera, address, GStreamer pipeline, - for standard "
        "input), in which a diver shows both open hands",
    )
    parser.add_argument(
        "--out",
        dest="file",
        default="profile.json",
        metavar="FILE",
        help="profile to write (default: profile.json)",
    )
    parser.add_argument("--kind", choices=("skin", "glove"), default="skin", help="of hands (default: skin)")
    parser.add_argument(
        "--seconds",
        type=seconds,
        default=5.0,
        metavar="S",
        help="how much of the source is looked at, from its first picture (default: 5)",
    )
    parser.add_argument(
        "--hands",
        action="append",
        default=[],
        metavar="X,Y,W,H|middle",
        help="where a hand is held in every frame, for gloves that are not found by themselves: its box in pixels of "
        "the upright picture, once or for both hands, or the middle of the picture",
    )
    parser.add_argument("--force", action="store_true", help="write a profile that separates poorly too")
    add_options(parser, CALIBRATE)


def run(args: argparse.Namespace) -> int:
    """Learn, judge and write a profile; 1 where there are no hands or it separates poorly."""
    from lightgesture.actions.calibrate import run_calibrate
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted

    with native_messages_muted():
        return run_calibrate(
            args.source,
            load_settings(args),
            kind=args.kind,
            seconds=args.seconds,
            hands=args.hands,
            out=args.file,
            is_forced=args.force,
        )
