"""Where the landmarks of a hand lie in its patch, for nets that learn them as a second task."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import PatchSettings, squares_round
from lightgesture.training.samples import TrainingSample

LANDMARKS: Final = 21
"""Of a hand: wrist, then four of each finger."""
COORDINATES: Final = 2 * LANDMARKS
"""Numbers of a hand, x and y of each landmark in turn."""


def patch_landmarks(sample: TrainingSample, patch: PatchSettings) -> NDArray[np.float16]:
    """Landmarks of a sample in the patch that `cut_patch` cuts of it: float16 (42,), x and y of each in turn.

    The unit is the patch's side, 0 its left or upper edge and 1 the other one; a landmark beside the patch lies below 0
    or above 1. NaN where the sample has no landmarks.
    """
    if sample.landmarks is None:
        return np.full(COORDINATES, np.nan, np.float16)
    ((left, top, side),) = squares_round([sample.box], patch.context)
    # The middle of a picture's first pixel is (0, 0), the corner of a patch is.
    places = (np.asarray(sample.landmarks, np.float64) + 0.5 - (left, top)) / side
    if sample.side == "right":
        places[:, 0] = 1.0 - places[:, 0]
    return np.asarray(places.reshape(-1), np.float16)
