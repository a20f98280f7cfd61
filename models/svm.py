"""A support vector machine with a radial kernel over few expansion vectors, in NumPy alone.

A patch's feature vector x is projected, z = P (x - mean), and class k scores
f_k = sum_j a_jk exp(-gamma |z - c_j|²) + b_k: one machine a class against all others. Probabilities are the softmax
of f / temperature (Guo, Pleiss, Sun and Weinberger, "On Calibration of Modern Neural Networks", ICML 2017).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import cut_patches
from lightgesture.features.types import Box, Float
from lightgesture.features.vector import feature_vectors
from lightgesture.models.calibration import none_where_small, softmax
from lightgesture.models.svm_file import SvmModel


def radial_kernel(points: Float, centres: Float, gamma: float, squares: Float | None = None) -> Float:
    """exp(-gamma |z - c|²) of every one of `points` (n, p) with every one of `centres` (m, p), float32 (n, m).

    squares: gamma |c|² of the centres, (m,), which for two hands take longer than all the rest.
    """
    if squares is None:
        squares = squared_lengths(centres) * np.float32(gamma)
    # Doubled and scaled before the product, which has so many more numbers than the points.
    powers = (points * np.float32(2.0 * gamma)) @ centres.T
    powers -= (squared_lengths(points) * np.float32(gamma))[:, None]
    powers -= squares
    # Rounding can leave a tiny negative distance.
    np.minimum(powers, np.float32(0.0), out=powers)
    return np.asarray(np.exp(powers, out=powers), np.float32)


def squared_lengths(rows: Float) -> Float:
    """|r|² of each row of (n, p), float32 (n,)."""
    return np.asarray(np.einsum("ij,ij->i", rows, rows), np.float32)


class SvmClassifier:
    """Feature vectors of patches -> probabilities of classes."""

    def __init__(self, model: SvmModel) -> None:
        # Column by column in memory: the product with few hands then reads the centres in one sweep.
        self.model = replace(model, centres=np.asfortranarray(model.centres))
        self.classes = model.classes
        self._squares = squared_lengths(model.centres) * np.float32(model.gamma)

    def project(self, vectors: Float) -> Float:
        """Feature vectors (n, d) in the kernel's space, float32 (n, p)."""
        return np.asarray((vectors - self.model.mean) @ self.model.projection, np.float32)

    def scores(self, vectors: Float) -> Float:
        """Decision values of feature vectors (n, d), float32 (n, k)."""
        model = self.model
        kernel = radial_kernel(self.project(vectors), model.centres, model.gamma, self._squares)
        return np.asarray(kernel @ model.weights + model.bias, np.float32)

    def probabilities(
        self, image_bgr: NDArray[np.uint8], boxes: Sequence[Box], sides: Sequence[str]
    ) -> Float:
        """Calibrated probabilities, float32 (n, k), rows sum to 1; see `Classifier`."""
        model = self.model
        patches = cut_patches(image_bgr, boxes, sides, model.features.patch)
        if not len(patches):
            return np.empty((0, len(model.classes)), np.float32)
        probabilities = softmax(self.scores(feature_vectors(patches, model.features)), model.temperature)
        return none_where_small(probabilities, model.classes, boxes, model.smallest_hand)
