"""Numbers that a grammar file may set: one documented place for each, with its unit and effect."""

import math
from dataclasses import dataclass, replace
from typing import Final, Literal, Self

Rule = Literal["frames", "seconds", "evidence", "sentence"]
"""How it is told what was signed: by each sign on its own, held for long enough, or by the whole sentence."""

SENTENCE: Final = "sentence"

CARD_HOLD_S: Final = 0.3
"""How long a card is shown, or two cards rest after a motion, to count, seconds. What is read of them is hardly ever
wrong, so that it is less than a hand's hold. Less: a card counts that is only put away. More: slower."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Bounds of numbers; what lies outside is rejected with reason "limit".

    min_seconds, max_seconds: of a duration, seconds, both allowed. Ten minutes admit any number of
    three digits and refuse a fourth that was misread. max_times: of a number that says how often, at least 1.
    max_digits: of any number; max_words: of a sentence, 3 to 1000; one more rejects at once.
    """

    min_seconds: int = 1
    max_seconds: int = 600
    max_times: int = 20
    max_digits: int = 4
    max_words: int = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class DwellSettings:
    """When a sign counts.

    rule: "sentence", the best reading of the whole sentence, see `SentenceSettings`; "frames", an unbroken run of
    `hold` frames (the paper's); "seconds", an unbroken run of `hold_seconds`, whatever the camera's rate; "evidence",
    until the pair's seconds, weighed by their probability, less those of anything else, come to `hold_seconds`.
    hold: frames, 1 to 1000; hold_seconds: 0.05 to 60. More gives fewer false words and slower signing. release:
    fraction of the hold, 0 to 1 and at least one frame, that a pair must be absent before it counts again; less lets
    a flicker double a word. unread: how long, as a multiple of the hold, hands may be seen between two words without
    a word: more loses a sentence less often, and a sign of it more often. It must be less than a hold and two
    passages from sign to sign, and more than one passage. passage_s: seconds that they may be seen in any case, 0 to
    10: the longest passage, for holds that are shorter. count_hidden: whether time without a hand in view counts as
    well, for it may hide a sign; hands may then not be lowered inside a sentence. timeout_s: seconds without an
    accepted word that drop an open sentence.
    """

    rule: Rule = SENTENCE
    hold: int = 15
    hold_seconds: float = 0.5
    release: float = 0.2
    unread: float = 1.2
    passage_s: float = 0.5
    count_hidden: bool = False
    timeout_s: float = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SentenceSettings:
    """How the rule "sentence" reads."""

    caution: float = 1.0
    """How sure a sentence must be, 0.1 to 3: every bound is that many times as strict. Less issues more of what is
    meant, and more that is wrong."""
    hold_seconds: float = 0.4
    """Least length of a sign, seconds, 0.05 to 60. Less: signs may be shorter, and more is read in passing."""

    def changed(self, hold_seconds: float | None, caution: float | None) -> Self:
        """The same with what is given in its place. ValueError: out of range."""
        if hold_seconds is not None and not 0.0 < hold_seconds < math.inf:
            raise ValueError(f"hold_seconds is {hold_seconds:g}; use a number above 0, such as 0.4")
        if caution is not None and not 0.0 < caution < math.inf:
            raise ValueError(f"caution is {caution:g}; use a number above 0, such as 1")
        return replace(
            self,
            hold_seconds=self.hold_seconds if hold_seconds is None else hold_seconds,
            caution=self.caution if caution is None else caution,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Control:
    """Words that are no part of a sentence, and those that need a second end word; None and empty: there are none.

    cancel: drops the open sentence. kill: is heard in every state and issued at once. confirm: words whose sentences
    need the end word twice; the name of a word that carries a number stands for all of its numbers. confirm_unknown:
    so do sentences in which a pair was held that is no word, for it may have been a word that was misread.
    """

    cancel: str | None = None
    kill: str | None = None
    confirm: frozenset[str] = frozenset()
    confirm_unknown: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A setting of the robot: what INCREASE and DECREASE change it by, and from where to where.

    The decoder does not know its value and passes the change on; the robot reads these. None: not told.
    """

    name: str
    unit: str | None = None
    step: float | None = None
    minimum: float | None = None
    maximum: float | None = None
    default: float | None = None
