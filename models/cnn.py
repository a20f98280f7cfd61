"""A tiny convolutional net in integers that names the token of a patch, and larger ones for those that it doubts.

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
class LargerNet:
    """network: in integers, of the same patches and classes as the first one. temperature: of its softmax, > 0."""

    network: IntegerNetwork
    temperature: float


@dataclass(frozen=True, slots=True, eq=False)
class SecondLook:
    """Larger nets that are asked about the patches that the first one doubts; the mean of their probabilities counts.
    Nets that learnt from other pictures are seldom sure of the same mistake.

    nets: one or more. sure: probability of the first net's likeliest class from which they are not asked, 0 to 1; 0
    never asks them.
    """

    nets: tuple[LargerNet, ...]
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
SECOND_WEIGHT: Final = 0.8
"""Of the larger nets' probabilities beside the first one's, 0 to 1. With two of them and altered hands of sources that
were held out, 0.7 reads four in a hundred less, and 0.9 takes a tenth more wrong ones and shapes for a token."""


class CnnClassifier:
    """Patches -> probabilities of classes."""

    def __init__(self, model: CnnModel, backend: Backend = "auto") -> None:
        """backend: "litert", "numpy", or "auto" for the first that is installed. Raises NetworkError."""
        self.model, self.classes = model, model.classes
        self._network = Network(model.network, backend)
        larger = () if model.second is None else model.second.nets
        self._larger = [Network(net.network, backend) for net in larger]

    def scores(self, patches: NDArray[np.uint8]) -> Float:
        """Scores of patches, uint8 (n, size, size, 3), BGR -> float32 (n, k)."""
        model, network = self.model, self._network
        inputs = {PATCH: patch_levels(patches, model.network.quantisation[PATCH])}
        if model.contour is not None:
            numbers = (contour_vectors(patches, model.contour) - model.contour_mean) / model.contour_deviation
            inputs[CONTOUR] = network.table(CONTOUR, numbers)[:, None, None, :]
        return network.run(inputs)[SCORES].reshape(len(patches), len(model.classes))

    def second_scores(self, patches: NDArray[np.uint8]) -> list[Float]:
        """Scores of each of the larger nets: the same shapes."""
        shape = len(patches), len(self.model.classes)
        return [
            network.run({PATCH: patch_levels(patches, network.quantisation(PATCH))})[SCORES].reshape(shape)
            for network in self._larger
        ]

    def second_probabilities(self, patches: NDArray[np.uint8]) -> Float:
        """The mean of the larger nets' probabilities, of which the model must have one: the same shapes."""
        if self.model.second is None:
            raise ValueError("the model has no larger net for a second look")
        own = zip(self.second_scores(patches), self.model.second.nets, strict=True)
        return np.asarray(
            np.mean([softmax(scores, net.temperature) for scores, net in own], axis=0), np.float32
        )

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
                own = self.second_probabilities(patches[doubted])
                probabilities[doubted] = weighed(probabilities[doubted], own)
        return none_where_small(probabilities, model.classes, boxes, model.smallest_hand)


def most_doubted(probabilities: Float, sure: float) -> NDArray[np.intp]:
    """Rows of probabilities (n, k) that are worth a second look, the most doubtful first, `MOST_DOUBTED` at most."""
    clearness = probabilities.max(axis=1)
    order = np.argsort(clearness, kind="stable")[:MOST_DOUBTED]
    return np.asarray(order[clearness[order] < sure], np.intp)


def weighed(first: Float, second: Float) -> Float:
    """Probabilities of the first net and of the larger ones together, (n, k)."""
    return np.asarray(first + np.float32(SECOND_WEIGHT) * (second - first), np.float32)
