"""What a reading of a sentence is."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Spoken:
    """A word of a reading: when its sign began, and how well it was seen.

    sure: geometric mean of the probabilities of the less sure hand over the best window of the least length, 0 to 1;
    of the last word, which grows, see `Standing.certainties`. behind: how far the reading was behind the free loop when
    the word began. fine: what the word cost for its place alone.
    """

    word: str
    column: int
    frame: int
    time_s: float
    behind: float
    fine: float
    began: float
    seen: float
    is_again: bool = False
    sure: float = 0.0


@dataclass(slots=True)
class Reading:
    """A hypothesis. began: when its first word did, seconds of the search. touched: when the last one entered.

    state: of the grammar's table; before: the state that the last word led from. longest:
    seconds that it had passed over before its last word. asked: words of which the diver was asked, at asked_s, to show
    the last sign again, so that they replace it.
    """

    spoken: tuple[Spoken, ...]
    state: int
    before: int
    began: float
    touched: float
    text: int
    words: tuple[str, ...]
    longest: float
    asked: frozenset[str] = frozenset()
    asked_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """What a reading said, for those who ask why.

    words: each with how well its sign was seen. behind: how far it was behind the free loop, in units of score.
    longest_s: seconds that it passed over with both hands in view. misfit: how far it fell behind within one word,
    `misfit_at`.
    """

    words: tuple[tuple[str, float], ...]
    behind: float
    longest_s: float
    misfit: float
    misfit_at: str
