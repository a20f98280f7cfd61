"""Gates and assignments as pure functions."""

import pytest

from lightgesture.features.track.association import (
    assign,
    assign_nearest,
    expect,
    gated,
    nearest_extent,
    squared_distance,
)
from lightgesture.features.track.motion import measure, start_state

GATE = 13.3


def _expected(box=(100, 100, 60, 80)):
    state = start_state(measure(box), 0.0, 0.0, 0.0, 0.0)
    return expect(state, centre_variance=25.0, size_variance=100.0)


def _apart(first, second):
    return 0.0


def test_the_distance_counts_each_coordinate_in_its_own_deviations():
    # 5 px and 10 px are one deviation of the centre and of the size.
    assert squared_distance(_expected(), (135.0, 140.0, 60.0, 80.0)) == pytest.approx(1.0)
    assert squared_distance(_expected(), (130.0, 140.0, 80.0, 80.0)) == pytest.approx(4.0)
    assert squared_distance(_expected(), (140.0, 145.0, 60.0, 90.0)) == pytest.approx(4 + 1 + 1)


def test_the_nearest_extent_of_a_region_counts(region):
    with_forearm = region(130, 170, 60, 140, alternatives=((100, 102, 60, 80),))
    match = nearest_extent(_expected(), with_forearm, GATE)
    assert match.measured == (130.0, 142.0, 60.0, 80.0)
    assert match.squared == pytest.approx(0.16)
    assert nearest_extent(_expected(), region(130, 170, 60, 140), GATE) is None


def test_the_gate_keeps_what_is_near(region):
    regions = {0: region(300, 140, 60, 80), 3: region(138, 140, 60, 80), 5: region(130, 152, 60, 80)}
    assert sorted(gated(_expected(), regions, GATE)) == [3, 5]
    assert sorted(gated(_expected(), regions, gate=3.0)) == [3]


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
