"""What every model file has in common: how it is read, and the checks of its header."""

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from numpy.typing import NDArray

from lightgesture.features.archive import ArchiveError, check_format, read_archive
from lightgesture.models.errors import ModelError

Settings = TypeVar("Settings")


def read_model(path: Path) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Header and arrays of a model file; raises ModelError naming the file, what is wrong with it and what to do."""
    try:
        return read_archive(path)
    except ArchiveError as error:
        remedy = "give a model file, cnn or svm" if error.is_missing else "restore it or train it again"
        raise ModelError(f"{error}; {remedy}") from error


def check_kind(path: Path, header: Mapping[str, Any], kind: str, version: int, *older: int) -> None:
    """Refuse the file of another kind, or of a version that is neither this one nor an older one that will do, with a
    ModelError."""
    try:
        check_format(path, header, kind, version, *older)
    except ArchiveError as error:
        raise ModelError(f"{error}; train it again with: lightgesture train {kind}") from error


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
