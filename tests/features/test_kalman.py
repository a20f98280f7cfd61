"""The written-out filter against the reference library, late and uneven observations included."""

import numpy as np
import pytest

from lightgesture.features import kalman


def _reference(dt: float, acceleration: float, noise: float):
    filterpy = pytest.importorskip("filterpy.kalman", reason="filterpy comes with the extra dev")
    reference = filterpy.KalmanFilter(dim_x=2, dim_z=1)
    reference.F = np.array([[1.0, dt], [0.0, 1.0]])
    reference.H = np.array([[1.0, 0.0]])
    reference.Q = acceleration * np.array([[dt**4 / 4, dt**3 / 2], [dt**3 / 2, dt**2]])
    reference.R = np.array([[noise]])
    return reference


@pytest.mark.parametrize("seed", range(4))
def test_agrees_with_the_reference_filter_at_uneven_steps(seed):
    rng = np.random.default_rng(seed)
    acceleration, noise = 900.0, 4.0
    state = kalman.start(100.0, noise, 50.0)
    reference = _reference(0.0, acceleration, noise)
    reference.x = np.array([[100.0], [0.0]])
    reference.P = np.diag([noise, 50.0])
    for _ in range(60):
        dt = float(rng.choice([0.0, 1 / 60, 1 / 30, 0.4]))
        seen = rng.random() < 0.8
        measured = float(100 + rng.normal(0, 30))
        step = _reference(dt, acceleration, noise)
        reference.F, reference.Q = step.F, step.Q
        reference.predict()
        state = kalman.predict(state, dt, acceleration)
        if seen:
            expected = float((measured - reference.x[0, 0]) ** 2 / (reference.P[0, 0] + noise))
            assert kalman.distance(state, measured, noise) == pytest.approx(expected, abs=1e-9)
            reference.update(measured)
            state = kalman.update(state, measured, noise)
        mean = [state.position, state.velocity]
        covariance = [[state.p00, state.p01], [state.p01, state.p11]]
        np.testing.assert_allclose(mean, reference.x[:, 0], rtol=0, atol=1e-9)
        np.testing.assert_allclose(covariance, reference.P, rtol=1e-9, atol=1e-9)


def test_a_step_of_zero_changes_nothing():
    state = kalman.start(3.0, 1.0, 2.0)
    assert kalman.predict(state, 0.0, 100.0) == state
