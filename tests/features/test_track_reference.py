"""The filter against filterpy: its equations as eight-by-eight matrices, a hundred times as slow."""

import numpy as np
import pytest

from lightgesture.features.track import state as state_module
from lightgesture.features.track import tracker as tracker_module
from lightgesture.features.track.kalman import (
    CENTRE_DENSITY,
    CENTRE_NOISE,
    SIZE_DENSITY,
    SIZE_NOISE,
    Coordinate,
    area_of,
    precision_of,
    predict_box,
    squared_distance,
    start_box,
    update_box,
)
from lightgesture.features.track.tracker import Tracker


class _Reference:
    """Predicts and updates the same states through filterpy."""

    def __init__(self):
        self._filter = pytest.importorskip("filterpy.kalman", reason="filterpy comes with the extra dev")

    def predict(self, state, dt):
        mean, covariance = _to_matrices(state)
        eye, zero = np.eye(4), np.zeros((4, 4))
        density = np.diag([CENTRE_DENSITY, CENTRE_DENSITY, SIZE_DENSITY, SIZE_DENSITY]) * area_of(state)
        transition = np.block([[eye, dt * eye], [zero, eye]])
        noise = np.block([[dt**3 / 3 * density, dt**2 / 2 * density], [dt**2 / 2 * density, dt * density]])
        return _to_state(*self._filter.predict(mean, covariance, F=transition, Q=noise))

    def update(self, state, box):
        mean, covariance = _to_matrices(state)
        return _to_state(
            *self._filter.update(mean, covariance, _centre_and_size(box), R=_noise(state), H=_OBSERVATION)
        )


_OBSERVATION = np.hstack([np.eye(4), np.zeros((4, 4))])


def _noise(state):
    return np.diag(np.square([CENTRE_NOISE, CENTRE_NOISE, SIZE_NOISE, SIZE_NOISE])) * area_of(state)


def _centre_and_size(box):
    x, y, width, height = box
    return np.array([x + width / 2, y + height / 2, width, height])


def _to_matrices(state):
    """Mean float64 (8,) and covariance float64 (8, 8) of (x, x')."""
    parts = np.array(state)
    p00, p01, p11 = (np.diag(parts[:, column]) for column in (2, 3, 4))
    return np.concatenate([parts[:, 0], parts[:, 1]]), np.block([[p00, p01], [p01, p11]])


def _to_state(mean, covariance):
    return tuple(
        Coordinate(*map(float, (mean[i], mean[i + 4], *covariance[[i, i, i + 4], [i, i + 4, i + 4]])))
        for i in range(4)
    )


@pytest.mark.parametrize("seed", range(8))
def test_the_filter_agrees_with_filterpy_on_random_sequences_with_uneven_steps(seed):
    reference, rng = _Reference(), np.random.default_rng(seed)
    own = other = start_box((100, 100, 60, 80))
    for _ in range(60):
        dt = float(rng.choice([0.0, 1 / 60, 1 / 30, 0.1, 0.4, 0.5, rng.uniform(0, 0.3)]))
        own, other = predict_box(own, dt), reference.predict(other, dt)
        if rng.random() < 0.8:
            box = tuple(int(side) for side in rng.normal([100, 100, 60, 80], [40, 40, 20, 25]))
            mean, covariance = _to_matrices(other)
            surprise = _centre_and_size(box) - mean[:4]
            squared = surprise @ np.linalg.inv(covariance[:4, :4] + _noise(other)) @ surprise
            assert squared_distance(own, precision_of(own), box) == pytest.approx(squared, rel=1e-9, abs=1e-9)
            own, other = update_box(own, box), reference.update(other, box)
        np.testing.assert_allclose(np.array(own), np.array(other), rtol=1e-9, atol=1e-9)


def test_the_reference_gives_the_same_tracks(region, frame, monkeypatch):
    shown = [
        frame(
            [region(160 + 5 * n, 140), region(460 - 3 * n, 150 + 2 * n)] if n % 7 != 3 else [],
            0.8 if n % 7 != 3 else None,
        )
        for n in range(30)
    ]

    def told():
        tracker = Tracker()
        return [
            [(track.number, track.side, track.box, track.missed) for track in tracker.update(item, n / 30)]
            for n, item in enumerate(shown)
        ]

    own, reference = told(), _Reference()
    monkeypatch.setattr(tracker_module, "predict_box", reference.predict)
    monkeypatch.setattr(state_module, "update_box", reference.update)
    assert told() == own
    assert any(missed for tracks in own for *_, missed in tracks)
