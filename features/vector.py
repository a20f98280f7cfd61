"""The feature vector of a patch: what classifiers and their training read."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.hog import HogSettings, hog, hog_length
from lightgesture.features.patch import PatchSettings

Float = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class VectorSettings:
    """patch, hog: how each part is made."""

    patch: PatchSettings = field(default_factory=PatchSettings)
    hog: HogSettings = field(default_factory=HogSettings)


def vector_length(settings: VectorSettings) -> int:
    """Numbers in one vector. Raises ValueError for settings that do not go together."""
    return hog_length(settings.patch.size, settings.hog)


def feature_vectors(patches: NDArray[np.uint8], settings: VectorSettings) -> Float:
    """Vectors of patches, float32 (n, `vector_length`)."""
    return hog(patches, settings.hog)
