"""What speaks against issuing the best reading of a complete sentence; every bound is made stricter by `caution`."""

from dataclasses import dataclass
from typing import Final

from lightgesture.fsm.rules.readings import Reading
from lightgesture.fsm.rules.search import Search

MARGIN: Final = 2.5
"""How far the best reading with another text must be behind, in units of score, at caution 1."""

WEAK: Final = 0.25
"""Least geometric mean probability of the less sure hand over the best window of each word, 0 to 1, at caution 1."""

END: Final = 0.4
"""The same of the end word, without which nothing is issued."""

MOST_END: Final = 0.6
"""What it is at most, however great the caution: the end word is judged as soon as it comes."""

PASSED_S: Final = 0.4
"""Longest time between two signs with both hands in view, in which nothing was read, seconds, at caution 1."""

MISFIT: Final = 4.0
"""How far a reading may fall behind the free loop within one word and the passage before it, in units of score, at
caution 1."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Doubt:
    """Why a sentence is not issued: reason of the rejection, and where and what for the diver."""

    reason: str
    detail: str


def find_doubt(search: Search, slot: int, reading: Reading, caution: float) -> Doubt | None:
    """Why the reading in this slot, the best one and complete, may not be issued; None: it may."""
    if search.margin(slot) < MARGIN * caution:
        return Doubt(reason="ambiguous", detail=f"it could as well be {search.rival(slot)}; sign it again")
    certainties = search.certainties(slot)
    place = min(range(len(certainties)), key=certainties.__getitem__)
    if certainties[-1] < min(END * caution, MOST_END):
        place = len(certainties) - 1
    elif certainties[place] >= WEAK * caution:
        return _find_gap(search, slot, reading, caution)
    return Doubt(reason="weak_sign", detail=f"{reading.words[place]} was not seen well; sign it again")


def _find_gap(search: Search, slot: int, reading: Reading, caution: float) -> Doubt | None:
    """Whether something was shown that the reading does not say."""
    passed_s = float(search.longest[slot])
    if passed_s > PASSED_S / caution:
        return Doubt(
            reason="passed_over", detail=f"{passed_s:.1f} s between two signs were not read; sign it again"
        )
    behind, place = search.misfit(slot)
    if behind > MISFIT / caution:
        return Doubt(
            reason="does_not_fit", detail=f"{reading.words[place]} is not what was shown; sign it again"
        )
    return None
