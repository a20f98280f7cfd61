"""Tracks and what is looked at, made up for tests of the pure functions of tracking.

Times and scores are sums of binary fractions where what lies on a bound matters.
"""

import numpy as np

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.track.matching import Observed, PairScore

LEAST, MARGIN, NOW, GATE = 0.25, 0.125, 8.0, 13.3
SELECTION = SelectorSettings(pair_score=0.25, single_score=0.5)
LESS = 1e-9


def sees(regions=(), pairs=()):
    """What is looked at: regions by number, and (score, first, second) of verified pairs."""
    scores = np.zeros((9, 9))
    for score, first, second in pairs:
        scores[first, second] = scores[second, first] = score
    return Observed(dict(regions), scores.tolist(), tuple(PairScore(*pair) for pair in pairs))


def new(track, key, **changes):
    """A region under observation."""
    return track(key, number=0, basis="none", **changes)
