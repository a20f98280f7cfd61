"""Evidence over time that two regions are the hands of one person. Pure functions, in seconds and frames both.

A score of one frame says little: a red box on a table scores high now and then. A pair is believed once it scores
very high, or well for some frames in a row; which of two pairs is the better is told by mean scores.
"""

import math
from dataclasses import dataclass

from lightgesture.features.track.settings import TrackSettings


@dataclass(frozen=True, slots=True)
class PairEvidence:
    """What is known of a pair. level: mean score, the last frames counting most, 0 to 1. since_s, last_s: first and
    last time of the present run of sufficient scores. hits: frames in it."""

    level: float
    since_s: float
    last_s: float
    hits: int


def blend(level: float, value: float, step: float, memory_s: float) -> float:
    """The mean `level` after `value` was seen for `step` seconds, with the time constant `memory_s`."""
    return value + (level - value) * math.exp(-step / memory_s)


def observe(
    known: PairEvidence | None, score: float, now: float, step: float, least: float, settings: TrackSettings
) -> PairEvidence:
    """The evidence after a frame at `now` seconds in which the pair scored `score` (0: not both were seen).
    least: score that suffices."""
    level = score if known is None else blend(known.level, score, step, settings.memory_s)
    if score < least:
        return PairEvidence(level, now, now, 0) if known is None else _kept(known, level, now, settings)
    if known is None or known.hits == 0:
        return PairEvidence(level, now, now, 1)
    return PairEvidence(level, known.since_s, now, known.hits + 1)


def _kept(known: PairEvidence, level: float, now: float, settings: TrackSettings) -> PairEvidence:
    """A run outlives frames that are missed, but not for long."""
    ended = now - known.last_s > settings.tentative_s
    return PairEvidence(level, known.since_s, known.last_s, 0 if ended else known.hits)


def is_verified(evidence: PairEvidence, least: float, settings: TrackSettings) -> bool:
    """Whether the pair is believed: `least` exceeded by a good share, or reached for long enough."""
    if evidence.hits and evidence.level >= least + settings.sure_share * (1.0 - least):
        return True
    lasted = evidence.last_s - evidence.since_s >= settings.pair_s
    return evidence.hits >= settings.pair_frames and lasted and evidence.level >= least
