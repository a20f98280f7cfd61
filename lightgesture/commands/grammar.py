"""`lightgesture grammar`: starts, checks, shows and draws a grammar file, and explains pairs or a recording."""

import argparse

INIT, CHECK, SHOW, DRAW, EXPLAIN = "init", "check", "show", "draw", "explain"
ACTIONS = {
    INIT: "write the bundled grammar to edit",
    CHECK: "name all that is wrong with the file; 2 where there is anything",
    SHOW: "print its signs, its table and its settings",
    DRAW: "write its state graph as SVG or PNG",
    EXPLAIN: "walk through a sequence of pairs, or through a recording, step by step",
}
DEFAULT_OUT = "grammar.svg"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    for name, text in ACTIONS.items():
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
                " what `decode --rule sentence --frames --json` recorded: the readings of each sentence",
            )
        action.add_argument("file", nargs="?", metavar="FILE", help="grammar file (default: the bundled one)")
        action.add_argument("--grammar", metavar="FILE", help="the same, as the decoding commands have it")
        if name == DRAW:
            action.add_argument(
                "--out",
                metavar="FILE.svg|FILE.png",
                default=DEFAULT_OUT,
                help=f"picture to write (default: {DEFAULT_OUT})",
            )


def run(args: argparse.Namespace) -> int:
    """Do what was asked for; 0 when the grammar is sound, 2 when it is not."""
    from lightgesture.console import print_line
    from lightgesture.errors import ExitStatus, UsageError
    from lightgesture.fsm import GrammarError, load_grammar
    from lightgesture.grammar.report import check, explain, init, show

    if args.action == INIT:
        print_line(init(args.file))
        return ExitStatus.OK
    if args.file is not None and args.grammar is not None:
        raise UsageError(f"{args.file}, {args.grammar}: two grammars; name one")
    path = args.grammar if args.file is None else args.file
    try:
        if args.action == CHECK:
            lines, is_sound = check(path)
        else:
            grammar, is_sound = load_grammar(path), True
            if args.action == SHOW:
                lines = show(grammar)
            elif args.action == EXPLAIN:
                if args.sequence.endswith(".jsonl"):
                    from lightgesture.grammar.replay import explain_records

                    lines = explain_records(grammar, args.sequence)
                else:
                    lines = explain(grammar, args.sequence)
            else:
                from lightgesture.grammar.drawing import draw

                lines = [draw(grammar, args.out)]
    except GrammarError as error:
        raise UsageError(str(error)) from error
    for line in lines:
        print_line(line)
    return ExitStatus.OK if is_sound else ExitStatus.USAGE
