"""The diver's own sides: crossing and touching hands, and hands alone."""

from dataclasses import replace

import pytest

from lightgesture.features.track.state import SETTLE_S, begin, with_lone_side, with_pair_sides
from lightgesture.features.track.tracker import Tracker

STEP = 1 / 30


def _play(tracker, frames, start=0.0):
    return [tracker.update(candidates, start + index * STEP) for index, candidates in enumerate(frames)]


def _pair_sides(first, second):
    return tuple(track.side for track in with_pair_sides(first, second, level=0.8, margin=0.15))


def test_sides_follow_the_order_in_the_picture_unless_one_is_known(region):
    image_left, image_right = (begin(key, key, region(x, 140), 0.0) for key, x in enumerate((100, 300)))
    assert _pair_sides(image_left, image_right) == ("right", "left")
    assert _pair_sides(image_right, image_left) == ("left", "right")
    known = {"basis": "pair", "side_level": 0.7, "proved_s": SETTLE_S}
    assert _pair_sides(replace(image_left, side="left", **known), image_right) == ("left", "right")
    assert _pair_sides(image_left, replace(image_right, side="right", **known)) == ("left", "right")


@pytest.mark.parametrize("change", [{"basis": "axis"}, {"side_level": 0.6}, {"proved_s": 0.9 * SETTLE_S}])
def test_a_side_gives_way_that_was_a_guess_or_rests_on_a_worse_pair_or_on_a_short_one(region, change):
    first, second = (begin(key, key, region(x, 140), 0.0) for key, x in enumerate((100, 300)))
    known = {"side": "left", "basis": "pair", "side_level": 0.7, "proved_s": SETTLE_S}
    assert _pair_sides(replace(first, **known | change), second) == ("right", "left")


def test_a_lone_hand_takes_the_side_of_the_axis_else_of_the_middle(region):
    track = begin(1, 0, region(250, 140), 0.0)
    guess = with_lone_side(track, None, 640)
    assert (guess.side, guess.basis, guess.certainty) == ("right", "middle", 0.8)
    assert with_lone_side(track, 200.0, 640).side == "left"
    assert with_lone_side(guess, 200.0, 640).side == "left"
    assert with_lone_side(guess, None, 100) == guess


@pytest.mark.parametrize("height_apart", [0, 60, 160])
def test_hands_that_cross_keep_sides_and_numbers(region, frame, sides, height_apart):
    tracker = Tracker()
    shown = []
    for index in range(50):
        right, left = region(120 + 8 * index, 140), region(512 - 8 * index, 140 + height_apart)
        overlap = height_apart < 80 and abs(392 - 16 * index) < 80
        # Where they overlap, the selector sees one thing that looks little like a hand.
        merged = [region(316, 140, 120, 100, score=0.3)] if overlap else [right, left]
        shown.append(frame(merged, None if overlap else 0.8))
    played = _play(tracker, shown)
    assert sides(played[-1]) == {"right": 120 + 8 * 49, "left": 512 - 8 * 49}
    assert {track.number for tracks in played for track in tracks} == {1, 2}


def test_crossed_hands_keep_their_sides_for_as_long_as_they_are_seen(region, frame, sides):
    tracker = Tracker()
    _play(tracker, [frame([region(200 + 8 * n, 140), region(440 - 8 * n, 260)], 0.8) for n in range(30)])
    held = _play(tracker, [frame([region(200, 260), region(440, 140)], 0.8)] * 150, start=1.0)
    assert all(sides(tracks) == {"right": 440, "left": 200} for tracks in held)


def test_hands_that_touch_and_part_keep_sides_and_numbers(region, frame, sides):
    tracker = Tracker()
    apart = [280 - 8 * n for n in range(25)]
    shown = [frame([region(320 - d / 2, 140), region(320 + d / 2, 140)], 0.8) for d in apart if d > 80]
    shown += [frame([region(320, 140, 150, 90, score=0.3)])] * 10
    shown += [frame([region(320 - d / 2, 140), region(320 + d / 2, 140)], 0.8) for d in range(90, 240, 8)]
    played = _play(tracker, shown)
    assert sides(played[-1]) == {"right": 320 - 234 / 2, "left": 320 + 234 / 2}
    assert {track.number for tracks in played for track in tracks} == {1, 2}


def test_a_lone_hand_is_sided_by_the_middle_at_lowered_confidence(region, frame):
    tracks = _play(Tracker(), [frame([region(420, 140, score=0.8)])] * 10)[-1]
    assert [(track.side, track.certainty) for track in tracks] == [("left", 0.8)]


def test_the_axis_of_the_body_decides_where_it_is_seen(region, frame):
    hand = region(420, 140, score=0.8)
    tracks = _play(Tracker(), [frame([hand], axis=500.0)] * 10)[-1]
    assert [(track.side, track.certainty) for track in tracks] == [("right", 0.9)]


def test_a_guess_by_the_middle_is_put_right_by_the_axis_and_then_stays(region, frame):
    tracker = Tracker()
    hand = region(420, 140, score=0.8)
    assert _play(tracker, [frame([hand])] * 10)[-1][0].side == "left"
    axis = tracker.update(frame([hand], axis=500.0), 10 * STEP)
    assert [(track.side, track.number) for track in axis] == [("right", 1)]
    moved = _play(tracker, [frame([region(420 + 6 * n, 140, score=0.8)]) for n in range(30)], start=11 * STEP)
    assert {track.side for tracks in moved for track in tracks} == {"right"}


def test_the_partner_puts_a_guess_right(region, frame, sides):
    tracker = Tracker()
    hand = region(300, 140, score=0.8)
    assert _play(tracker, [frame([hand])] * 30)[-1][0].side == "right"
    both = _play(tracker, [frame([hand, region(120, 150)], 0.8)] * 3, start=1.0)
    assert sides(both[-1]) == {"right": 120, "left": 300}
    assert {track.side: track.number for track in both[-1]} == {"right": 2, "left": 1}
    assert all(track.certainty == 1.0 for track in both[-1])


def test_a_side_known_from_the_pair_outlives_the_partner(region, frame):
    tracker = Tracker()
    _play(tracker, [frame([region(160, 140), region(460, 140)], 0.8)] * 30)
    alone = _play(tracker, [frame([region(160 + 5 * n, 140)], axis=100.0) for n in range(60)], start=1.0)
    assert [(track.side, track.number, track.certainty) for track in alone[-1]] == [("right", 1, 1.0)]
