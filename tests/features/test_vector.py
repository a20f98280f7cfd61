import numpy as np

from lightgesture.features.hog import hog
from lightgesture.features.outline.contours import contour_vectors
from lightgesture.features.vector import VectorSettings, block_lengths, feature_vectors


def test_the_vector_is_gradients_then_contour() -> None:
    settings = VectorSettings()
    patches = np.random.default_rng(0).integers(0, 256, (3, 32, 32, 3)).astype(np.uint8)
    vectors = feature_vectors(patches, settings)
    gradients, contour = block_lengths(settings)
    assert vectors.shape == (3, gradients + contour)
    assert vectors.dtype == np.float32
    assert np.array_equal(vectors[:, :gradients], hog(patches))
    assert np.array_equal(vectors[:, gradients:], contour_vectors(patches))
