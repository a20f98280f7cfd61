"""Choose a classifier by name or file."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box
from lightgesture.models.errors import ModelError
from lightgesture.models.svm import read_svm

SHIPPED_SVM: Final = Path(__file__).resolve().parent / "data" / "svm.npz"
"""The model that comes with the package; its card lies beside it."""


class Classifier(Protocol):
    """Names the token of hands in given boxes."""

    @property
    def classes(self) -> tuple[str, ...]:
        """Names of the columns of `probabilities`."""
        ...

    def probabilities(
        self, image_bgr: NDArray[np.uint8], boxes: Sequence[Box], sides: Sequence[str]
    ) -> NDArray[np.float32]:
        """Calibrated probabilities, float32 (n, classes), rows sum to 1.

        image_bgr: uint8 (height, width, 3) or (height, width). boxes: outlines x, y, width, height in its pixels.
        sides: "left" or "right", the diver's own. Raises ValueError for other pictures, boxes and sides.
        """
        ...


def load_classifier(model: str | os.PathLike[str] = "svm") -> Classifier:
    """The classifier called `model`, "svm" or "cnn", or read from the model file at that path.

    Raises ModelError if the file is missing, cut off, of another version or not a model.
    """
    if model == "cnn":
        raise ModelError("the cnn model is not built yet; use --model svm")
    if model == "svm":
        return read_svm(SHIPPED_SVM)
    return read_svm(Path(model))
