"""The filters of a whole box: the two backends agree, and a missing library is one clear line."""

import sys

import numpy as np
import pytest

from lightgesture.features.track.motion import (
    ClosedFilter,
    FilterError,
    clip_box,
    hand_size,
    load_filter,
    measure,
    meets,
    start_state,
    stop,
)


def _started(box=(100, 100, 60, 80)):
    return start_state(measure(box), 16.0, 100.0, 400.0, 25.0)


@pytest.mark.parametrize("seed", range(5))
def test_the_closed_form_agrees_with_filterpy_on_random_sequences_with_uneven_steps(seed):
    pytest.importorskip("filterpy", reason="filterpy comes with the extra dev")
    rng = np.random.default_rng(seed)
    closed, reference = ClosedFilter(), load_filter("filterpy")
    own = other = _started()
    for _ in range(50):
        dt = float(rng.choice([0.0, 1 / 60, 1 / 30, 0.1, 0.5, rng.uniform(0, 0.3)]))
        centre, size = float(rng.uniform(100, 1e5)), float(rng.uniform(10, 1e4))
        own = closed.predict(own, dt, centre, size)
        other = reference.predict(other, dt, centre, size)
        if rng.random() < 0.8:
            x, y, width, height = rng.normal([130, 140, 60, 80], [30, 30, 15, 20]).tolist()
            centre, size = float(rng.uniform(4, 200)), float(rng.uniform(20, 900))
            own = closed.update(own, (x, y, width, height), centre, size)
            other = reference.update(other, (x, y, width, height), centre, size)
        np.testing.assert_allclose(np.array(own), np.array(other), rtol=1e-9, atol=1e-9)


def test_a_missing_library_is_told_with_the_remedy(monkeypatch):
    monkeypatch.setitem(sys.modules, "filterpy", None)
    with pytest.raises(FilterError, match=r'not installed; pip install "filterpy>=2,<3"') as error:
        load_filter("filterpy")
    assert "\n" not in str(error.value)


def test_an_unknown_filter_is_refused_with_the_choices():
    with pytest.raises(FilterError, match='unknown track filter "ukf"; choose "closed" or "filterpy"'):
        load_filter("ukf")


def test_centre_and_size_have_noises_of_their_own():
    state = ClosedFilter().update(_started(), (160.0, 140.0, 90.0, 80.0), centre=1.0, size=10_000.0)
    assert state[0].position == pytest.approx(160.0, abs=2.0)
    assert state[2].position == pytest.approx(60.0, abs=2.0)


def test_a_stopped_hand_rests_and_is_as_uncertain_as_before():
    moving = ClosedFilter().update(
        ClosedFilter().predict(_started(), 0.1, 1e4, 1e3), (150.0, 150.0, 70.0, 80.0), 9.0, 90.0
    )
    rests = stop(moving)
    assert [item.velocity for item in rests] == [0.0] * 4
    assert [item[2:] for item in rests] == [item[2:] for item in moving]


def test_hands_meet_when_their_boxes_touch():
    assert meets(_started((100, 100, 60, 80)), _started((160, 150, 60, 80)))
    assert not meets(_started((100, 100, 60, 80)), _started((161, 100, 60, 80)))


@pytest.mark.parametrize(
    "centre_and_size",
    [(-500.0, -500.0, 60.0, 80.0), (9e3, 9e3, 60.0, 80.0), (320.0, 240.0, -5.0, 0.0), (0.0, 0.0, 4e3, 4e3)],
)
def test_a_clipped_box_lies_inside_the_picture_and_is_at_least_a_pixel_large(centre_and_size):
    x, y, width, height = clip_box(*centre_and_size, (640, 480))
    assert width >= 1
    assert height >= 1
    assert 0 <= x <= x + width <= 640
    assert 0 <= y <= y + height <= 480


def test_the_size_of_a_hand_is_at_least_a_pixel():
    assert hand_size(_started((0, 0, 90, 40))) == pytest.approx(60.0)
    assert hand_size(start_state((0.0, 0.0, -3.0, 0.0), 1.0, 1.0, 1.0, 1.0)) == 1.0
