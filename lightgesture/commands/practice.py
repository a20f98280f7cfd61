"""`lightgesture practice`: sentences to sign before a camera, and what was read of them."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    from lightgesture.config.declaring import PRACTICE
    from lightgesture.config.options import add_options
    from lightgesture.config.parsers import positive, seconds, whole

    parser.add_argument(
        "source",
        nargs="?",
        default="0",
        metavar="SOURCE",
        help="camera or stream, as `live` takes, or a video or folder of frames (default: 0, the first camera)",
    )
    parser.add_argument(
        "--sentence",
        dest="sentences",
        action="append",
        default=[],
        metavar="TEXT",
        help='sentence to sign, such as "STOP HOVER 50 GO" (repeatable; default: some at random)',
    )
    parser.add_argument(
        "--count", type=positive, default=5, metavar="N", help="sentences at random (default: 5)"
    )
    parser.add_argument("--seed", type=whole, metavar="N", help="draw the same ones again")
    parser.add_argument(
        "--limit",
        type=seconds,
        default=60.0,
        metavar="S",
        help="seconds after which a sentence is given up, from the first hand in view (default: 60)",
    )
    parser.add_argument("--study", action="store_true", help="the six instructions of the paper's study")
    parser.add_argument(
        "--person", metavar="CODE", help="who signs, for --study: a code of letters and digits"
    )
    parser.add_argument(
        "--level",
        choices=("beginner", "medium", "expert"),
        default="beginner",
        help="how well the person knows the signs, for --study (default: beginner)",
    )
    parser.add_argument(
        "--out",
        dest="folder",
        default="practice",
        metavar="DIR",
        help="folder of the summary, JSON and picture, and of the study's table (default: practice)",
    )
    add_options(parser, PRACTICE)


def run(args: argparse.Namespace) -> int:
    """Practise until all is signed or the stream ends; 0, 1 if the stream was no use, or 130 after Ctrl-C."""
    from lightgesture.actions.practice import Plan, run_practice
    from lightgesture.config.options import load_settings
    from lightgesture.console import native_messages_muted

    plan = Plan(
        sentences=tuple(args.sentences),
        count=args.count,
        seed=args.seed,
        limit_s=args.limit,
        is_study=args.study,
        person=args.person,
        level=args.level,
        folder=args.folder,
    )
    settings = load_settings(args)
    with native_messages_muted():
        return run_practice(args.source, settings, plan)
