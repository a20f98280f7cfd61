"""The container of every model file: arrays and one JSON text in an `.npz`, never a pickle, sizes bounded."""

import io
import json
import os
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from lightgesture.models.errors import ModelError

Settings = TypeVar("Settings")

LARGEST_FILE: Final = 64 * 2**20
"""Bytes, packed or unpacked, beyond which a file is not opened: no model of ours comes near."""

HEADER: Final = "header"
"""Name of the array that holds the JSON text."""


def write_archive(path: Path, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write a model file under a temporary name, then rename it; raises ModelError if it cannot be written."""
    content = io.BytesIO()
    text = np.frombuffer(json.dumps(header).encode(), np.uint8)
    every: dict[str, Any] = {HEADER: text, **arrays}
    np.savez_compressed(content, **every)
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


def read_archive(path: Path) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of a model file; raises ModelError naming the file, what is wrong with it and what to do."""
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ModelError(f"{path}: is larger than {LARGEST_FILE >> 20} MiB; this is no model")
        content = io.BytesIO(path.read_bytes())
        with zipfile.ZipFile(content) as archive:
            if sum(entry.file_size for entry in archive.infolist()) > LARGEST_FILE:
                raise ModelError(f"{path}: unpacks to more than {LARGEST_FILE >> 20} MiB; this is no model")
        with np.load(content, allow_pickle=False) as file:
            arrays = dict(file)
        header = json.loads(arrays.pop(HEADER).tobytes())
    except OSError as error:
        raise ModelError(
            f"{path}: cannot be read ({error.strerror or error}); give a model file, cnn or svm"
        ) from error
    except (KeyError, ValueError, EOFError, RecursionError, zlib.error, zipfile.BadZipFile) as error:
        raise ModelError(
            f"{path}: is cut off or no model file ({error}); restore it or train it again"
        ) from error
    if not isinstance(header, dict):
        raise ModelError(f"{path}: is no model file; train one with: lightgesture train")
    return header, arrays


def check_kind(path: Path, header: Mapping[str, Any], kind: str, version: int) -> None:
    """Refuse the file of another kind or version with a ModelError."""
    if header.get("kind") != kind:
        raise ModelError(f"{path}: is no {kind} model; train one with: lightgesture train {kind}")
    if header.get("format") != version:
        raise ModelError(
            f"{path}: has format {header.get('format')!r}, this version reads {version}; train it again"
        )


def settings_from(kind: type[Settings], values: Any) -> Settings:
    """Settings from JSON: every field, no other, each of its default's type. Raises ValueError."""
    default = kind()
    expected = {field.name: getattr(default, field.name) for field in fields(default)}  # type: ignore[arg-type]
    if not isinstance(values, dict) or sorted(values) != sorted(expected):
        raise ValueError(f"{kind.__name__} must be {', '.join(expected)}")
    wrong = [name for name, value in values.items() if type(value) is not type(expected[name])]
    if wrong:
        raise ValueError(f"{kind.__name__}.{wrong[0]} is {values[wrong[0]]!r}")
    return kind(**values)


def positive(header: Mapping[str, Any], name: str) -> float:
    """A finite number above 0. Raises ValueError."""
    value = float(header[name])
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name} is {value}, not above 0")
    return value
