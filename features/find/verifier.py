"""Hand or not, once more: a larger int8 net on a patch, for the places that the trees doubt.

It learns on from a net that reads hands, which knows hands of hundreds of people where locator and refiner know those
of pictures with boxes alone. The last stage of a cascade (Viola and Jones, "Robust Real-Time Face Detection", 2004):
the dearest one, asked about least.
"""

from typing import Final

import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.find.candidates import logit
from lightgesture.features.find.windows import WindowSettings, windows_in
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Network, logistic
from lightgesture.features.standardise import patch_levels
from lightgesture.features.types import Float

INPUT, HAND = "patch", "hand"
"""Tensors of the net: blue, green and red, each patch standardised by itself as readers see it; the logit of a hand."""
WINDOW: Final = WindowSettings(size=32, context=1.4)
DOUBTED: Final = (0.2, 0.8)
"""Least and largest score of a place that is verified, 0 to 1: a wider range costs more and tells no more hands."""
MOST_VERIFIED: Final = 4
"""Places of a frame that are verified, the best, so that no picture costs more."""
WEIGHT: Final = 0.5
"""Of the net's log-odds beside those of the score. It has learnt from the pictures that the nets before it have learnt
from, so their mistakes are not independent, and the whole of both would say too much."""
EVEN: Final = 1.7
"""Logit of the net at which a score stays as it is. Half of what it learnt from are hands, of places in doubt few: with
this, a score stands for what it did, and of negatives fewer are taken for hands than without the net."""


class Verifier:
    """Runs the net on some places of a frame."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = Network(network)

    def process(self, colour: ColourMap, boxes: Float, scores: Float) -> Float:
        """Scores, float32 (n,), 0 to 1, of places, float32 (n, 4) in working pixels: the doubted ones looked at again,
        the others as they are."""
        order = np.argsort(-scores, kind="stable")
        low, high = DOUBTED
        doubted = order[(scores[order] >= low) & (scores[order] <= high)][:MOST_VERIFIED]
        if not len(doubted):
            return scores
        patches, _, _ = windows_in(colour, boxes[doubted], WINDOW)
        seen = patch_levels(patches, self._network.quantisation(INPUT))
        verified = scores.copy()
        verified[doubted] = together(scores[doubted], self._network.run({INPUT: seen})[HAND].ravel())
        return verified


def together(scores: Float, logits: Float) -> Float:
    """float32 (n,): scores, 0 to 1, and the verifier's logits as one score, by the sum of their log-odds
    (`WEIGHT`, `EVEN`)."""
    odds = logit(scores) + WEIGHT * (logits - EVEN)
    return logistic(np.asarray(odds, np.float32))
