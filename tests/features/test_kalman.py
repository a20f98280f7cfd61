"""The filter of a hand's box: what its noise means, and when hands meet."""

import numpy as np
import pytest

from lightgesture.features.track import kalman
from lightgesture.features.track.kalman import (
    CENTRE_NOISE,
    SIZE_NOISE,
    Coordinate,
    area_of,
    box_of,
    meets,
    precision_of,
    predict_box,
    squared_distance,
    start_box,
    stop,
    update_box,
)

BOX = (100, 100, 60, 80)


def test_a_step_of_zero_changes_nothing():
    state = start_box(BOX)
    assert predict_box(state, 0.0) == state


@pytest.mark.parametrize("steps", [1, 3, 6, 60])
def test_the_prediction_does_not_depend_on_how_a_second_is_divided(steps):
    start = Coordinate(10.0, 5.0, 4.0, 1.0, 9.0)
    state = start
    for _ in range(steps):
        state = kalman.predict(state, 1.0 / steps, 300.0)
    np.testing.assert_allclose(state, kalman.predict(start, 1.0, 300.0), rtol=1e-12)


def test_a_measurement_shrinks_the_variance_and_moves_towards_what_was_measured():
    before = kalman.predict(Coordinate(0.0, 0.0, 4.0, 0.0, 100.0), 0.1, 50.0)
    after = kalman.update(before, 10.0, 4.0)
    assert before.position < after.position < 10.0
    assert after.velocity > 0.0
    assert after.p00 < before.p00
    assert after.p11 < before.p11


def test_a_centre_is_trusted_more_than_a_size():
    wide = update_box(predict_box(start_box(BOX), 0.1), (160, 130, 120, 80))
    assert (wide[0].position - 130.0) / 90.0 > (wide[2].position - 60.0) / 60.0


def test_a_near_hand_is_followed_as_a_far_one():
    far, near = start_box((0, 0, 30, 40)), start_box((0, 0, 90, 120))
    for step in range(1, 6):
        far = update_box(predict_box(far, 0.1), (step, 2 * step, 30 + step, 40))
        near = update_box(predict_box(near, 0.1), (3 * step, 6 * step, 90 + 3 * step, 120))
    assert [item.position for item in near] == pytest.approx([3 * item.position for item in far])


def test_the_distance_counts_each_coordinate_in_its_own_deviations():
    state = start_box(BOX)
    # A box that was measured once is as uncertain as the measurement: the variance of the difference is twice that.
    area = 60 * 80
    centre, size = 2 * CENTRE_NOISE**2 * area, 2 * SIZE_NOISE**2 * area
    precision = precision_of(state)
    assert squared_distance(state, precision, (106, 100, 60, 80)) == pytest.approx(36 / centre)
    assert squared_distance(state, precision, (95, 100, 70, 80)) == pytest.approx(100 / size)
    assert squared_distance(state, precision, (103, 97, 60, 92)) == pytest.approx(18 / centre + 144 / size)
    assert squared_distance(state, precision_of(state, leap=0.5), (106, 100, 60, 80)) == pytest.approx(
        36 / (centre + 0.25 * area)
    )


def test_a_stopped_hand_rests_and_is_as_uncertain_as_before():
    moving = update_box(predict_box(start_box(BOX), 0.1), (115, 110, 70, 80))
    rests = stop(moving)
    assert [item.velocity for item in rests] == [0.0] * 4
    assert [item[2:] for item in rests] == [item[2:] for item in moving]


def test_hands_meet_when_their_boxes_touch():
    assert meets(start_box(BOX), start_box((160, 150, 60, 80)))
    assert not meets(start_box(BOX), start_box((161, 100, 60, 80)))


@pytest.mark.parametrize(
    "centre_and_size",
    [(-500.0, -500.0, 60.0, 80.0), (9e3, 9e3, 60.0, 80.0), (320.0, 240.0, -5.0, 0.0), (0.0, 0.0, 4e3, 4e3)],
)
def test_a_clipped_box_lies_inside_the_picture_and_is_at_least_a_pixel_large(centre_and_size):
    state = tuple(Coordinate(position, 0.0, 1.0, 0.0, 1.0) for position in centre_and_size)
    x, y, width, height = box_of(state, (640, 480))
    assert width >= 1
    assert height >= 1
    assert 0 <= x <= x + width <= 640
    assert 0 <= y <= y + height <= 480


def test_the_sides_of_a_hand_are_at_least_a_pixel():
    assert area_of(start_box((0, 0, 90, 40))) == 3600.0
    assert area_of(tuple(Coordinate(p, 0.0, 1.0, 0.0, 1.0) for p in (0.0, 0.0, -3.0, 0.0))) == 1.0
