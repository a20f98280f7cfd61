"""The clock of the tracks: frame rates, dropped frames, and times that cannot be; odd candidates."""

import math

import numpy as np
import pytest

from lightgesture.features.track.births import PAIR_S, SINGLE_FRAMES, SINGLE_S
from lightgesture.features.track.matching import CONSIDERED
from lightgesture.features.track.settings import TrackSettings
from lightgesture.features.track.tracker import Tracker
from lightgesture.features.types import Candidates

RATES = (10, 30, 60)


def _dive(region, frame, time_s):
    """Hands that are seen from 0 to 3 s with a new sign each second, hidden for 0.4 s, seen to 5 s, then gone."""
    if 3.0 <= time_s < 3.4 or time_s >= 5.0:
        return frame([])
    width, height = [(70, 70), (90, 120), (60, 110)][int(time_s) % 3]
    sway = 15.0 * math.sin(2.0 * time_s)
    return frame([region(160 + sway, 140, width, height), region(460 - sway, 150 + sway, width, height)], 0.4)


def _watched(region, frame, rate, drop=0.0, seed=0):
    """(time, tracks) of each frame that is not dropped, 7 s long."""
    rng, tracker = np.random.default_rng(seed), Tracker()
    times = [index / rate for index in range(7 * rate) if index == 0 or rng.random() >= drop]
    return [(time_s, tracker.update(_dive(region, frame, time_s), time_s)) for time_s in times]


@pytest.mark.parametrize("drop", [0.0, 0.3])
@pytest.mark.parametrize("rate", RATES)
def test_every_frame_rate_gives_the_same_lives(region, frame, rate, drop):
    watched = _watched(region, frame, rate, drop)
    assert {(track.number, track.side) for _, tracks in watched for track in tracks} == {
        (1, "right"),
        (2, "left"),
    }
    slack = 4.0 / rate if drop else 1.5 / rate
    born = min(time_s for time_s, tracks in watched if tracks)
    assert born <= PAIR_S + slack
    last = max(time_s for time_s, tracks in watched if tracks)
    assert last == pytest.approx(5.0 + TrackSettings().lost_s, abs=slack + 1.0 / rate)
    seen = [all(track.missed == 0 for track in tracks) for time_s, tracks in watched if 0.3 < time_s < 3.0]
    assert all(seen)


@pytest.mark.parametrize("rate", RATES)
def test_a_lone_hand_is_born_soon_at_every_rate(region, frame, rate):
    tracker = Tracker()
    times = [index / rate for index in range(rate)]
    born = next(time_s for time_s in times if tracker.update(frame([region(140, 140, score=0.9)]), time_s))
    wanted = max(SINGLE_S, (SINGLE_FRAMES - 1) / rate)
    assert wanted - 1e-9 <= born <= wanted + 1.0 / rate


@pytest.mark.parametrize(
    "times",
    [
        [0.0] * 40,
        [math.nan] * 40,
        [math.inf, -math.inf] * 20,
        [5.0 - 0.1 * index for index in range(40)],
        [0.0, 1e9, 2e9] * 12,
        [0.1, 0.2, math.nan, 0.05, 0.2, 0.2] * 6,
    ],
)
def test_time_that_cannot_be_neither_raises_nor_keeps_hands_from_being_followed(region, frame, sides, times):
    tracker = Tracker()
    for time_s in times:
        tracker.predict(time_s)
        tracks = tracker.update(frame([region(160, 140), region(460, 140)], 0.8), time_s)
    assert sides(tracks) == {"right": 160, "left": 460}


@pytest.mark.parametrize("time_s", [0.0, math.nan, -3.0])
def test_tracks_end_although_time_stands_still(region, frame, time_s):
    tracker = Tracker()
    for _ in range(30):
        tracker.update(frame([region(160, 140), region(460, 140)], 0.8), time_s)
    for _ in range(30):
        tracks = tracker.update(frame([]), time_s)
    assert tracks == ()


def test_a_long_gap_in_time_starts_anew_with_new_numbers(region, frame):
    tracker = Tracker()
    shown = frame([region(160, 140), region(460, 140)], 0.8)
    assert [track.number for track in tracker.update(shown, 0.0)] == [1, 2]
    assert [track.number for track in tracker.update(shown, 50.0)] == [3, 4]


def test_regions_that_cannot_be_are_passed_over(region, frame, sides):
    tracker = Tracker()
    odd = [
        region(-900, 140),
        region(5000, 5000),
        region(300, 300, 0, 40),
        region(300, 300, score=math.nan),
        region(160, 140),
        region(460, 140),
    ]
    pairs = {(i, j): 0.9 for i in range(4) for j in range(i)} | {(4, 5): 0.8, (0, 4): math.nan}
    for index in range(10):
        tracks = tracker.update(frame(odd, pairs), index / 30)
    assert sides(tracks) == {"right": 160, "left": 460}


def test_boxes_of_predictions_stay_inside_the_picture(region, frame):
    tracker = Tracker()
    for index in range(12):
        tracker.update(frame([region(40 - 6 * index, 30), region(600 + 6 * index, 470)], 0.8), index / 30)
    for index in range(12, 26):
        for track in tracker.update(frame([]), index / 30):
            x, y, width, height = track.box
            assert 0 <= x < x + width <= 640
            assert 0 <= y < y + height <= 480


def test_hundreds_of_regions_take_no_more_than_the_best_few(region):
    rng = np.random.default_rng(1)
    regions = tuple(
        region(float(rng.uniform(0, 640)), float(rng.uniform(0, 480)), score=0.9 - 0.001 * index)
        for index in range(400)
    )
    scores = rng.uniform(0.0, 1.0, (400, 400)).astype(np.float32)
    all_of_them, best = Tracker(), Tracker()
    for index in range(20):
        many = all_of_them.update(Candidates(regions, scores, (640, 480)), index / 30)
        head = best.update(
            Candidates(regions[:CONSIDERED], scores[:CONSIDERED, :CONSIDERED], (640, 480)), index / 30
        )
        assert many == head
        assert len(many) <= 2
