"""Gates and assignments as pure functions."""

import pytest

from lightgesture.features.track.kalman import start_box
from lightgesture.features.track.matching import assign, assign_nearest, gated

GATE = 13.3
EXPECTED = start_box((100, 100, 60, 80))


def _apart(first, second):
    return 0.0


def test_the_nearest_extent_of_a_region_counts(region):
    with_forearm = region(130, 200, 60, 200, alternatives=((100, 102, 60, 80), (90, 90, 70, 90)))
    (match,) = gated(EXPECTED, {4: with_forearm}, GATE).values()
    assert (match.index, match.region, match.extent) == (4, with_forearm, 1)
    assert match.squared == pytest.approx(4.0 / (2 * 0.12**2 * 60 * 80))
    assert gated(EXPECTED, {4: region(130, 200, 60, 200)}, GATE) == {}


def test_far_from_the_gate_no_other_extent_is_tried(region):
    far = region(330, 140, 60, 80, alternatives=((100, 100, 60, 80),))
    assert gated(EXPECTED, {0: far}, GATE) == {}


def test_the_gate_keeps_what_is_near(region):
    regions = {0: region(300, 140, 60, 80), 3: region(138, 140, 60, 80), 5: region(130, 160, 60, 80)}
    assert sorted(gated(EXPECTED, regions, GATE)) == [3, 5]
    assert sorted(gated(EXPECTED, regions, gate=2.0)) == [3]


def test_a_leap_is_as_wide_as_a_change_of_sign(region):
    regions = {0: region(190, 140, 60, 80)}
    assert gated(EXPECTED, regions, GATE) == {}
    assert gated(EXPECTED, regions, GATE, leap=True)[0].leap


def test_two_tracks_share_two_regions_for_the_greatest_sum():
    assert assign([{0: 1.0, 1: 0.9}, {0: 0.9, 1: 0.1}], _apart) == {0: 1, 1: 0}


def test_a_track_goes_without_a_region_rather_than_take_a_bad_one():
    assert assign([{0: 1.5, 1: -0.4}, {0: 1.0}], _apart) == {0: 0}
    assert assign([{0: -0.1}], _apart) == {}
    assert assign([{}, {}], _apart) == {}
    assert assign([], _apart) == {}


def test_regions_that_go_together_are_preferred():
    values = [{0: 1.0}, {1: 0.6, 2: 0.5}]
    assert assign(values, lambda first, second: {1: 0.1, 2: 0.8}[second]) == {0: 0, 1: 2}


def test_the_nearest_two_are_matched_first():
    assert assign_nearest([(4.0, 0, 0), (1.0, 1, 0), (5.0, 0, 1), (9.0, 1, 1)]) == {1: 0, 0: 1}
    assert assign_nearest([]) == {}
