"""The model file: arrays and one JSON text in an `.npz`, never a pickle.

Projection and expansion vectors are stored as float16, which halves the file and moves scores by less than 0.01.
"""

import io
import json
import os
import zipfile
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.contours import ContourSettings
from lightgesture.features.hog import HogSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.vector import VectorSettings, block_lengths
from lightgesture.models.errors import ModelError

Float = NDArray[np.float32]
Settings = TypeVar("Settings")

FORMAT: Final = 1
"""Version of the file; raised whenever an older reader would misread a newer file."""

LARGEST_FILE: Final = 64 * 2**20
"""Bytes, packed or unpacked, beyond which a file is not opened: no model of ours comes near."""

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


def write_model(model: SvmModel, path: Path) -> None:
    """Write a model file under a temporary name, then rename it; raises ModelError if it cannot be written."""
    header = {
        "format": FORMAT,
        "kind": "svm",
        "classes": list(model.classes),
        "features": asdict(model.features),
        "gamma": model.gamma,
        "temperature": model.temperature,
        "smallest_hand": model.smallest_hand,
    }
    arrays = {name: getattr(model, name).astype(kind) for name, kind in ARRAYS.items()}
    content = io.BytesIO()
    np.savez_compressed(content, header=np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays)
    write_file(path, content.getvalue())


def write_file(path: Path, content: bytes) -> None:
    """Write a whole file or none; raises ModelError naming it."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        temporary.write_bytes(content)
        temporary.replace(path)
    except OSError as error:
        raise ModelError(
            f"{path}: cannot be written ({error.strerror}); give another path with --out"
        ) from error
    finally:
        temporary.unlink(missing_ok=True)


def read_model(path: Path) -> SvmModel:
    """Read a model file; raises ModelError naming the file, what is wrong with it and what to do."""
    header, arrays = _read_parts(path)
    if not isinstance(header, dict) or header.get("kind") != "svm":
        raise ModelError(f"{path}: is no svm model; train one with: lightgesture train svm")
    if header.get("format") != FORMAT:
        raise ModelError(
            f"{path}: has format {header.get('format')!r}, this version reads {FORMAT}; train it again"
        )
    try:
        model = _build(header, arrays)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: is damaged ({error}); restore it or train it again") from error
    _check(path, model)
    return model


def _read_parts(path: Path) -> tuple[Any, dict[str, NDArray[Any]]]:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ModelError(f"{path}: is larger than {LARGEST_FILE >> 20} MiB; this is no svm model")
        content = io.BytesIO(path.read_bytes())
        with zipfile.ZipFile(content) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > LARGEST_FILE:
                raise ModelError(
                    f"{path}: unpacks to more than {LARGEST_FILE >> 20} MiB; this is no svm model"
                )
        with np.load(content, allow_pickle=False) as file:
            arrays = {name: file[name] for name in ("header", *ARRAYS)}
        return json.loads(arrays.pop("header").tobytes()), arrays
    except OSError as error:
        raise ModelError(
            f"{path}: cannot be read ({error.strerror or error}); give a model file or svm"
        ) from error
    except (KeyError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise ModelError(
            f"{path}: is cut off or no model file ({error}); restore it or train it again"
        ) from error


def _build(header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> SvmModel:
    features = header["features"]
    names = [field.name for field in fields(VectorSettings)]
    if not isinstance(features, dict) or sorted(features) != sorted(names):
        raise ValueError(f"features must be {', '.join(names)}")
    return SvmModel(
        classes=tuple(str(name) for name in header["classes"]),
        features=VectorSettings(
            patch=_settings(PatchSettings, features["patch"]),
            hog=_settings(HogSettings, features["hog"]),
            contour=_settings(ContourSettings, features["contour"]),
        ),
        gamma=_positive(header, "gamma"),
        temperature=_positive(header, "temperature"),
        smallest_hand=int(header["smallest_hand"]),
        **{name: np.asarray(array, np.float32) for name, array in arrays.items()},
    )


def _settings(kind: type[Settings], values: dict[str, Any]) -> Settings:
    """Settings from JSON: every field, no other, each of its default's type."""
    default = kind()
    expected = {field.name: getattr(default, field.name) for field in fields(default)}  # type: ignore[arg-type]
    if sorted(values) != sorted(expected):
        raise ValueError(f"{kind.__name__} must be {', '.join(expected)}")
    wrong = [name for name, value in values.items() if type(value) is not type(expected[name])]
    if wrong:
        raise ValueError(f"{kind.__name__}.{wrong[0]} is {values[wrong[0]]!r}")
    return kind(**values)


def _positive(header: dict[str, Any], name: str) -> float:
    value = float(header[name])
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name} is {value}, not above 0")
    return value


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
