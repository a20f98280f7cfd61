"""The written-out filter of one coordinate against the reference library, and what its noise means."""

import numpy as np
import pytest

from lightgesture.features.track import kalman


def _reference():
    return pytest.importorskip("filterpy.kalman", reason="filterpy comes with the extra dev")


@pytest.mark.parametrize("seed", range(6))
def test_agrees_with_the_reference_filter_at_uneven_steps(seed):
    reference = _reference()
    rng = np.random.default_rng(seed)
    density, noise = float(rng.uniform(10, 2000)), float(rng.uniform(1, 30))
    state = kalman.start(100.0, noise, 50.0)
    mean, covariance = np.array([100.0, 0.0]), np.diag([noise, 50.0])
    for _ in range(80):
        dt = float(rng.choice([0.0, 1 / 60, 1 / 30, 0.1, 0.4, rng.uniform(0, 0.2)]))
        motion = np.array([[1.0, dt], [0.0, 1.0]])
        growth = density * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
        mean, covariance = reference.predict(mean, covariance, motion, growth)
        state = kalman.predict(state, dt, density)
        if rng.random() < 0.8:
            measured = float(100 + rng.normal(0, 30))
            expected = float((measured - mean[0]) ** 2 / (covariance[0, 0] + noise))
            assert kalman.distance(state, measured, noise) == pytest.approx(expected, rel=1e-9, abs=1e-9)
            mean, covariance = reference.update(
                mean, covariance, np.array([measured]), np.array([[noise]]), np.array([[1.0, 0.0]])
            )
            state = kalman.update(state, measured, noise)
        np.testing.assert_allclose([state.position, state.velocity], mean, rtol=1e-9, atol=1e-9)
        own = [[state.p00, state.p01], [state.p01, state.p11]]
        np.testing.assert_allclose(own, covariance, rtol=1e-9, atol=1e-9)


def test_a_step_of_zero_changes_nothing():
    state = kalman.start(3.0, 1.0, 2.0)
    assert kalman.predict(state, 0.0, 100.0) == state


@pytest.mark.parametrize("steps", [1, 3, 6, 60])
def test_the_prediction_does_not_depend_on_how_a_second_is_divided(steps):
    state = kalman.Coordinate(10.0, 5.0, 4.0, 1.0, 9.0)
    for _ in range(steps):
        state = kalman.predict(state, 1.0 / steps, 300.0)
    whole = kalman.predict(kalman.Coordinate(10.0, 5.0, 4.0, 1.0, 9.0), 1.0, 300.0)
    np.testing.assert_allclose(state, whole, rtol=1e-12)


def test_a_measurement_shrinks_the_variance_and_moves_towards_what_was_measured():
    before = kalman.predict(kalman.start(0.0, 4.0, 100.0), 0.1, 50.0)
    after = kalman.update(before, 10.0, 4.0)
    assert before.position < after.position < 10.0
    assert after.velocity > 0.0
    assert after.p00 < before.p00
    assert after.p11 < before.p11
