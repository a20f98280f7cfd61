from dataclasses import replace

import numpy as np
import pytest
from sklearn.metrics.pairwise import rbf_kernel

from lightgesture.training.svm.descent import Machine, descend, hinge_gradients


@pytest.fixture
def machine() -> Machine:
    random = np.random.default_rng(0)
    shapes = ((6, 3), (5, 3), (5, 2), (2,))
    return Machine(*(random.normal(scale=0.5, size=shape).astype(np.float32) for shape in shapes))


def reference_loss(machine: Machine, samples: np.ndarray, targets: np.ndarray) -> float:
    """One sample and one class at a time, in double precision."""
    projection, centres, weights, bias = (part.astype(np.float64) for part in machine.parts)
    scores = rbf_kernel(samples.astype(np.float64) @ projection, centres, gamma=1.0) @ weights + bias
    total = 0.0
    for row, wanted in zip(scores, targets, strict=True):
        total += sum(max(0.0, 1.0 - side * score) ** 2 for side, score in zip(wanted, row, strict=True))
    return total / len(samples)


def test_the_derivatives_are_those_of_the_loss(machine: Machine) -> None:
    random = np.random.default_rng(1)
    samples = random.normal(size=(20, 6)).astype(np.float32)
    targets = np.where(random.random((20, 2)) < 0.5, 1.0, -1.0).astype(np.float32)
    loss, gradients = hinge_gradients(machine, samples, targets)
    assert loss == pytest.approx(reference_loss(machine, samples, targets), rel=1e-5)
    for name in ("projection", "centres", "weights", "bias"):
        part, gradient = getattr(machine, name), getattr(gradients, name)
        assert gradient.shape == part.shape
        for place in np.ndindex(part.shape):
            ends = []
            for step in (-1e-3, 1e-3):
                moved = part.astype(np.float64)
                moved[place] += step
                ends.append(reference_loss(replace(machine, **{name: moved}), samples, targets))
            assert gradient[place] == pytest.approx((ends[1] - ends[0]) / 2e-3, abs=2e-4)


def circles(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Points in the first two of six numbers, inside and outside a circle; the other four are noise."""
    random = np.random.default_rng(2)
    samples = random.normal(size=(count, 6)).astype(np.float16)
    return samples, (np.square(samples[:, :2].astype(float)).sum(axis=1) > 1.4).astype(np.int64)


def test_it_learns_where_to_look_and_where_to_put_few_vectors(machine: Machine) -> None:
    samples, truth = circles(4000)
    learnt = descend(machine, samples, truth, np.ones(4000, np.float32), 1500, 0, lambda *_: None)
    fresh, expected = circles(1000)
    points = fresh.astype(np.float32) @ learnt.projection
    scores = rbf_kernel(points, learnt.centres, gamma=1.0) @ learnt.weights + learnt.bias
    assert (scores.argmax(axis=1) == expected).mean() > 0.9
    reach = np.linalg.norm(learnt.projection, axis=1)
    assert reach[:2].min() > 2.0 * reach[2:].max()


def test_what_weighs_nothing_is_never_seen(machine: Machine) -> None:
    samples, truth = circles(400)
    spoilt = samples.copy()
    weights = np.ones(400, np.float32)
    weights[::3] = 0.0
    spoilt[::3] = np.nan
    learnt = [descend(machine, own, truth, weights, 20, 0, lambda *_: None) for own in (samples, spoilt)]
    for part, other in zip(learnt[0].parts, learnt[1].parts, strict=True):
        assert np.isfinite(other).all()
        assert np.array_equal(part, other)


def test_without_steps_it_stays_as_it_starts(machine: Machine) -> None:
    samples, truth = circles(40)
    weights = np.ones(40, np.float32)
    same = descend(machine, samples, truth, weights, 0, 0, lambda *_: None)
    assert all(np.array_equal(*parts) for parts in zip(machine.parts, same.parts, strict=True))
