"""Choose a classifier by name or file."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box
from lightgesture.models.archive import read_model
from lightgesture.models.errors import ModelError

DATA: Final = Path(__file__).resolve().parent / "data"
SHIPPED: Final = {name: DATA / f"{name}.npz" for name in ("cnn", "svm")}
"""The models that come with the package; their cards lie beside them."""
DEFAULT: Final = "cnn"


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


def _cnn(path: Path, header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> Classifier:
    from lightgesture.features.net.network import NetworkError
    from lightgesture.models.cnn import CnnClassifier
    from lightgesture.models.cnn_file import cnn_model_from

    try:
        return CnnClassifier(cnn_model_from(path, header, arrays))
    except NetworkError as error:
        raise ModelError(f"{path}: {error}") from error


def _svm(path: Path, header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> Classifier:
    from lightgesture.models.svm import SvmClassifier
    from lightgesture.models.svm_file import svm_model_from

    return SvmClassifier(svm_model_from(path, header, arrays))


KINDS: Final = {"cnn": _cnn, "svm": _svm}
"""Kind of a model file to what makes a classifier of its content; each imports its own, for the net's run-time takes
longer to load than all of the other."""


def load_classifier(model: str | os.PathLike[str] = DEFAULT) -> Classifier:
    """The classifier called `model`, "cnn" or "svm", or read from the model file at that path.

    Raises ModelError if the file is missing, cut off, of another version or not a model.
    """
    path = SHIPPED.get(str(model), Path(model))
    header, arrays = read_model(path)
    # What is of no kind is refused by the checks of either.
    return KINDS.get(str(header.get("kind")), _svm)(path, header, arrays)
