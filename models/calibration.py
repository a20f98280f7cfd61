"""From scores to calibrated probabilities, the same for every classifier."""

from collections.abc import Sequence

import numpy as np

from lightgesture.features.types import Box, Float
from lightgesture.models.classes import NONE


def softmax(scores: Float, temperature: float) -> Float:
    """Probabilities from scores (n, k), float32 (n, k)."""
    powers = scores / np.float32(temperature)
    powers -= powers.max(axis=1, keepdims=True)
    np.exp(powers, out=powers)
    powers /= powers.sum(axis=1, keepdims=True)
    return np.asarray(powers, np.float32)


def none_where_small(
    probabilities: Float, classes: Sequence[str], boxes: Sequence[Box], smallest_hand: int
) -> Float:
    """The same, with certainty of `none` where the longer side of a box has fewer pixels than `smallest_hand`."""
    for place, box in enumerate(boxes):
        if max(box[2], box[3]) < smallest_hand and NONE in classes:
            probabilities[place] = [name == NONE for name in classes]
    return probabilities
