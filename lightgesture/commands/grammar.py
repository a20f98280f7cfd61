"""`lightgesture grammar`: starts, checks, shows and draws a grammar file, and explains pairs or a recording."""

import argparse

INIT, EXPLAIN = "init", "explain"
DEFAULT_OUT = "grammar.svg"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, text in (
        (INIT, "write the bundled grammar to edit"),
        ("check", "name all that is wrong with the file; 2 where there is anything"),
        ("show", "print its signs, its table and its settings"),
        ("draw", "write its state graph as SVG or PNG"),
        (EXPLAIN, "walk through a sequence of pairs, or through a recording, step by step"),
    ):
        action = actions.add_parser(
            name, help=text, description=f"grammar {name}: {text}", allow_abbrev=False
        )
        if name == INIT:
            action.add_argument(
                "file", metavar="FILE", help="file to write; what is there is never overwritten"
            )
            continue
        if name == EXPLAIN:
            action.add_argument(
                "sequence",
                metavar="PAIRS|RECORDS.jsonl",
                help='pairs, the diver\'s left hand first, such as "ok,0 5,5 ok,ok"; each is held once and released. Or'
                " what `decode --frames --json` recorded: the readings of each sentence",
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

    if args.action == INIT:
        return grammar.init_grammar(args.file)
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
            return grammar.explain_signs(path, args.sequence)
