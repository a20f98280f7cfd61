"""The file of a support vector machine.

Projection and expansion vectors are stored as float16, which halves the file and moves scores by less than 0.01.
"""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.hog import HogSettings
from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.types import Float
from lightgesture.features.vector import VectorSettings, block_lengths
from lightgesture.models.archive import check_kind, positive, settings_from
from lightgesture.models.errors import ModelError

KIND: Final = "svm"
FORMAT: Final = 2
"""Version of the file; raised whenever an older reader would misread a newer file."""

ARRAYS: Final = {
    "mean": np.float32,
    "projection": np.float16,
    "centres": np.float16,
    "weights": np.float32,
    "bias": np.float32,
}
"""Arrays of the file and how they are stored."""


@dataclass(frozen=True, slots=True, eq=False)
class SvmModel:
    """All that the machine needs on the board; arrays float32.

    classes: k names. features: how a patch becomes a vector x. mean: (d,). projection: (d, p). centres: (m, p).
    weights: (m, k). bias: (k,). gamma: of the kernel, > 0. temperature: of the softmax, > 0.
    smallest_hand: longer side in pixels of the smallest box that is read; a smaller hand is `none`.
    """

    classes: tuple[str, ...]
    features: VectorSettings
    mean: Float
    projection: Float
    centres: Float
    weights: Float
    bias: Float
    gamma: float
    temperature: float
    smallest_hand: int


def svm_model_from(path: Path, header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> SvmModel:
    """The model of a file's content; raises ModelError naming the file."""
    check_kind(path, header, KIND, FORMAT)
    try:
        model = _build(header, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: is damaged ({error}); restore it or train it again") from error
    _check(path, model)
    return model


def _build(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> SvmModel:
    features = header["features"]
    names = [field.name for field in fields(VectorSettings)]
    if not isinstance(features, dict) or sorted(features) != sorted(names):
        raise ValueError(f"features must be {', '.join(names)}")
    return SvmModel(
        classes=tuple(str(name) for name in header["classes"]),
        features=VectorSettings(
            patch=settings_from(PatchSettings, features["patch"]),
            hog=settings_from(HogSettings, features["hog"]),
            contour=settings_from(ContourSettings, features["contour"]),
        ),
        gamma=positive(header, "gamma"),
        temperature=positive(header, "temperature"),
        smallest_hand=int(header["smallest_hand"]),
        **{name: np.asarray(arrays[name], np.float32) for name in ARRAYS},
    )


def _check(path: Path, model: SvmModel) -> None:
    """Refuse arrays whose shapes do not go together or that hold NaN or infinity."""
    try:
        length = sum(block_lengths(model.features))
    except ValueError as error:
        raise ModelError(f"{path}: {error}; train it again") from error
    width, count, classes = model.projection.shape[-1:], model.centres.shape[:1], (len(model.classes),)
    shapes = {
        "mean": (length,),
        "projection": (length, *width),
        "centres": (*count, *width),
        "weights": (*count, *classes),
        "bias": classes,
    }
    for name, shape in shapes.items():
        array: Float = getattr(model, name)
        if array.shape != shape:
            raise ModelError(f"{path}: {name} has shape {array.shape}, must be {shape}; train it again")
        if not np.isfinite(array).all():
            raise ModelError(f"{path}: {name} holds NaN or infinity; train it again")
