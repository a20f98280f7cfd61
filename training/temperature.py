"""The temperature of a softmax, by which its probabilities say how often they are right."""

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float
from lightgesture.models.calibration import softmax


def fit_temperature(scores: Float, truth: NDArray[np.int64]) -> float:
    """Temperature of the softmax with the smallest cross-entropy, by search over a finer and finer grid.

    Guo, Pleiss, Sun and Weinberger, "On Calibration of Modern Neural Networks", ICML 2017.
    """
    best, step = 0.0, np.log(10.0) / 2.0
    for _ in range(6):
        logarithms = best + step * np.linspace(-4.0, 4.0, 9)
        entropies = [_cross_entropy(scores, truth, float(np.exp(point))) for point in logarithms]
        best = float(logarithms[int(np.argmin(entropies))])
        step /= 4.0
    return float(np.exp(best))


def _cross_entropy(scores: Float, truth: NDArray[np.int64], temperature: float) -> float:
    """Of n answers each takes a share of 1 / (n + 2) for another class, as in Platt, "Probabilistic outputs for support
    vector machines", 1999: right answers alone would otherwise call for a temperature of 0."""
    logarithms = np.log(np.maximum(softmax(scores, temperature), 1e-12))
    count, classes = scores.shape
    own = logarithms[np.arange(count), truth]
    others = (logarithms.sum(axis=1) - own) / max(classes - 1, 1)
    share = 1.0 / (count + 2)
    return -float(((1.0 - share) * own + share * others).mean())
