"""Other colours for standardised patches, so that a net reads shapes and not the colours that its pictures share.

Under water a hand differs from what is behind it in other channels than in a room, and a black glove before bright
water is darker than it where a bare hand before a suit is brighter. Labels stay: what a hand shows has no colour.
"""

from typing import Final

import numpy as np

from lightgesture.features.standardise import LARGEST
from lightgesture.features.types import Float

Random = np.random.Generator

MIXED_SHARE: Final = 0.5
"""Of patches, those whose channels are mixed."""
GREY_SHARE: Final = 0.4
"""Of these, those of which all channels are the same mixture."""
EVENNESS: Final = 0.6
"""Parameter of the Dirichlet distribution of a mixture's weights: below 1 mostly one channel rules, now this, now
that."""
INVERTED_SHARE: Final = 0.15
"""Of patches, those that are dark where they were bright."""
LEAST_DEVIATION: Final = 0.05
"""Of a mixture, which two channels that mirror each other may leave flat."""


def recolour(patches: Float, random: Random) -> None:
    """Change some standardised patches, float32 (n, size, size, 3), in place; each stays standardised."""
    mixed = np.flatnonzero(random.random(len(patches)) < MIXED_SHARE)
    if len(mixed):
        patches[mixed] = _mixed(patches[mixed], random)
    patches[random.random(len(patches)) < INVERTED_SHARE] *= -1.0


def _mixed(patches: Float, random: Random) -> Float:
    weights = random.dirichlet((EVENNESS,) * 3, (len(patches), 3)).astype(np.float32)
    grey = random.random(len(patches)) < GREY_SHARE
    weights[grey] = weights[grey][:, :1]
    mixtures = np.einsum("nhwc,ndc->nhwd", patches, weights)
    mean = mixtures.mean(axis=(1, 2), keepdims=True)
    deviation = np.maximum(mixtures.std(axis=(1, 2), keepdims=True), LEAST_DEVIATION)
    return np.asarray(np.clip((mixtures - mean) / deviation, -LARGEST, LARGEST), np.float32)
