"""What misreadings do to instructions, by the rule of dwell: signed sentences, wrong frames, and what is issued.

`python -m lightgesture.benchmarks.decoder_noise` simulates tokens, not pictures. Each hand of each frame goes wrong
with probability p, alone or in bursts: half of the wrong frames are unread, half show another token, the same one
through a burst. The bound beside the measured rate of wrong instructions is derived in `wrong_bound`.
"""

import argparse
import random
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from statistics import median

from lightgesture.benchmarks.suite_scenarios import LAND_LIST, WATER_LIST
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.console import print_line
from lightgesture.fsm import Decoder, Grammar, load_grammar
from lightgesture.fsm.settings import Rule

SENTENCES = tuple(sentence for sentence, _ in (*WATER_LIST, *LAND_LIST))
"""The 50 sentences of the suite."""


@dataclass(frozen=True, slots=True)
class NoiseSettings:
    """What is simulated. rate: frames a second. held, passage: frames of a sign and between two, drawn from the range.
    rates: shares of the frames in which a hand goes wrong. bursts: mean length of a run of wrong frames. repeats: times
    that every sentence is signed. right, wrong: range of the probability of a right and of a wrong token.
    """

    rate: float = 30.0
    held: tuple[int, int] = (21, 31)
    passage: tuple[int, int] = (7, 12)
    rates: tuple[float, ...] = (0.0, 0.01, 0.03, 0.1, 0.2)
    bursts: tuple[float, ...] = (1.0, 4.0, 10.0)
    repeats: int = 2
    right: tuple[float, float] = (0.85, 1.0)
    wrong: tuple[float, float] = (0.7, 0.9)
    seed: int = 20180521


@dataclass(frozen=True, slots=True)
class DwellRule:
    """A row of the table: its name and what makes its decoder. release, unread: as in the grammar file."""

    name: str
    rule: Rule = "frames"
    hold: int | None = None
    hold_seconds: float | None = None
    release: float = 0.2
    unread: float = 1.2

    def decoder(self, grammar: Grammar) -> Decoder:
        """A fresh decoder."""
        dwell = replace(grammar.dwell, rule=self.rule, release=self.release, unread=self.unread)
        return Decoder(replace(grammar, dwell=dwell), hold=self.hold, hold_seconds=self.hold_seconds)


RULES = (
    DwellRule("frames, 15", hold=15),
    DwellRule("seconds, 0.5", "seconds", hold_seconds=0.5),
    DwellRule("evidence, 0.3", "evidence", hold_seconds=0.3, release=0.5, unread=2.0),
    DwellRule("evidence, 0.4", "evidence", hold_seconds=0.4, release=0.5, unread=1.5),
    DwellRule("frames, 15, signs may get lost", hold=15, unread=100.0),
)
"""The limit of unread signing is 0.6 seconds in all but the last."""


@dataclass(slots=True)
class Outcome:
    """Counts over sentences. delays: seconds from the first frame of a sign to its acceptance."""

    signed: int = 0
    right: int = 0
    wrong: int = 0
    delays: list[float] = field(default_factory=list)


class Hand:
    """One hand's reading with its errors, a two-state Markov chain with the given share and mean length of bursts."""

    def __init__(self, tokens: Sequence[str], share: float, burst: float, rng: random.Random) -> None:
        self._tokens, self._rng = tokens, rng
        self._leave = 1.0 / burst
        self._enter = min(1.0, share / ((1.0 - share) * burst))
        self._is_wrong = False
        self._shown: str | None = None

    def read(self, true: str | None) -> tuple[str | None, bool]:
        """The token that is read of a hand that shows `true`, and whether it is wrong."""
        chance = self._rng.random()
        if self._is_wrong and chance < self._leave:
            self._is_wrong = False
            chance = self._rng.random()
        elif self._is_wrong:
            return self._shown, True
        if chance >= self._enter:
            return true, False
        self._is_wrong = True
        self._shown = None if self._rng.random() < 0.5 else self._rng.choice(self._tokens)
        return self._shown, True


def shown(
    sentence: str, grammar: Grammar, settings: NoiseSettings, rng: random.Random
) -> Iterator[tuple[str | None, str | None, int]]:
    """Tokens that the hands show frame by frame, and the number of the word; -1 on the way to it."""
    # The suite's sentences in the grammar's own words and signs; NumPy comes with the synthetic diver.
    from lightgesture.synth.script import sentence_words, word_pairs

    for index, ((left, right), _) in enumerate(word_pairs(grammar, sentence_words(sentence))):
        for _ in range(rng.randint(*settings.passage)):
            yield None, None, -1
        for _ in range(rng.randint(*settings.held)):
            yield left, right, index


def sign(
    sentence: str,
    rule: DwellRule,
    grammar: Grammar,
    share: float,
    burst: float,
    settings: NoiseSettings,
    rng: random.Random,
    outcome: Outcome,
) -> None:
    """Sign one sentence in front of a fresh decoder and count what comes of it."""
    decoder = rule.decoder(grammar)
    hands = [Hand(grammar.tokens, share, burst, rng) for _ in range(2)]
    issued: list[str] = []
    first, current = 0, -1
    for frame, (left, right, index) in enumerate(shown(sentence, grammar, settings, rng)):
        if index != current:
            first, current = frame, index
        seen = [hand.read(true) for hand, true in zip(hands, (left, right), strict=True)]
        chances = [rng.uniform(*(settings.wrong if is_wrong else settings.right)) for _, is_wrong in seen]
        events = decoder.step(
            seen[0][0], seen[1][0], frame / settings.rate, chances[0], chances[1], frame, True, True
        )
        for event in events:
            if event.type == "instruction":
                issued.append(event.text)
            elif event.type == "word" and index >= 0 and event.pair == (left, right):
                outcome.delays.append((frame - first) / settings.rate)
    outcome.signed += 1
    outcome.right += sentence in issued
    outcome.wrong += len([text for text in issued if text != sentence])


def wrong_bound(share: float, burst: float, words: float, settings: NoiseSettings, hold: int = 15) -> float:
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
    frames = words * (sum(settings.held) + sum(settings.passage)) / 2
    return min(1.0, frames * share / burst * (1.0 - 1.0 / burst) ** (hold - 1))


def measure(settings: NoiseSettings) -> Table:
    """The table of p against wrong, missed and median time to accept, for each rule and length of bursts."""
    grammar = load_grammar()
    words = (
        sum(len(sentence.replace("PARAM ", "PARAM_").split()) for sentence in SENTENCES) / len(SENTENCES)
        + 1.2
    )
    rows: list[dict[str, Cell]] = []
    for rule in RULES:
        for burst in settings.bursts:
            for share in settings.rates if burst == settings.bursts[0] else settings.rates[1:]:
                # Every rule is shown the same frames.
                rng = random.Random(f"{settings.seed} {burst} {share}")
                outcome = Outcome()
                for sentence in SENTENCES * settings.repeats:
                    sign(sentence, rule, grammar, share, burst, settings, rng, outcome)
                bound = wrong_bound(share, burst, words, settings) if rule is RULES[0] else None
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
        "unread; bound: most wrong instructions a sentence, derived in decoder_noise.py; accept_s: median seconds\n"
        "from a sign's first frame to its acceptance."
    )
    return Table("decoder_noise", "Instructions under misreadings", columns, tuple(rows), note)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.decoder_noise",
        description="Wrong and missed instructions against the rate of misreadings, by rule of dwell.",
    )
    repeats = NoiseSettings().repeats
    parser.add_argument(
        "--repeats",
        type=int,
        default=repeats,
        metavar="N",
        help=f"times that each sentence is signed (default {repeats})",
    )
    args = parser.parse_args(argv)
    print_line(to_text([measure(replace(NoiseSettings(), repeats=max(1, args.repeats)))]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
