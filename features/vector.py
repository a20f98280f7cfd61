"""The feature vector of a patch: what classifiers and their training read."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.hog import HogSettings, hog, hog_length
from lightgesture.features.outline.contours import ContourSettings, contour_length, contour_vectors
from lightgesture.features.patch import PatchSettings
from lightgesture.features.types import Float


@dataclass(frozen=True, slots=True)
class VectorSettings:
    """How each part is made; a model's file says it in full."""

    patch: PatchSettings = field(default_factory=PatchSettings)
    """How the patch is cut."""
    hog: HogSettings = field(default_factory=HogSettings)
    """How its gradients are counted."""
    contour: ContourSettings = field(default_factory=ContourSettings)
    """How the hand's outline is found and measured."""


def block_lengths(settings: VectorSettings) -> tuple[int, int]:
    """Numbers from gradients and from the contour, in the vector's order.

    Raises ValueError for settings that do not go together.
    """
    return hog_length(settings.patch.size, settings.hog), contour_length(settings.contour)


def feature_vectors(patches: NDArray[np.uint8], settings: VectorSettings) -> Float:
    """Vectors of patches, uint8 (n, size, size, 3), as float32 (n, sum of `block_lengths`).

    First the gradients (`hog`), then the contour (`contour_numbers`; zeros where no outline was found).
    """
    return np.concatenate([hog(patches, settings.hog), contour_vectors(patches, settings.contour)], axis=1)
