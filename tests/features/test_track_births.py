"""What makes a track believed: pure functions, each bound by itself."""

from dataclasses import replace

import pytest

from lightgesture.features.track.births import (
    PAIR_S,
    PairEvidence,
    believed_pair,
    believed_single,
    gather,
    held_level,
    is_verified,
    observe,
    with_old_number,
    worth_observing,
)
from lightgesture.features.track.state import (
    TENTATIVE_S,
    blend,
)
from tests.features.track_parts import LEAST, LESS, MARGIN, NOW, SELECTION, new, sees


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
