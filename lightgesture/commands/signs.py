"""`lightgesture signs`: the language, the signs of a sentence, and a card to print."""

import argparse


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "sentence",
        nargs="*",
        metavar="SENTENCE",
        help='sentence whose signs are shown, such as "STOP HOVER 50 GO" (default: the whole language)',
    )
    parser.add_argument("--grammar", metavar="FILE", help="grammar file (default: the bundled one)")
    parser.add_argument("--card", action="store_true", help="write a card of all words to take along, A5")
    parser.add_argument(
        "--out",
        metavar="FILE.pdf|png|svg",
        help="write what is shown with drawn hands (default: print it; of --card: card.svg); PDF needs"
        " lightgesture[print]",
    )
    parser.add_argument("--gloved", action="store_true", help="draw hands in gloves")


def run(args: argparse.Namespace) -> int:
    """Print or write what was asked for; 2 where the language cannot say it."""
    from lightgesture.actions.signs import show_signs

    return show_signs(
        " ".join(args.sentence), args.grammar, is_card=args.card, out=args.out, is_gloved=args.gloved
    )
