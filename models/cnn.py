"""A tiny convolutional net in integers that names the token of a patch, and a larger one for those that it doubts.

The net is data (`features.net`): LiteRT runs it where installed, NumPy computes the same integers elsewhere. It may
look at the numbers of the patch's outline, too. Patches are standardised channel by channel first
(`features.standardise`), so that cast, veil and exposure drop out.
Probabilities are the softmax of scores / temperature (Guo, Pleiss, Sun and Weinberger, "On Calibration of Modern Neural
Networks", ICML 2017).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.net.runner import Backend, Network
from lightgesture.features.outline.contours import ContourSettings, contour_vectors
from lightgesture.features.patch import PatchSettings, cut_patches
from lightgesture.features.standardise import patch_levels
from lightgesture.features.types import Box, Float
from lightgesture.models.calibration import none_where_small, softmax

PATCH: Final = "patch"
CONTOUR: Final = "contour"
SCORES: Final = "scores"
"""Tensors of the net: standardised blue, green and red; standardised numbers of the outline; one score a class."""


@dataclass(frozen=True, slots=True, eq=False)
class SecondLook:
    """A larger net that is asked about the patches that the first one doubts.

    network: in integers, of the same patches and classes. temperature: of its softmax, > 0. sure: probability of the
    first net's likeliest class from which it is not asked, 0 to 1; 0 never asks it.
    """

    network: IntegerNetwork
    temperature: float
    sure: float


@dataclass(frozen=True, slots=True, eq=False)
class CnnModel:
    """All that the net needs on the board.

    classes: k names. patch: how a patch is cut. network: in integers. temperature: of the softmax, > 0.
    smallest_hand: longer side in pixels of the smallest box that is read; a smaller hand is `none`.
    contour: how the outline is measured, None where the net does not look at it. contour_mean, contour_deviation:
    float32 (c,), by which the outline's numbers are standardised; empty without. second: None where the net is alone.
    """

    classes: tuple[str, ...]
    patch: PatchSettings
    network: IntegerNetwork
    temperature: float
    smallest_hand: int
    contour: ContourSettings | None
    contour_mean: Float
    contour_deviation: Float
    second: SecondLook | None = None


MOST_DOUBTED: Final = 4
"""Patches of a frame that are looked at a second time, the most doubtful, so that no picture costs more."""
SECOND_WEIGHT: Final = 0.7
"""Of the second net's probabilities beside the first one's, 0 to 1."""


class CnnClassifier:
    """Patches -> probabilities of classes."""

    def __init__(self, model: CnnModel, backend: Backend = "auto") -> None:
        """backend: "litert", "numpy", or "auto" for the first that is installed. Raises NetworkError."""
        self.model, self.classes = model, model.classes
        self._network = Network(model.network, backend)
        self._second = None if model.second is None else Network(model.second.network, backend)

    def scores(self, patches: NDArray[np.uint8]) -> Float:
        """Scores of patches, uint8 (n, size, size, 3), BGR -> float32 (n, k)."""
        model, network = self.model, self._network
        inputs = {PATCH: patch_levels(patches, model.network.quantisation[PATCH])}
        if model.contour is not None:
            numbers = (contour_vectors(patches, model.contour) - model.contour_mean) / model.contour_deviation
            inputs[CONTOUR] = network.table(CONTOUR, numbers)[:, None, None, :]
        return network.run(inputs)[SCORES].reshape(len(patches), len(model.classes))

    def second_scores(self, patches: NDArray[np.uint8]) -> Float:
        """Those of the larger net, which the model must have: the same shapes."""
        second = self.model.second
        if second is None or self._second is None:
            raise ValueError("the model has no larger net for a second look")
        inputs = {PATCH: patch_levels(patches, second.network.quantisation[PATCH])}
        return self._second.run(inputs)[SCORES].reshape(len(patches), len(self.model.classes))

    def probabilities(
        self, image_bgr: NDArray[np.uint8], boxes: Sequence[Box], sides: Sequence[str]
    ) -> Float:
        """Calibrated probabilities, float32 (n, k), rows sum to 1; see `Classifier`."""
        model = self.model
        patches = cut_patches(image_bgr, boxes, sides, model.patch)
        if not len(patches):
            return np.empty((0, len(model.classes)), np.float32)
        probabilities = softmax(self.scores(patches), model.temperature)
        if model.second is not None:
            doubted = most_doubted(probabilities, model.second.sure)
            if len(doubted):
                own = softmax(self.second_scores(patches[doubted]), model.second.temperature)
                probabilities[doubted] = weighed(probabilities[doubted], own)
        return none_where_small(probabilities, model.classes, boxes, model.smallest_hand)


def most_doubted(probabilities: Float, sure: float) -> NDArray[np.intp]:
    """Rows of probabilities (n, k) that are worth a second look, the most doubtful first, `MOST_DOUBTED` at most."""
    clearness = probabilities.max(axis=1)
    order = np.argsort(clearness, kind="stable")[:MOST_DOUBTED]
    return np.asarray(order[clearness[order] < sure], np.intp)


def weighed(first: Float, second: Float) -> Float:
    """Probabilities of both nets together, (n, k)."""
    return np.asarray(first + np.float32(SECOND_WEIGHT) * (second - first), np.float32)
