"""`lightgesture grammar`: checks a grammar file, shows its table, draws its states, explains a sequence of pairs."""

import argparse

DEFAULT_OUT = "grammar.svg"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, text in (
        ("check", "name all that is wrong with the file; 2 where there is anything"),
        ("show", "print its signs, its table and its settings"),
        ("draw", "write its state graph as SVG or PNG"),
        ("explain", "walk through a sequence of pairs step by step"),
    ):
        action = actions.add_parser(
            name, help=text, description=f"grammar {name}: {text}", allow_abbrev=False
        )
        if name == "explain":
            action.add_argument(
                "sequence",
                metavar="PAIRS",
                help='pairs, the diver\'s left hand first, such as "ok,0 5,5 ok,ok"; each is held once and released',
            )
        action.add_argument("file", nargs="?", metavar="FILE", help="grammar file (default: the bundled one)")
        action.add_argument("--grammar", metavar="FILE", help="the same, as the decoding commands have it")
        if name == "draw":
            action.add_argument(
                "--out",
                metavar="FILE.svg|FILE.png",
                default=DEFAULT_OUT,
                help=f"picture to write (default: {DEFAULT_OUT})",
            )


def run(args: argparse.Namespace) -> int:
    """Do what was asked for; 0 when the grammar is sound, 2 when it is not."""
    from lightgesture.actions import grammar
    from lightgesture.errors import UsageError

    if args.file is not None and args.grammar is not None:
        raise UsageError(f"{args.file}, {args.grammar}: two grammars; name one")
    path = args.grammar if args.file is None else args.file
    match args.action:
        case "check":
            return grammar.check_grammar(path)
        case "show":
            return grammar.show_grammar(path)
        case "draw":
            return grammar.draw_grammar(path, args.out)
        case _:
            return grammar.explain_pairs(path, args.sequence)
