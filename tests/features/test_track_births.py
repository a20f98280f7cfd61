"""What makes a track believed, kept, sided and ended: pure functions, each bound by itself.

Times and scores are sums of binary fractions where what lies on a bound matters.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.find.settings import ALONE_CONFIDENCE, SelectorSettings
from lightgesture.features.track.births import (
    PAIR_S,
    PairEvidence,
    believed_pair,
    believed_single,
    gather,
    held_level,
    is_verified,
    observe,
    proved,
    with_old_number,
    worth_observing,
)
from lightgesture.features.track.kalman import meets, predict_box, start_box
from lightgesture.features.track.matching import Observed, PairScore, look_at, match_tracks
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
    with_lone_side,
    with_pair_sides,
)

LEAST, MARGIN, NOW, GATE = 0.25, 0.125, 8.0, 13.3
SELECTION = SelectorSettings(pair_score=0.25, single_score=0.5)
LESS = 1e-9


@pytest.fixture(scope="module")
def track(region):
    """Makes a track that is seen now, by default one that is followed."""

    def make(key=1, x=100, **changes):
        one = begin(key, key, region(x, 100), NOW)
        return replace(one, **{"number": key, "since_s": 0.0, "basis": "pair", "level": 0.75, **changes})

    return make


def sees(regions=(), pairs=()):
    """What is looked at: regions by number, and (score, first, second) of verified pairs."""
    scores = np.zeros((9, 9))
    for score, first, second in pairs:
        scores[first, second] = scores[second, first] = score
    return Observed(dict(regions), scores.tolist(), tuple(PairScore(*pair) for pair in pairs))


# Evidence on pairs


@pytest.mark.parametrize(("score", "hits"), [(0.25, 1), (0.25 - LESS, 0)])
def test_the_first_frame_of_a_pair_counts_from_its_score_on(score, hits):
    assert observe(None, score, NOW, 0.1, LEAST) == PairEvidence(score, NOW, NOW, hits)


def test_a_run_of_good_frames_goes_on_and_a_missed_one_ends_it_after_a_while():
    known = PairEvidence(0.5, 6.0, 7.875, 5)
    level = blend(0.5, 0.25, 0.125)
    assert observe(known, 0.25, NOW, 0.125, LEAST) == PairEvidence(level, 6.0, NOW, 6)
    low = blend(0.5, 0.0, 0.125)
    assert observe(known, 0.0, NOW, 0.125, LEAST) == PairEvidence(low, 6.0, 7.875, 5)
    assert observe(known, 0.0, 7.874 + TENTATIVE_S, 0.125, LEAST).hits == 5
    assert observe(known, 0.0, 7.876 + TENTATIVE_S, 0.125, LEAST) == PairEvidence(low, 6.0, 7.875, 0)
    ended = replace(known, hits=0)
    assert observe(ended, 0.5, NOW, 0.125, LEAST) == PairEvidence(0.5, NOW, NOW, 1)


@pytest.mark.parametrize(
    ("level", "since_s", "hits", "expected"),
    [
        (0.4, NOW, 1, True),  # a fifth of the way from 0.25 to 1
        (0.4 - LESS, NOW, 1, False),
        (0.4, NOW, 0, False),
        (0.25, NOW - 0.0625, 2, True),
        (0.25, NOW - 0.03125, 2, False),
        (0.25, NOW - 0.0625, 1, False),
        (0.25 - LESS, NOW - 0.0625, 9, False),
    ],
)
def test_a_pair_is_believed_at_once_or_after_a_while(level, since_s, hits, expected):
    assert is_verified(PairEvidence(level, since_s, NOW, hits), LEAST) == expected


def test_a_pair_must_last_as_long_as_is_told():
    assert is_verified(PairEvidence(0.25, 0.0, PAIR_S, 2), LEAST)
    assert not is_verified(PairEvidence(0.25, 0.0, PAIR_S - LESS, 2), LEAST)


def test_evidence_is_gathered_of_pairs_that_once_scored_enough(track):
    tracks = [track(3), track(1), track(2), track(4, region=None)]
    observed = sees(pairs=[(0.25, 1, 3), (0.2, 1, 2)])
    gathered = gather({(2, 3): PairEvidence(0.5, 1.0, 7.0, 9)}, tracks, observed, NOW, 0.125, LEAST)
    assert gathered == {
        (1, 3): PairEvidence(0.25, NOW, NOW, 1),
        (2, 3): PairEvidence(blend(0.5, 0.0, 0.125), 1.0, 7.0, 0),
    }


def test_the_level_of_the_pair_that_is_followed(track):
    evidence = {(1, 2): PairEvidence(0.5, 0.0, 0.0, 1)}
    assert held_level([track(1), track(2)], evidence) == held_level([track(2), track(1)], evidence) == 0.5
    assert held_level([track(1), track(3)], evidence) == held_level([track(1)], evidence) == 0.0


# What comes under observation


def test_with_two_hands_only_better_pairs_are_worth_observing(track):
    pairs = [(0.75, 4, 5), (0.5, 5, 6), (0.5, 7, 8)]
    hands = [track(1), track(2)]
    assert worth_observing(hands, sees(pairs=pairs), 0.5, SELECTION) == [
        4,
        5,
        6,
    ]  # two pairs, each region once
    assert worth_observing(hands, sees(pairs=pairs), 0.5 + LESS, SELECTION) == [4, 5]
    assert worth_observing(hands[:1], sees(pairs=pairs), 0.9, SELECTION) == [4, 5, 6]


def test_without_two_hands_the_best_two_regions_by_themselves_are_too(track, region):
    regions = {place: region(0, 0, score=score) for place, score in enumerate([0.9, 0.75, 0.5, 0.5 - LESS])}
    assert worth_observing([], sees(regions), 0.9, SELECTION) == [0, 1]
    assert worth_observing([], sees({2: regions[2], 3: regions[3]}), 0.9, SELECTION) == [2]
    assert worth_observing([track(level=0.8)], sees(regions), 0.9, SELECTION) == [0]
    assert worth_observing([track(1), track(2)], sees(regions), 0.9, SELECTION) == []


# Births


def new(track, key, **changes):
    """A region under observation."""
    return track(key, number=0, basis="none", **changes)


def evidence(level, lasted_s=1.0, hits=9):
    return PairEvidence(level, NOW - lasted_s, NOW, hits)


def keys(believed):
    return None if believed is None else (believed[0].key, believed[1].key, believed[2])


@pytest.mark.parametrize(
    ("level", "lasted_s", "held", "missed", "expected"),
    [
        (0.625, 0.125, 0.5, 0, True),
        (0.625 - LESS, 0.125, 0.5, 0, False),
        (0.625, 0.0625, 0.5, 0, False),
        (0.85, 0.0625, 0.5, 0, True),
        (0.85 - LESS, 0.0625, 0.5, 0, False),
        (0.625, 0.0625, 0.5, 1, True),
        (0.6, 0.0625, 0.5, 1, False),
    ],
)
def test_a_new_pair_replaces_two_hands_if_it_is_clearly_better(
    track, level, lasted_s, held, missed, expected
):
    hands, others = [track(1), track(2, missed=missed)], [new(track, 3), new(track, 4)]
    known = {(1, 2): evidence(held), (3, 4): evidence(level, lasted_s)}
    found = keys(believed_pair(hands, others, known, LEAST, MARGIN))
    assert found == ((3, 4, level) if expected else None)


@pytest.mark.parametrize(
    ("changes", "level", "expected"),
    [
        ({}, 0.375, True),
        ({}, 0.375 - LESS, False),
        ({"basis": "middle"}, 0.3, True),
        ({"missed": 1}, 0.3, True),
    ],
)
def test_two_new_regions_replace_one_hand_of_a_pair_only_if_they_are_better(track, changes, level, expected):
    known = {(3, 4): evidence(level)}
    found = believed_pair([track(1, **changes)], [new(track, 3), new(track, 4)], known, LEAST, MARGIN)
    assert (found is not None) == expected


def test_the_partner_of_a_hand_needs_no_margin_and_what_is_not_seen_or_not_new_is_no_birth(track):
    hand, partner = track(1), new(track, 3)
    known = {(1, 3): evidence(0.25)}
    assert keys(believed_pair([hand], [partner], known, LEAST, MARGIN)) == (1, 3, 0.25)
    assert believed_pair([hand], [replace(partner, missed=1)], known, LEAST, MARGIN) is None
    assert believed_pair([hand], [], known, LEAST, MARGIN) is None
    assert believed_pair([], [partner], known, LEAST, MARGIN) is None
    assert believed_pair([hand], [partner], {(1, 3): evidence(0.2)}, LEAST, MARGIN) is None
    assert believed_pair([hand, track(3)], [], {(1, 3): evidence(0.9)}, LEAST, MARGIN) is None


def test_of_several_pairs_the_best_is_believed_and_of_equal_ones_the_first(track):
    others = [new(track, key) for key in (3, 4, 5)]
    known = {(3, 4): evidence(0.5), (3, 5): evidence(0.75), (4, 5): evidence(0.75)}
    assert keys(believed_pair([], others, known, LEAST, MARGIN)) == (3, 5, 0.75)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, True),
        ({"level": 0.5}, True),
        ({"level": 0.5 - LESS}, False),
        ({"hits": 2}, False),
        ({"since_s": NOW - 0.0625}, True),
        ({"since_s": NOW - 0.05}, False),
        ({"missed": 1}, False),
    ],
)
def test_a_lone_region_is_believed_after_a_while(track, changes, expected):
    one = (
        new(track, 3, hits=3, **changes) if "since_s" in changes else new(track, 3, **{"hits": 3, **changes})
    )
    assert (believed_single([], [one], 0.5, MARGIN) is one) == expected


def test_a_lone_region_replaces_a_hand_if_it_is_better_and_never_two(track):
    one, other = new(track, 3, hits=3, level=0.75), new(track, 4, hits=3, level=0.7)
    assert believed_single([track(1, level=0.625)], [other, one], 0.5, MARGIN) is one
    assert believed_single([track(1, level=0.625 + LESS)], [other, one], 0.5, MARGIN) is None
    assert believed_single([track(1, level=0.1)], [replace(one, level=0.4)], 0.5, MARGIN) is None
    assert believed_single([track(1), track(2)], [one], 0.5, MARGIN) is None


def test_the_new_partner_of_a_hand_takes_the_number_of_the_lost_one(track):
    hand, lost, partner, other = track(1), track(2, missed=3), new(track, 3), new(track, 4)

    def numbers(believed, hands):
        return [one.number for one in with_old_number(believed, hands)]

    assert numbers((hand, partner), [hand, lost]) == [1, 2]
    assert numbers((partner, hand), [lost, hand]) == [2, 1]
    assert numbers((hand, partner), [hand, replace(lost, missed=0)]) == [1, 0]
    assert numbers((hand, partner), [hand]) == [1, 0]
    assert numbers((partner, other), [hand, lost]) == [0, 0]
    assert numbers((partner, other), [replace(hand, missed=1), lost]) == [0, 0]


# Proof


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


# Sides


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


# What is looked at, and who finds what


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
