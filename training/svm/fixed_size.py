"""The least-squares machine of fixed size: sums over samples, and the machine that follows from them."""

import numpy as np
from numpy.typing import NDArray

from lightgesture.models.projection import Progress
from lightgesture.models.svm import radial_kernel

Float = NDArray[np.float32]
Double = NDArray[np.float64]

ROWS = 4096
"""Kernel rows held at once, which bounds the memory."""


def kernel_basis(centres: Float, gamma: float) -> Double:
    """Kernel values at the centres times this (m, r) are the features of the machine: K^(-1/2), rank r."""
    values, vectors = np.linalg.eigh(radial_kernel(centres, centres, gamma).astype(np.float64))
    kept = values > 1e-6 * values[-1]
    return np.asarray(vectors[:, kept] / np.sqrt(values[kept]))


def fit_fixed_size(
    points: Float,
    centres: Float,
    gamma: float,
    targets: Float,
    sample_weights: Float,
    ridge: float,
    progress: Progress,
) -> tuple[Float, Float]:
    """Weights of the centres, float32 (m, k), and bias (k,), that are best in the weighted least squares.

    points: (n, p). targets: (n, k). sample_weights: (n,). ridge: weight of the squared norm of the machine against
    the mean squared error.
    """
    basis = kernel_basis(centres, gamma)
    single = basis.astype(np.float32)
    size = basis.shape[1] + 1
    squares, products = np.zeros((size, size)), np.zeros((size, targets.shape[1]))
    for start in range(0, len(points), ROWS):
        rows = slice(start, start + ROWS)
        features = radial_kernel(points[rows], centres, gamma) @ single
        # A column of ones for the bias.
        features = np.concatenate([features, np.ones((len(features), 1), np.float32)], axis=1)
        weighted = (features * sample_weights[rows, None]).T
        squares += weighted @ features
        products += weighted @ targets[rows]
        progress("sum over samples", min(start + ROWS, len(points)), len(points))
    penalty = np.full(size, ridge * float(sample_weights.sum()))
    penalty[-1] = 1e-9
    squares[np.diag_indices_from(squares)] += penalty
    solution = np.linalg.solve(squares, products)
    return (basis @ solution[:-1]).astype(np.float32), solution[-1].astype(np.float32)
