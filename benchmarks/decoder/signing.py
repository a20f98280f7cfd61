"""Sentences signed to a decoder as tokens that go wrong, get hidden or pause, and what is issued."""

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from lightgesture.benchmarks.suite.scenarios import LAND_LIST, WATER_LIST
from lightgesture.fsm import Decoder, Grammar, Sign, Signs
from lightgesture.fsm.language.settings import Rule

SENTENCES = tuple(sentence for sentence, _ in (*WATER_LIST, *LAND_LIST))
"""The 50 sentences of the suite."""


RATE: Final = 30.0
"""Frames a second."""

HELD, PASSAGE = (21, 31), (7, 12)
"""Frames of a sign and between two, drawn from the range."""

RIGHT, WRONG = (0.85, 1.0), (0.7, 0.9)
"""Range of the probability of a right and of a wrong token."""

PAUSE: Final = 30
"""Frames for which hands are lowered in a pause."""


@dataclass(frozen=True, slots=True)
class Absence:
    """How often no hand is there to be found."""

    hidden: float = 0.0
    """Share of the signs of which no hand is found."""
    pauses: float = 0.0
    """Share of the signs before which hands are lowered for a while."""


NO_ABSENCE = Absence()


@dataclass(frozen=True, slots=True)
class DwellRule:
    """A row of the table: its name and what makes its decoder. release and those below: as in the grammar file."""

    name: str
    rule: Rule = "frames"
    hold: int | None = None
    hold_seconds: float | None = None
    release: float = 0.2
    unread: float = 1.2
    count_hidden: bool = False

    def decoder(self, grammar: Grammar) -> Decoder:
        """A fresh decoder."""
        dwell = replace(
            grammar.dwell,
            rule=self.rule,
            release=self.release,
            unread=self.unread,
            count_hidden=self.count_hidden,
        )
        return Decoder(replace(grammar, dwell=dwell), hold=self.hold, hold_seconds=self.hold_seconds)


RULES = (
    DwellRule("frames, 15", hold=15),
    DwellRule("seconds, 0.5", "seconds", hold_seconds=0.5),
    DwellRule("evidence, 0.3", "evidence", hold_seconds=0.3, release=0.5, unread=2.0),
    DwellRule("evidence, 0.4", "evidence", hold_seconds=0.4, release=0.5, unread=1.5),
    DwellRule("frames, 15, signs may get lost", hold=15, unread=100.0),
    DwellRule("seconds, 0.5, signs may get lost", "seconds", hold_seconds=0.5, unread=100.0),
    DwellRule("evidence, 0.4, signs may get lost", "evidence", hold_seconds=0.4, release=0.5, unread=100.0),
)
"""The limit of unread signing is 0.6 seconds where signs do not get lost."""

HIDDEN_RULES = tuple(
    replace(rule, name=f"{rule.name}, hidden signs {told}", count_hidden=is_counted)
    for rule in RULES
    if rule.name in ("frames, 15", "evidence, 0.4")
    for told, is_counted in (("get lost", False), ("counted", True))
)


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
    sentence: str, grammar: Grammar, absence: Absence, rng: random.Random
) -> Iterator[tuple[str | None, str | None, bool, int]]:
    """Frame by frame the hands' tokens, whether they are in view, and the number of the word; -1 on the way to it."""
    # The suite's sentences in the grammar's own words and signs; NumPy comes with the synthetic diver.
    from lightgesture.synth.script import sentence_words, word_pairs

    for index, ((left, right), _) in enumerate(word_pairs(grammar, sentence_words(sentence))):
        for _ in range(rng.randint(*PASSAGE)):
            yield None, None, True, -1
        if absence.pauses and rng.random() < absence.pauses:
            yield from [(None, None, False, -1)] * PAUSE
        is_hidden = absence.hidden > 0.0 and rng.random() < absence.hidden
        for _ in range(rng.randint(*HELD)):
            yield (None, None, False, index) if is_hidden else (left, right, True, index)


def sign(
    sentence: str,
    rule: DwellRule,
    grammar: Grammar,
    share: float,
    burst: float,
    rng: random.Random,
    outcome: Outcome,
    absence: Absence = NO_ABSENCE,
) -> None:
    """Sign one sentence in front of a fresh decoder and count what comes of it."""
    decoder = rule.decoder(grammar)
    hands = [Hand(grammar.tokens, share, burst, rng) for _ in range(2)]
    issued: list[str] = []
    first, current = 0, -1
    for frame, (left, right, is_seen, index) in enumerate(shown(sentence, grammar, absence, rng)):
        if index != current:
            first, current = frame, index
        seen = [hand.read(true) for hand, true in zip(hands, (left, right), strict=True)]
        chances = [rng.uniform(*(WRONG if is_wrong else RIGHT)) for _, is_wrong in seen]
        hands_shown = [
            Sign(read, chance, seen=is_seen) for (read, _), chance in zip(seen, chances, strict=True)
        ]
        events = decoder.step(Signs(*hands_shown), frame / RATE, frame)
        for event in events:
            if event.type == "instruction":
                issued.append(event.text)
            elif event.type == "word" and index >= 0 and event.pair == (left, right):
                outcome.delays.append((frame - first) / RATE)
    outcome.signed += 1
    outcome.right += sentence in issued
    outcome.wrong += len([text for text in issued if text != sentence])
