"""What speaks against issuing the best reading of a complete sentence; every bound is made stricter by `caution`."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from lightgesture.fsm.language.forms import is_number
from lightgesture.fsm.rules.readings import Reading
from lightgesture.fsm.rules.search import Search

MARGIN: Final = 2.5
"""How far the best reading with another text must be behind, in units of score, at caution 1."""

WEAK: Final = 0.2
"""Least geometric mean probability of the less sure hand over the best window of each word, 0 to 1, at caution 1."""

START: Final = 0.6
"""The same of the first word: nothing before it speaks against it, so that whatever else was shown would be left out
of the sentence."""

NUMBER: Final = 0.7
"""The same of a digit, or of a word that carries a number, and of all numbers of a sentence together, as a product:
counts of fingers look alike, no table speaks against another number, and a number is as sure as all of its digits."""

END: Final = 0.6
"""The same of the end word, without which nothing is issued."""

MOST: Final = 0.9
"""What a sign needs at most, however great the caution: readers are hardly ever surer."""

MOST_END: Final = 0.75
"""What the end word needs at most: it is judged as soon as it comes."""

PASSED_S: Final = 0.38
"""Longest time between two signs with both hands in view, in which nothing was read, seconds, at caution 1."""

CLEAR_S: Final = 0.6
"""Seconds of clear frames, at caution 1, from which a number may be unclear for however long before and after. Else it
needs CLEAR_SHARE: a hand that is seen badly may look like another number for a moment."""

CLEAR_SHARE: Final = 0.5
"""Least share of clear frames in the time that such a number was shown and passed to and from, 0 to 1, at caution 1."""

MOST_CLEAR: Final = 0.6
"""What it needs at most: passages are never clear."""

CONTESTED: Final = 0.25
"""For how much of the time that a number was shown another one may be nearly as likely, 0 to 1, at caution 1."""

MISFIT: Final = 5.0
"""How far a reading may fall behind the free loop within one word and the passage before it, in units of score, at
caution 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Doubt:
    """Why a sentence is not issued: reason of the rejection, and where and what for the diver."""

    reason: str
    detail: str


def find_doubt(search: Search, slot: int, reading: Reading, caution: float) -> Doubt | None:
    """Why the reading in this slot, the best one and complete, may not be issued; None: it may."""
    if search.standing.margin(slot) < MARGIN * caution:
        return Doubt(
            reason="ambiguous", detail=f"it could as well be {search.standing.rival(slot)}; sign it again"
        )
    weak = find_weak(search.standing.certainties(slot), reading.words, caution)
    if weak is not None:
        return Doubt(reason="weak_sign", detail=f"{weak} was not seen well; sign it again")
    return _find_unclear(search, reading, caution) or _find_gap(search, slot, reading, caution)


def is_weak(word: str, certainty: float, caution: float, *, opens: bool = False) -> bool:
    """Whether a sign was seen too badly for its word to be issued. opens: the word is the first one."""
    least = START if opens else NUMBER if is_number(word) else WEAK
    return certainty < min(least * caution, MOST)


def find_weak(certainties: Sequence[float], words: Sequence[str], caution: float) -> str | None:
    """The first word of a complete sentence that was seen too badly, its end word before all others; where all its
    numbers are too unsure together, the least sure one."""
    if certainties[-1] < min(END * caution, MOST_END):
        return words[-1]
    seen = list(zip(words, certainties, strict=True))
    for place, (word, certainty) in enumerate(seen):
        if is_weak(word, certainty, caution, opens=place == 0):
            return word
    numbers = [(certainty, word) for word, certainty in seen if is_number(word)]
    together = math.prod(certainty for certainty, _ in numbers)
    return min(numbers)[1] if together < min(NUMBER * caution, MOST) else None


def _find_unclear(search: Search, reading: Reading, caution: float) -> Doubt | None:
    """The first number that was clear only for a moment in the time around it, or in which another one was seen."""
    least, clarity, spoken = min(CLEAR_SHARE * caution, MOST_CLEAR), search.clarity, reading.spoken
    for place, (clear_s, share) in enumerate(clarity.clear(spoken), start=1):
        word = reading.words[place]
        if not is_number(word):
            continue
        if clear_s < CLEAR_S * caution and share < least:
            return Doubt(reason="weak_sign", detail=f"{word} was not seen steadily; sign it again")
        if clarity.contested(spoken[place], spoken[place + 1]) > CONTESTED / caution:
            return Doubt(
                reason="ambiguous", detail=f"{word} looked like another number at times; sign it again"
            )
    return None


def _find_gap(search: Search, slot: int, reading: Reading, caution: float) -> Doubt | None:
    """Whether something was shown that the reading does not say."""
    passed_s = float(search.beam.longest[slot])
    if passed_s > PASSED_S / caution:
        return Doubt(
            reason="passed_over", detail=f"{passed_s:.1f} s between two signs were not read; sign it again"
        )
    behind, place = search.standing.misfit(slot)
    if behind > MISFIT / caution:
        return Doubt(
            reason="does_not_fit", detail=f"{reading.words[place]} is not what was shown; sign it again"
        )
    return None
