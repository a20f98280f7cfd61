"""Scripted candidates: what a selector might say of a frame, without a picture."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.track.state import begin
from lightgesture.features.types import Candidates, HandRegion
from tests.features.track_parts import NOW

SIZE = (640, 480)


@pytest.fixture(scope="session")
def region():
    """Makes a region from its centre and size, pixels."""

    def make(x, y, width=80, height=None, score=0.6, alternatives=()):
        height = width if height is None else height
        left, top = round(x - width / 2), round(y - height / 2)
        corners = [[left, top], [left + width, top], [left + width, top + height], [left, top + height]]
        box = (left, top, width, height)
        return HandRegion(box, np.array(corners, np.int32), None, score, alternatives)

    return make


@pytest.fixture(scope="session")
def frame():
    """Makes candidates from regions and the scores of their pairs; a number is the score of the first two."""

    def make(regions, pairs=None, size=SIZE, axis=None):
        scores = np.zeros((len(regions), len(regions)), np.float32)
        if isinstance(pairs, float):
            pairs = {(0, 1): pairs}
        for (first, second), score in (pairs or {}).items():
            scores[first, second] = scores[second, first] = score
        face = None if axis is None else (axis, 0.0)
        return Candidates(tuple(regions), scores, size, face)

    return make


@pytest.fixture(scope="session")
def sides():
    """Tells tracks by side: the centre's x of each that is seen in this frame, None where it is predicted."""

    def tell(tracks):
        return {track.side: None if track.missed else track.box[0] + track.box[2] / 2 for track in tracks}

    return tell


@pytest.fixture(scope="session")
def track(region):
    """Makes a track that is seen now, by default one that is followed."""

    def make(key=1, x=100, **changes):
        one = begin(key, key, region(x, 100), NOW)
        return replace(one, **{"number": key, "since_s": 0.0, "basis": "pair", "level": 0.75, **changes})

    return make
