"""`lightgesture simulate`: the pool."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lightgesture.synth.pool.plans import Plan

MOST_RANDOM = 1000
"""Most sentences by chance."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    parser.add_argument(
        "--sentence",
        action="append",
        metavar="TEXT",
        help='what is signed, e.g. "STOP HOVER 50 GO" (repeatable, a trial each; default: the six of the study)',
    )
    parser.add_argument(
        "--random", type=int, default=0, metavar="N", help="sentences drawn by chance besides; default 0"
    )
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of what is drawn; default 1")
    parser.add_argument(
        "--difficulty", type=float, default=0.2, metavar="D", help="0 calm and clear .. 1 hard; default 0.2"
    )
    parser.add_argument(
        "--current",
        type=float,
        nargs=2,
        default=(0.0, 0.02),
        metavar=("NORTH", "EAST"),
        help="of the water, m/s; default 0 0.02",
    )
    parser.add_argument(
        "--obey",
        metavar="FILE",
        help="profile of the vehicle (default: that of the pool, synth/pool/pool.toml)",
    )
    parser.add_argument("--config", metavar="FILE", help="options of the decoder, as of lightgesture live")
    parser.add_argument("--out", metavar="DIR", default="pool", help="folder of film and table; default pool")
    parser.add_argument("--no-film", action="store_true", help="the table alone")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")


def run(args: argparse.Namespace) -> int:
    """Run the trials, write film and table; 0 when all are done."""
    from pathlib import Path

    from lightgesture.config.opening import make_folder
    from lightgesture.console import native_messages_muted, print_line
    from lightgesture.errors import ExitStatus, UsageError
    from lightgesture.synth.pool.results import describe, write_tables
    from lightgesture.synth.pool.session import Session

    if not 0.0 <= args.difficulty <= 1.0 or not 0 <= args.random <= MOST_RANDOM or args.seed < 0:
        raise UsageError(
            f"--difficulty must be 0 to 1, --random 0 to {MOST_RANDOM}, --seed 0 or more; change what is not"
        )
    if max(map(abs, args.current)) > 1.0:
        raise UsageError("--current: the vehicle cannot hold against more than 1 m/s; give less")
    plans = _plans(args)
    make_folder(args.out)
    folder = Path(args.out)
    with native_messages_muted(), Session(args.obey, args.config, tuple(args.current)) as session:
        rows = session.run(plans, None if args.no_film else folder / "pool.mp4", args.quiet)
    write_tables(rows, folder)
    for line in describe(rows):
        print_line(line)
    return ExitStatus.OK


def _plans(args: argparse.Namespace) -> list[Plan]:
    """What is to be tried. UsageError: a sentence that cannot be signed."""
    from lightgesture.errors import UsageError
    from lightgesture.fsm import load_grammar
    from lightgesture.synth.pool.plans import make_plan, random_plans, study_plans
    from lightgesture.synth.script import sentence_words, word_pairs

    grammar = load_grammar()
    for sentence in args.sentence or ():
        try:
            word_pairs(grammar, sentence_words(sentence))
        except ValueError as error:
            raise UsageError(f"--sentence {sentence}: {error}") from None
    given = [
        make_plan(f"s{order + 1}", (sentence,), args.seed + order, args.difficulty)
        for order, sentence in enumerate(args.sentence or ())
    ]
    plans = given or study_plans(args.difficulty)
    return plans + random_plans(args.random, args.seed, args.difficulty)
