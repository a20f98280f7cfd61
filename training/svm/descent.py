"""All parts of a radial machine learnt together: projection, expansion vectors and weights, by descent of one loss.

Wu, Schölkopf and Bakir, "A Direct Method for Building Sparse Kernel Learning Algorithms", Journal of Machine Learning
Research 7, 2006: a machine whose expansion vectors are learnt needs far fewer than one that takes them from the data.
The loss is the squared hinge of each class against all others, as of support vector machines; what is drawn for a step
weighs by its frequency. The steps are Adam's (Kingma and Ba, ICLR 2015).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float
from lightgesture.models.svm import radial_kernel
from lightgesture.training.svm.projection import Progress

MOMENTUM, MEMORY = 0.9, 0.99
"""Of the mean gradient and of its mean square, from step to step."""
TINY = np.float32(1e-8)


BATCH = 512
"""Samples of a step."""
RATE = 0.02
"""Of the first steps, in spreads of the numbers that are learnt, 0.003 to 0.03; it falls to 0 by the last."""
CENTRE_RATE = 3.0
"""Of the expansion vectors over `RATE`."""
WARM_UP = 200
"""Steps in which the rate rises."""
DROPPED = 0.05
"""Share of a sample's numbers that a step does not see, 0 to 0.3, which keeps the machine from leaning on few."""


@dataclass(frozen=True, slots=True, eq=False)
class Machine:
    """What is learnt; float32. projection: (d, p). centres: (m, p). weights: (m, k). bias: (k,).

    Sample x scores sum_j weights_j exp(-|x projection - centre_j|²) + bias.
    """

    projection: Float
    centres: Float
    weights: Float
    bias: Float

    @property
    def parts(self) -> tuple[Float, Float, Float, Float]:
        """All arrays, in a fixed order."""
        return self.projection, self.centres, self.weights, self.bias


def hinge_gradients(machine: Machine, samples: Float, targets: Float) -> tuple[float, Machine]:
    """The loss of samples (n, d) and its derivatives by all that is learnt.

    targets: (n, k), 1 for the sample's class, -1 for the others. The loss is the mean over samples of the sum over
    classes of max(0, 1 - target score)².
    """
    points = samples @ machine.projection
    kernel = radial_kernel(points, machine.centres, 1.0)
    short = np.maximum(np.float32(0.0), 1.0 - targets * (kernel @ machine.weights + machine.bias))
    loss = float(np.square(short).sum(axis=1).mean())
    by_scores = np.asarray(targets * short * np.float32(-2.0 / len(samples)), np.float32)
    # By the squared distances, of which the kernel is exp(-d).
    by_squares = by_scores @ machine.weights.T
    by_squares *= kernel
    np.negative(by_squares, out=by_squares)
    by_points = points * by_squares.sum(axis=1)[:, None] - by_squares @ machine.centres
    by_centres = machine.centres * by_squares.sum(axis=0)[:, None] - by_squares.T @ points
    gradients = Machine(
        samples.T @ (np.float32(2.0) * by_points),
        np.float32(2.0) * by_centres,
        kernel.T @ by_scores,
        by_scores.sum(axis=0),
    )
    return loss, gradients


def descend(
    machine: Machine,
    samples: NDArray[np.float16],
    truth: NDArray[np.int64],
    weights: Float,
    steps: int,
    seed: int,
    progress: Progress,
) -> Machine:
    """The machine after so many steps.

    samples: (n, d). truth: (n,), numbers of their classes. weights: (n,), how often each is drawn beside others.
    """
    random = np.random.default_rng((seed, 1))
    frequency = np.cumsum(weights, dtype=np.float64)
    frequency /= frequency[-1]
    sizes = _spreads(machine)
    parts = [part.copy() for part in machine.parts]
    means, squares = ([np.zeros_like(part) for part in parts] for _ in range(2))
    signs = np.where(np.eye(len(machine.bias), dtype=bool), np.float32(1.0), np.float32(-1.0))
    for step in range(steps):
        drawn = np.searchsorted(frequency, random.random(BATCH))
        drawn = np.minimum(drawn, len(samples) - 1)
        seen = samples[drawn].astype(np.float32)
        seen *= random.random(seen.shape, np.float32) >= DROPPED
        seen /= np.float32(1.0 - DROPPED)
        _, gradients = hinge_gradients(Machine(*parts), seen, signs[truth[drawn]])
        rise = min(1.0, (step + 1) / WARM_UP) * (1.0 - step / steps)
        unbiased = np.sqrt(1.0 - MEMORY ** (step + 1)) / (1.0 - MOMENTUM ** (step + 1))
        for part, mean, square, gradient, size in zip(
            parts, means, squares, gradients.parts, sizes, strict=True
        ):
            mean += np.float32(1.0 - MOMENTUM) * (gradient - mean)
            square += np.float32(1.0 - MEMORY) * (gradient * gradient - square)
            part -= np.float32(size * rise * unbiased) * mean / (np.sqrt(square) + TINY)
        progress("learn the machine", step + 1, steps)
    return Machine(*parts)


def _spreads(machine: Machine) -> tuple[float, float, float, float]:
    """Length of a full step of each part's numbers."""
    projection = np.abs(machine.projection)
    return (
        RATE * float(projection.max(axis=0).mean()),
        RATE * CENTRE_RATE * float(machine.centres.std()),
        RATE * float(machine.weights.std()),
        RATE,
    )
