"""`lightgesture tags`: prints the book of cards, and reads it back."""

import argparse

PRINT = "print"
DEFAULT_OUT = "cards.pdf"
DEFAULT_SIDE_MM = 80.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    texts = {
        PRINT: "write the book of a grammar's cards as PDF, A6 with cut marks",
        "check": "read a book back from its own pixels; 1 where a card is missing or doubled",
    }
    for name, text in texts.items():
        action = actions.add_parser(name, help=text, description=f"tags {name}: {text}", allow_abbrev=False)
        if name == PRINT:
            action.add_argument(
                "--out",
                metavar="FILE.pdf",
                default=DEFAULT_OUT,
                help=f"file to write (default: {DEFAULT_OUT})",
            )
            action.add_argument(
                "--side",
                metavar="MM",
                type=float,
                default=DEFAULT_SIDE_MM,
                help=f"of the black square of a tag, 20 to 84 mm (default: {DEFAULT_SIDE_MM:g})",
            )
        else:
            action.add_argument("file", metavar="FILE", help="PDF, or a picture of cards")
            action.add_argument(
                "--tag-detector",
                choices=("aruco", "apriltag"),
                default="aruco",
                help="what reads it (default: aruco)",
            )
        action.add_argument("--grammar", metavar="FILE", help="grammar file (default: the bundled one)")


def run(args: argparse.Namespace) -> int:
    """Print or check the book."""
    from lightgesture.actions import tags

    if args.action == PRINT:
        return tags.print_book(args.grammar, args.out, args.side)
    return tags.check_book(args.grammar, args.file, args.tag_detector)
