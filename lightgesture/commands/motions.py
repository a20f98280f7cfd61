"""`lightgesture motions`: shows the shapes that moved cards draw, and records another from a clip."""

import argparse

RECORD = "record"
DEFAULT_FILE = "shapes.json"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    texts = {
        RECORD: "add the shape that is drawn in a clip to a file of shapes",
        "show": "print the shapes and the words that are made of them",
    }
    for name, text in texts.items():
        action = actions.add_parser(
            name, help=text, description=f"motions {name}: {text}", allow_abbrev=False
        )
        if name == RECORD:
            action.add_argument(
                "clip", metavar="CLIP", help="video or folder of frames in which one motion is made"
            )
            action.add_argument("name", metavar="NAME", help="of the shape, such as hook")
            action.add_argument(
                "--side",
                choices=("left", "right"),
                help="whose card draws it (default: the only one that moves)",
            )
            action.add_argument(
                "--mirrored", action="store_true", help="the picture is mirrored, as that of a selfie camera"
            )
        else:
            action.add_argument("--out", metavar="FILE.png", help="draw them too")
        action.add_argument(
            "--shapes",
            metavar="FILE",
            default=DEFAULT_FILE if name == RECORD else None,
            help="file of shapes of your own" + (f" (default: {DEFAULT_FILE})" if name == RECORD else ""),
        )
        action.add_argument("--grammar", metavar="FILE", help="grammar file (default: the bundled one)")


def run(args: argparse.Namespace) -> int:
    """Record or show."""
    from lightgesture.actions import motions

    if args.action == RECORD:
        return motions.record_shape(args.clip, args.name, args.shapes, args.grammar, args.side, args.mirrored)
    return motions.show_shapes(args.shapes, args.grammar, args.out)
