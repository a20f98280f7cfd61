"""When regions count as hands."""

from dataclasses import dataclass
from typing import Final

ALONE_CONFIDENCE: Final = 0.8
"""Factor on the confidence of a single hand, whose side is a guess."""


@dataclass(frozen=True, slots=True)
class SelectorSettings:
    """When regions count as hands. Scores are predicted overlaps (IoU) with a hand, 0 to 1."""

    pair_score: float = 0.2
    """Least score of a pair, 0 to 1. Lower finds more hands and more that are none."""
    single_score: float = 0.5
    """Least score of a region without a partner, 0 to 1."""


CLASSICAL: Final = SelectorSettings(pair_score=0.18, single_score=0.4)
"""For scores of the classical choice."""
LEARNED: Final = SelectorSettings(pair_score=0.4, single_score=0.5)
"""For scores of locator and refiner."""
