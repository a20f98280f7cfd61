"""What misreadings do to instructions, by the rule of dwell: signed sentences, wrong frames, and what is issued.

`python -m lightgesture.benchmarks.decoder.noise` simulates tokens, not pictures. Each hand of each frame goes wrong
with probability p, alone or in bursts: half of the wrong frames are unread, half show another token, the same one
through a burst. The bound beside the measured rate of wrong instructions is derived in `wrong_bound`. A second table
has signs of which no hand is found, and pauses with lowered hands, which look the same.
"""

import argparse
import random
import sys
from collections.abc import Sequence
from statistics import median
from typing import Final

from lightgesture.benchmarks.decoder.signing import (
    HELD,
    HIDDEN_RULES,
    PASSAGE,
    RULES,
    SENTENCES,
    Absence,
    Outcome,
    sign,
)
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import print_line
from lightgesture.fsm import load_grammar

RATES: Final = (0.0, 0.01, 0.03, 0.1, 0.2)
"""Shares of the frames in which a hand goes wrong."""

BURSTS: Final = (1.0, 4.0, 10.0)
"""Mean length of a run of wrong frames."""

REPEATS: Final = 2
"""Times that every sentence is signed."""

SEED: Final = 20180521
"""Of all that is drawn."""


def wrong_bound(share: float, burst: float, words: float, hold: int = 15) -> float:
    """Most wrong instructions a sentence, for an unbroken hold of `hold` frames and the limit of unread signing.

    A lost sign alone gives none: its frames and those of both passages are more than the limit. Nor does a sign that
    is read twice: signs are held for less than two holds and a release. So an instruction can only be wrong if some
    hold of a pair that was not signed is long enough. All of it must lie in one burst that shows a token (half of
    them do), or in several that happen to show the same one, which is rarer by a factor of at least 20 a change. Bursts
    begin share / burst times a frame and hand, and last `hold` frames or more with the probability
    (1 - 1/burst)^(hold - 1), as their lengths are geometric. So the bound is 2 hands * frames of the sentence
    * share / (2 burst) * (1 - 1/burst)^(hold - 1), whatever the other hand shows and whether or not the pair is a
    word that fits.
    """
    frames = words * (sum(HELD) + sum(PASSAGE)) / 2
    return min(1.0, frames * share / burst * (1.0 - 1.0 / burst) ** (hold - 1))


def measure(repeats: int) -> Table:
    """The table of p against wrong, missed and median time to accept, for each rule and length of bursts."""
    grammar = load_grammar()
    words = (
        sum(len(sentence.replace("PARAM ", "PARAM_").split()) for sentence in SENTENCES) / len(SENTENCES)
        + 1.2
    )
    rows: list[dict[str, Cell]] = []
    for rule in RULES:
        for burst in BURSTS:
            for share in RATES if burst == BURSTS[0] else RATES[1:]:
                # Every rule is shown the same frames.
                rng = random.Random(f"{SEED} {burst} {share}")
                outcome = Outcome()
                for sentence in SENTENCES * repeats:
                    sign(sentence, rule, grammar, share, burst, rng, outcome)
                bound = wrong_bound(share, burst, words) if rule is RULES[0] else None
                rows.append(
                    {
                        "rule": rule.name,
                        "burst": burst,
                        "p": share,
                        "signed": outcome.signed,
                        "right": outcome.right,
                        "missed": outcome.signed - outcome.right,
                        "wrong": outcome.wrong,
                        "wrong_rate": outcome.wrong / outcome.signed,
                        "bound": bound,
                        "accept_s": median(outcome.delays) if outcome.delays else None,
                    }
                )
    columns = ("rule", "burst", "p", "signed", "right", "missed", "wrong", "wrong_rate", "bound", "accept_s")
    note = (
        "burst: mean length of a run of wrong frames; p: share of the frames in which a hand is wrong, half of them\n"
        "unread; bound: most wrong instructions a sentence, derived in decoder/noise.py; accept_s: median seconds\n"
        "from a sign's first frame to its acceptance."
    )
    return Table("decoder_noise", "Instructions under misreadings", columns, tuple(rows), note)


def measure_hidden(repeats: int) -> Table:
    """What comes of hidden signs and of pauses with lowered hands, where they count and where they do not."""
    grammar = load_grammar()
    rows: list[dict[str, Cell]] = []
    for rule in HIDDEN_RULES:
        for what in (Absence(hidden=0.05), Absence(pauses=0.05)):
            rng = random.Random(f"{SEED} {what.hidden} {what.pauses}")
            outcome = Outcome()
            for sentence in SENTENCES * repeats:
                sign(sentence, rule, grammar, 0.0, 1.0, rng, outcome, what)
            rows.append(
                {
                    "rule": rule.name,
                    "hidden": what.hidden,
                    "pauses": what.pauses,
                    "signed": outcome.signed,
                    "right": outcome.right,
                    "missed": outcome.signed - outcome.right,
                    "wrong": outcome.wrong,
                }
            )
    note = (
        "hidden: share of the signs of which no hand is found; pauses: share of the signs before which the hands are\n"
        "lowered for a second."
    )
    columns = ("rule", "hidden", "pauses", "signed", "right", "missed", "wrong")
    return Table("decoder_hidden", "Hidden signs", columns, tuple(rows), note)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.decoder.noise",
        description="Wrong and missed instructions against the rate of misreadings, by rule of dwell.",
    )
    parser.add_argument(
        "--repeats",
        type=int,
        default=REPEATS,
        metavar="N",
        help=f"times that each sentence is signed (default {REPEATS})",
    )
    args = parser.parse_args(argv)
    repeats = max(1, args.repeats)
    print_line(to_text([measure(repeats), measure_hidden(repeats)]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
