"""The least-squares machine of fixed size: sums over samples, and the machines and held-out answers that follow."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.models.projection import Progress
from lightgesture.models.svm import radial_kernel

Float = NDArray[np.float32]
Double = NDArray[np.float64]

ROWS = 4096
"""Kernel rows held at once, which bounds the memory."""


@dataclass(frozen=True, slots=True, eq=False)
class Sums:
    """Sums over samples of weight × feature × feature (r, r) and weight × feature × target (r, k)."""

    features: Double
    targets: Double
    weight: float


def kernel_basis(centres: Float, gamma: float) -> Double:
    """Kernel values at the centres times this (m, r) are the features of the machine: K^(-1/2), rank r."""
    values, vectors = np.linalg.eigh(radial_kernel(centres, centres, gamma).astype(np.float64))
    kept = values > 1e-6 * values[-1]
    return np.asarray(vectors[:, kept] / np.sqrt(values[kept]))


def _features(points: Float, centres: Float, gamma: float, basis: Float) -> Float:
    """Features of points (n, p), and a column of ones for the bias: float32 (n, r + 1)."""
    features = radial_kernel(points, centres, gamma) @ basis
    return np.concatenate([features, np.ones((len(points), 1), np.float32)], axis=1)


def accumulate(
    points: Float,
    centres: Float,
    gamma: float,
    basis: Double,
    truth: NDArray[np.int64],
    weights: Float,
    folds: NDArray[np.int64],
    classes: int,
    progress: Progress,
) -> list[Sums]:
    """The sums of each fold. Targets are 1 for the sample's own class and -1 for the others."""
    single = basis.astype(np.float32)
    size = basis.shape[1] + 1
    done = 0
    sums = []
    for fold in range(int(folds.max()) + 1):
        members = np.flatnonzero(folds == fold)
        features_sum, targets_sum = np.zeros((size, size)), np.zeros((size, classes))
        for start in range(0, len(members), ROWS):
            rows = members[start : start + ROWS]
            features = _features(points[rows], centres, gamma, single)
            targets = np.where(truth[rows, None] == np.arange(classes), 1.0, -1.0).astype(np.float32)
            weighted = (features * weights[rows, None]).T
            features_sum += weighted @ features
            targets_sum += weighted @ targets
            done += len(rows)
            progress("sum over samples", done, len(points))
        sums.append(Sums(features_sum, targets_sum, float(weights[members].sum())))
    return sums


def solve(sums: Sequence[Sums], ridge: float) -> Double:
    """Coefficients of the features and, last, the bias: float64 (r + 1, k)."""
    total = np.sum([part.features for part in sums], axis=0)
    penalty = np.full(len(total), ridge * sum(part.weight for part in sums))
    penalty[-1] = 1e-9
    total[np.diag_indices_from(total)] += penalty
    return np.asarray(np.linalg.solve(total, np.sum([part.targets for part in sums], axis=0)))


def held_out_scores(
    points: Float,
    centres: Float,
    gamma: float,
    basis: Double,
    sums: Sequence[Sums],
    folds: NDArray[np.int64],
    ridge: float,
) -> Float:
    """Scores (n, k) of every sample by the machine of the other folds."""
    scores = np.zeros((len(points), sums[0].targets.shape[1]), np.float32)
    for fold in range(len(sums)):
        solution = solve([part for number, part in enumerate(sums) if number != fold], ridge)
        weights = (basis @ solution[:-1]).astype(np.float32)
        members = np.flatnonzero(folds == fold)
        for start in range(0, len(members), ROWS):
            rows = members[start : start + ROWS]
            kernel = radial_kernel(points[rows], centres, gamma)
            scores[rows] = kernel @ weights + solution[-1].astype(np.float32)
    return scores
