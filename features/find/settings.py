"""When a region counts as a hand."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SelectorSettings:
    """When a region counts as a hand. Scores are predicted overlaps (IoU) with a hand, 0 to 1.

    candidates: regions kept for pairing, 2 to 12; the time for pairs grows with the square.
    least_score: of a region that is kept at all, 0 to 0.2; what lies below costs time and is never believed.
    distinct_iou: candidates overlap at most this much.
    alternatives: most other extents kept with a candidate, 0 to 4; each is one more patch to read.
    alternative_iou: least overlap of another extent with the candidate.
    apart_iou: the two hands of a pair overlap at most this much.
    pair_score: least score of a pair. Lower finds more hands and more that are none.
    single_score: least score of a region without a partner.
    alone_confidence: factor on the confidence of a single hand, whose side is a guess.
    """

    candidates: int = 8
    least_score: float = 0.06
    distinct_iou: float = 0.3
    alternatives: int = 3
    alternative_iou: float = 0.35
    apart_iou: float = 0.1
    pair_score: float = 0.2
    single_score: float = 0.5
    alone_confidence: float = 0.8


CLASSICAL = SelectorSettings()
"""For scores of the classical choice."""
LEARNED = SelectorSettings(pair_score=0.3, single_score=0.52)
"""For scores of locator and refiner."""
