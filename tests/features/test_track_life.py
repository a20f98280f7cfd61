"""How long a track is kept: proof, trust, hands that are unseen or meet."""

import math
from dataclasses import replace

import pytest

from lightgesture.features.track.births import (
    proved,
)
from lightgesture.features.track.kalman import meets, start_box
from lightgesture.features.track.state import (
    COAST_S,
    MEET_S,
    TENTATIVE_S,
    Match,
    begin,
    blend,
    is_over,
    seen,
    trust_s,
    unseen,
)
from tests.features.track_parts import LESS, NOW, SELECTION


def proved_keys(hands, score=0.0, held=0.625, doubt_s=1.0):
    after = proved(hands, score, held, NOW + 1, doubt_s, SELECTION)
    assert [one.key for one in after] == [one.key for one in hands]
    fresh = [one for one in after if one.proved_s == NOW + 1]
    assert all(one.side_level == max(0.0, held) for one in fresh)
    return [one.key for one in fresh]


def test_two_hands_prove_each_other_by_their_score_and_one_hand_by_its_own(track):
    both = [track(1), track(2)]
    assert proved_keys(both, score=0.25) == [1, 2]
    assert proved_keys(both, score=0.25 - LESS) == []
    assert proved_keys([track(1, confidence=0.5)]) == [1]
    assert proved_keys([track(1, confidence=0.5 - LESS)]) == []
    assert proved_keys([track(1, confidence=0.5), track(2, missed=1)], score=0.9) == [1]


def test_of_two_hands_that_have_not_proved_each_other_for_long_the_better_one_stays(track):
    old = {"proved_s": NOW - 0.25}
    hands = [track(1, level=0.5, **old), track(2, level=0.4, **old)]
    assert proved_keys(hands, doubt_s=1.0) == [1]
    assert proved_keys(hands, doubt_s=1.25) == []
    assert proved_keys([hands[0], track(2, level=0.4)], doubt_s=1.0) == []
    assert proved_keys([replace(one, level=one.level - 0.01) for one in hands], doubt_s=1.0) == []


# The life of a track


def test_a_mean_forgets_by_its_time_constant():
    assert blend(1.0, 0.0, 0.2) == pytest.approx(math.exp(-1))
    assert blend(0.25, 0.75, 0.1) == pytest.approx(0.75 - 0.5 * math.exp(-0.5))
    assert blend(0.3, 0.9, 0.0) == pytest.approx(0.3)


def test_a_track_is_trusted_as_long_as_it_was_proved_and_a_moment(track):
    assert trust_s(track(since_s=NOW - 0.5), 9.0) == pytest.approx(0.5 + TENTATIVE_S)
    assert trust_s(track(since_s=NOW - 0.5), 0.25) == 0.25


@pytest.mark.parametrize(
    ("changes", "after_s", "expected"),
    [
        ({}, 0.5, False),
        ({}, 0.5 + 0.01, True),  # unseen
        ({"seen_s": NOW + 9}, 1.0, False),
        ({"seen_s": NOW + 9}, 1.01, True),  # unproved
        ({"since_s": NOW}, 0.14, False),
        ({"since_s": NOW}, 0.16, True),  # young
        ({"number": 0, "seen_s": NOW + 9}, 0.14, False),
        ({"number": 0, "seen_s": NOW + 9}, 0.16, True),
    ],
)
def test_when_a_track_ends(track, changes, after_s, expected):
    assert is_over(track(**changes), NOW + after_s, lost_s=0.5, doubt_s=1.0) == expected


def test_a_track_begins_as_its_region_is(region):
    one = begin(5, 7, region(130, 90, 60, 80, score=0.7, alternatives=((1, 2, 3, 4),)), NOW)
    assert (one.key, one.region, one.box, one.seen_x) == (5, 7, (100, 50, 60, 80), 130.0)
    assert (one.confidence, one.level, one.number, one.hits, one.missed) == (0.7, 0.7, 0, 1, 0)
    assert (one.since_s, one.seen_s, one.proved_s, one.alternatives) == (NOW, NOW, NOW, ((1, 2, 3, 4),))


def test_a_track_takes_over_what_it_found(track, region):
    before = track(missed=3, level=0.5)
    found = region(140, 100, score=0.9, alternatives=((80, 60, 80, 80),))
    after = seen(before, Match(4, found, 1, 1.0, leap=False), NOW + 1, 0.2)
    assert (after.box, after.region, after.missed, after.seen_s, after.seen_x) == (
        found.box,
        4,
        0,
        NOW + 1,
        140,
    )
    assert after.level == pytest.approx(blend(0.5, 0.9, 0.2))
    assert after.motion[0].position == pytest.approx(120.0, abs=20.0)  # the extent that is nearest counts
    assert after.motion[0].position < 121.0
    leapt = seen(before, Match(4, found, 1, 1.0, leap=True), NOW + 1, 0.2)
    assert leapt.motion == start_box(found.box)


@pytest.mark.parametrize(
    ("other_x", "after_s", "is_moving"),
    [
        (None, COAST_S, True),
        (None, COAST_S + 0.01, False),
        (400, COAST_S + 0.01, False),
        (150, COAST_S + 0.01, True),
        (150, MEET_S, True),
        (150, MEET_S + 0.01, False),
    ],
)
def test_an_unseen_hand_goes_on_for_a_moment_and_longer_behind_the_other(track, other_x, after_s, is_moving):
    moving = tuple(item._replace(velocity=9.0) for item in start_box((60, 60, 80, 80)))
    one = track(motion=moving, seen_s=0.0, missed=2)
    others = [] if other_x is None else [track(2, other_x)]
    after = unseen(one, others, after_s, 0.1, (640, 480))
    assert (after.motion[0].velocity != 0.0) == is_moving
    assert (after.missed, after.region, after.alternatives, after.level) == (3, None, (), one.level)
    assert unseen(replace(one, number=0), [], 0.0, 0.1, (640, 480)).level == pytest.approx(
        blend(0.75, 0, 0.1)
    )


def test_hands_meet_when_their_boxes_share_an_edge_in_both_ways():
    one = start_box((100, 100, 60, 80))
    for box, expected in [
        ((160, 100, 40, 80), True),
        ((161, 100, 40, 80), False),
        ((60, 100, 40, 80), True),
        ((59, 100, 40, 80), False),
        ((100, 180, 60, 20), True),
        ((100, 181, 60, 20), False),
        ((100, 80, 60, 20), True),
        ((100, 79, 60, 20), False),
    ]:
        assert meets(one, start_box(box)) == meets(start_box(box), one) == expected
