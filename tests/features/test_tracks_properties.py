"""What holds for any candidates at any time."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.track.births import is_verified, observe
from lightgesture.features.track.state import blend
from lightgesture.features.track.tracker import Tracker
from lightgesture.features.types import Candidates, HandRegion

PICTURE = (320, 240)
SCORE = st.floats(0.0, 1.0, width=32)
BOX = st.tuples(st.integers(-60, 330), st.integers(-60, 250), st.integers(-5, 120), st.integers(-5, 120))
TIME = st.one_of(st.floats(0.0, 3.0), st.sampled_from([math.nan, math.inf, -1.0, 1e12]))
OUTLINE = np.zeros((3, 2), np.int32)


@st.composite
def candidates(draw):
    boxes = draw(st.lists(st.tuples(BOX, SCORE, st.lists(BOX, max_size=2)), max_size=6))
    regions = tuple(HandRegion(box, OUTLINE, None, score, tuple(rest)) for box, score, rest in boxes)
    count = len(regions)
    scores = draw(st.lists(SCORE, min_size=count * count, max_size=count * count))
    pairs = np.triu(np.array(scores, np.float32).reshape(count, count), 1)
    face = draw(st.none() | st.tuples(st.floats(0, 320), st.floats(0, 240)))
    return Candidates(regions, pairs + pairs.T, PICTURE, face)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(candidates(), TIME, st.booleans()), max_size=25))
def test_at_most_one_track_a_side_and_no_number_comes_back(frames):
    tracker = Tracker()
    ended: set[int] = set()
    present: set[int] = set()
    for shown, time_s, whole in frames:
        assert len(tracker.predict(time_s)) <= 2
        tracker.explains(shown)
        tracks = tracker.update(shown, time_s, whole)
        assert len({track.side for track in tracks}) == len(tracks) <= 2
        numbers = {track.number for track in tracks}
        assert len(numbers) == len(tracks)
        ended |= present - numbers
        assert not numbers & ended
        present = numbers
        for track in tracks:
            assert 0.0 < track.certainty <= 1.0
            assert track.missed >= 0
            if track.missed:
                x, y, width, height = track.box
                assert 0 <= x < x + width <= PICTURE[0]
                assert 0 <= y < y + height <= PICTURE[1]


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(candidates(), st.floats(0.0, 0.4)), max_size=25))
def test_the_same_frames_give_the_same_tracks(frames):
    first, second = Tracker(), Tracker()
    time_s = 0.0
    for shown, step in frames:
        time_s += step
        assert first.update(shown, time_s) == second.update(shown, time_s)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(candidates(), candidates(), TIME | st.floats(0.0, 0.4), st.integers(0, 4)), max_size=25
    )
)
def test_what_was_asked_before_an_update_does_not_change_it(frames):
    asked, plain = Tracker(), Tracker()
    for shown, other, time_s, questions in frames:
        if questions:
            asked.predict(time_s if questions < 4 else time_s + 0.1)
        if questions > 1:
            asked.explains(other if questions == 3 else shown)
        assert asked.update(shown, time_s) == plain.update(shown, time_s)


@given(st.lists(st.floats(0.0, 0.1999), min_size=1, max_size=40), st.floats(0.001, 0.3))
def test_scores_below_the_threshold_never_verify_a_pair(scores, step):
    known = None
    for index, score in enumerate(scores):
        known = observe(known, score, index * step, step, 0.2)
        assert not is_verified(known, 0.2)


@given(SCORE, SCORE, st.floats(0.0, 5.0), st.integers(1, 9))
def test_a_mean_over_time_does_not_depend_on_how_the_time_is_divided(level, value, seconds, parts):
    blended = level
    for _ in range(parts):
        blended = blend(blended, value, seconds / parts)
    assert math.isclose(blended, blend(level, value, seconds), rel_tol=1e-9, abs_tol=1e-12)
    assert min(level, value) - 1e-9 <= blended <= max(level, value) + 1e-9
