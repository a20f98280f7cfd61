"""Two tracks: births, sides, crossing, loss, and clocks that misbehave."""

import numpy as np
import pytest

from lightgesture.features.tracks import TrackStage, assign
from lightgesture.features.types import Candidates, HandRegion

SIZE = (640, 480)
STEP = 1 / 30


def _region(x, y, side=80, score=0.6):
    contour = np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]], np.int32)
    return HandRegion((x, y, side, side), contour, None, score)


def _frame(regions, together=0.0, size=SIZE):
    count = len(regions)
    pairs = np.full((count, count), together, np.float32)
    np.fill_diagonal(pairs, 0.0)
    return Candidates(tuple(regions), pairs, size)


def _sides(tracks):
    return {track.side: track.box[0] for track in tracks}


def test_a_believed_pair_is_followed_at_once_with_the_divers_right_at_image_left():
    tracks = TrackStage().process(_frame([_region(420, 100), _region(120, 110)], together=0.8), 0.0)
    assert _sides(tracks) == {"right": 120, "left": 420}
    assert [track.missed for track in tracks] == [0, 0]


def test_a_pair_below_the_threshold_makes_no_track():
    assert TrackStage().process(_frame([_region(120, 100), _region(420, 100)], together=0.05), 0.0) == ()


def test_a_region_alone_needs_repeated_evidence():
    stage = TrackStage()
    counts = [len(stage.process(_frame([_region(100, 100, score=0.9)]), index * STEP)) for index in range(4)]
    assert counts == [0, 0, 1, 1]


def test_a_region_that_jumps_about_is_no_repeated_evidence():
    stage = TrackStage()
    places = [50, 400, 60, 410, 55, 420]
    for index, x in enumerate(places):
        assert stage.process(_frame([_region(x, 100, score=0.9)]), index * STEP) == ()


def test_hands_that_cross_keep_their_sides_and_numbers():
    stage = TrackStage()
    numbers = set()
    for index in range(40):
        right, left = _region(120 + 8 * index, 90), _region(440 - 8 * index, 250)
        tracks = stage.process(_frame([right, left], together=0.8), index * STEP)
        numbers |= {track.number for track in tracks}
    assert _sides(tracks) == {"right": 120 + 8 * 39, "left": 440 - 8 * 39}
    assert numbers == {1, 2}


def test_a_track_bridges_a_short_gap_and_ends_after_a_long_one():
    stage = TrackStage()
    both = _frame([_region(120, 100), _region(420, 100)], together=0.8)
    stage.process(both, 0.0)
    gap = stage.process(_frame([]), STEP)
    assert [track.missed for track in gap] == [1, 1]
    assert all(track.alternatives == () for track in gap)
    assert stage.process(_frame([]), 0.9) == ()
    fresh = stage.process(both, 0.95)
    assert {track.number for track in fresh} == {3, 4}


def test_a_better_pair_elsewhere_replaces_what_was_locked():
    stage = TrackStage()
    stage.process(_frame([_region(40, 300), _region(560, 310)], together=0.4), 0.0)
    regions = [_region(40, 300), _region(560, 310), _region(200, 100), _region(400, 100)]
    pairs = np.zeros((4, 4), np.float32)
    pairs[0, 1] = pairs[1, 0] = 0.4
    pairs[2, 3] = pairs[3, 2] = 0.95
    tracks = stage.process(Candidates(tuple(regions), pairs, SIZE), STEP)
    assert _sides(tracks) == {"right": 200, "left": 400}


def test_memory_keeps_a_pair_whose_score_dips():
    stage = TrackStage()
    regions = [_region(120, 100), _region(420, 100)]
    stage.process(_frame(regions, together=0.6), 0.0)
    tracks = stage.process(_frame(regions, together=0.2), STEP)
    assert [track.missed for track in tracks] == [0, 0]


@pytest.mark.parametrize("times", [[0.0, 0.0, 0.0], [1.0, 0.5, 0.2], [0.0, 50.0, 100.0]])
def test_time_that_stands_still_runs_back_or_leaps_raises_nothing(times):
    stage = TrackStage()
    for time_s in times:
        tracks = stage.process(_frame([_region(120, 100), _region(420, 100)], together=0.8), time_s)
    assert _sides(tracks) == {"right": 120, "left": 420}


def test_a_frame_of_another_size_starts_anew():
    stage = TrackStage()
    stage.process(_frame([_region(120, 100), _region(420, 100)], together=0.8), 0.0)
    assert stage.process(_frame([], size=(320, 240)), STEP) == ()


def test_assignment_takes_as_many_as_it_can_then_the_least_sum():
    distances = np.array([[1.0, 2.0], [1.5, 9.0]])
    assert assign(distances, gate=13.0) == {0: 1, 1: 0}
    assert assign(np.array([[50.0, 2.0]]), gate=13.0) == {0: 1}
    assert assign(np.array([[50.0]]), gate=13.0) == {}
    assert assign(np.zeros((0, 2)), gate=13.0) == {}
