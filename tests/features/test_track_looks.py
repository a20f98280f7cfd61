"""Sides of tracks, what is looked at, and which track finds what."""

import math
from dataclasses import replace

import pytest

from lightgesture.features.find.settings import ALONE_CONFIDENCE
from lightgesture.features.track.kalman import predict_box
from lightgesture.features.track.matching import look_at, match_tracks
from lightgesture.features.track.state import (
    with_lone_side,
    with_pair_sides,
)
from tests.features.track_parts import GATE, LEAST, LESS, MARGIN, NOW, SELECTION, new, sees


def sides_of(first, second, level=0.5):
    pair = with_pair_sides(first, second, level, MARGIN)
    assert {(one.basis, one.certainty, one.side_level) for one in pair} == {("pair", 1.0, level)}
    return [one.side for one in pair]


def test_the_right_hand_is_at_image_left_unless_a_side_is_kept(track):
    left, right = new(track, 1, x=100), new(track, 2, x=300)
    assert sides_of(left, right) == ["right", "left"]
    assert sides_of(right, left) == ["left", "right"]
    assert sides_of(left, replace(right, motion=left.motion)) == ["right", "left"]
    kept = track(3, 100, side="left", side_level=0.375, since_s=NOW - 0.5)
    assert sides_of(kept, right) == ["left", "right"]
    assert sides_of(right, kept) == ["right", "left"]
    for gives_way in ({"basis": "axis"}, {"side_level": 0.375 - LESS}, {"since_s": NOW - 0.49}):
        assert sides_of(replace(kept, **gives_way), right) == ["right", "left"]


def test_a_lone_hand_is_on_the_side_of_the_axis_or_else_of_the_middle(track):
    one = new(track, 1, x=100)

    def sided(one, axis, width=640):
        after = with_lone_side(one, axis, width)
        return after.side, after.basis, after.certainty

    assert sided(one, None) == ("right", "middle", ALONE_CONFIDENCE)
    assert sided(one, None, width=200) == ("left", "middle", ALONE_CONFIDENCE)
    assert sided(one, None, width=202) == ("right", "middle", ALONE_CONFIDENCE)
    assert sided(one, 101.0) == ("right", "axis", 0.9)
    assert sided(one, 100.0) == ("left", "axis", 0.9)
    guess = replace(one, basis="middle", side="left")
    assert sided(guess, None) == ("left", "middle", 1.0)
    assert sided(guess, 101.0) == ("right", "axis", 0.9)
    for basis in ("pair", "axis"):
        assert sided(replace(guess, basis=basis), 101.0) == ("left", basis, 1.0)


def test_only_boxes_in_the_picture_with_a_score_are_looked_at(region, frame):
    sound = [
        region(40, 40),
        region(-39, 40),
        region(40, -39),
        region(679, 40),
        region(40, 519),
        region(40, 40, 1),
    ]
    unsound = [
        region(-40, 40),
        region(40, -40),
        region(680, 40),
        region(40, 520),
        region(40, 40, score=math.nan),
    ]
    unsound += [replace(region(40, 40), box=(5, 5, 0, 9)), replace(region(40, 40), box=(5, 5, 9, 0))]
    observed = look_at(frame([*sound, *unsound]), LEAST)
    assert list(observed.regions) == list(range(len(sound)))


def test_the_best_verified_pairs_are_looked_at(region, frame):
    scores = {(0, 1): 0.25, (0, 2): 0.24, (1, 2): 0.5, (0, 3): 0.6, (1, 3): 0.7, (2, 3): 0.8}
    observed = look_at(frame([region(40 + 9 * place, 40) for place in range(4)], scores), LEAST)
    assert [pair[1:] for pair in observed.pairs] == [(2, 3), (1, 3), (0, 3), (1, 2)]
    assert observed.together(1, 0) == 0.25
    assert observed.together(1, None) == observed.together(None, 1) == observed.together(0, 0) == 0.0


def test_as_many_regions_are_looked_at_as_there_is_time_for(region, frame):
    observed = look_at(
        frame([region(40 + place, 40) for place in range(30)], {(22, 23): 0.5, (23, 24): 0.9}), LEAST
    )
    assert list(observed.regions) == list(range(24))
    assert [pair[1:] for pair in observed.pairs] == [(22, 23)]


def matches(hands, regions, pairs=(), tentative=(), leap_score=0.5, now=NOW):
    """Track -> (region, whether it leapt)."""
    hands = [replace(one, motion=predict_box(one.motion, 0.1)) for one in hands]
    observed = sees(dict(enumerate(regions)), pairs)
    found = match_tracks(hands, list(tentative), observed, now, GATE, leap_score, SELECTION.single_score)
    return {key: (match.index, match.leap) for key, match in found.items()}


def test_a_hand_keeps_a_weak_region_for_a_moment_and_then_needs_a_better_one(track, region):
    weak, weaker, good = (
        region(100, 100, score=0.2),
        region(100, 100, score=0.2 - LESS),
        region(100, 100, score=0.5),
    )
    assert matches([track(1)], [weak]) == {1: (0, False)}
    assert matches([track(1)], [weaker]) == {}
    assert matches([track(1)], [weak], now=NOW + 0.21) == {}
    assert matches([track(1)], [good], now=NOW + 0.21) == {1: (0, False)}


def test_hands_that_meet_need_better_regions(track, region):
    regions = [region(100, 100, score=0.4), region(170, 100, score=0.5)]
    assert matches([track(1, 100), track(2, 170)], regions) == {2: (1, False)}
    apart = [region(100, 100, score=0.4), region(470, 100, score=0.5)]
    assert matches([track(1, 100), track(2, 470)], apart) == {1: (0, False), 2: (1, False)}


def test_both_hands_leap_to_a_pair_that_is_about_as_good_as_they_were(track, region):
    hands, regions = [track(1, 100), track(2, 400)], [region(200, 100), region(500, 100)]
    assert matches(hands, regions, [(0.5, 0, 1)]) == {1: (0, True), 2: (1, True)}
    weak = [region(200, 100, score=0.4), region(500, 100, score=0.4)]
    assert matches(hands, weak, [(0.5, 0, 1)]) == {1: (0, True), 2: (1, True)}
    assert matches(hands, weak, [(0.5 - LESS, 0, 1)]) == {}


def test_a_hand_that_leaps_takes_the_pairs_region_that_the_other_hand_left(track, region):
    """The other hand found its own inside the gate; the pair must hold what it found."""
    hands = [track(1, 100), track(2, 400)]
    regions = [region(100, 100, score=0.4), region(500, 100, score=0.4), region(300, 100, score=0.4)]
    assert matches(hands, regions, [(0.75, 0, 1)]) == {1: (0, False), 2: (1, True)}
    assert matches(hands, regions, [(0.75, 1, 2)]) == {1: (0, False)}
    assert matches(hands, regions) == {1: (0, False)}


def test_a_hand_that_leaps_alone_takes_a_region_that_is_believed_by_itself(track, region):
    hands = [track(1, 100), track(2, 400)]
    believed = [region(100, 100), region(500, 100, score=0.5)]
    assert matches(hands, believed) == {1: (0, False), 2: (1, True)}
    doubted = [region(100, 100), region(500, 100, score=0.5 - LESS)]
    assert matches(hands, doubted) == {1: (0, False)}
    assert matches(hands, [region(100, 100), region(400, 100)]) == {1: (0, False), 2: (1, False)}


def test_what_is_under_observation_takes_what_the_hands_left(track, region):
    watched = [new(track, 3, x=100), new(track, 4, x=300)]
    regions = [region(100, 100), region(300, 100, score=0.2), region(320, 100, score=0.2 - LESS)]
    assert matches([track(1, 100)], regions, tentative=watched) == {1: (0, False), 4: (1, False)}


@pytest.mark.parametrize("missed", [0, 1])
def test_hands_that_met_come_back_in_the_order_in_which_they_went(track, region, missed):
    """Two regions about as near to both: the order of their middles counts where one hand was behind the other."""
    hands = [track(1, 100, seen_x=140.0, missed=missed), track(2, 110, seen_x=70.0)]
    regions = [region(104, 100, width=40, height=80), region(106, 100, width=160, height=80)]
    found = matches(hands, regions)
    narrow, wide = regions
    assert narrow.box[0] > wide.box[0]
    assert set(found) == {1, 2}
    turned = matches([replace(hands[0], seen_x=70.0), replace(hands[1], seen_x=140.0)], regions)
    assert (found == turned) == (not missed)
