"""The selector's data file: nets and trees of the learned choice and trees of the classical one, as plain arrays."""

import os
import zipfile
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find import cells
from lightgesture.features.find.bank import Bank, bank_arrays, bank_from
from lightgesture.features.find.candidates import PAIR_COLUMNS, PLACE_COLUMNS
from lightgesture.features.find.trees import Trees
from lightgesture.features.net.file import network_arrays, network_from
from lightgesture.features.net.network import IntegerNetwork, NetworkError

VERSION = 2
LARGEST_FILE = 8 * 1024 * 1024
"""Bytes; a file beyond this is refused unread."""
LARGEST_UNPACKED = 64 * 1024 * 1024
BUNDLED = Path(__file__).resolve().parents[1] / "data" / "selector.npz"
BANK_NUMBERS = 2
"""Numbers of a region that come from the bank of outlines."""
REMEDY = "make it again with: lightgesture train regions"

Parts = TypeVar("Parts")

_DAMAGES = (
    NetworkError,
    KeyError,
    ValueError,
    TypeError,
    EOFError,
    MemoryError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What a file that was cut, altered or made by somebody else may cause."""

_ARRAYS = ("feature", "threshold", "left", "right", "value")
_SCALARS = ("base", "depth")


class SelectorError(ValueError):
    """A selector file that cannot be used: one line with the file, the reason and the remedy."""


@dataclass(frozen=True, slots=True, eq=False)
class ClassicalParts:
    """regions: predicts the IoU of a region with a hand. pairs: of a pair, the lower of both. bank: outlines of
    hands."""

    regions: Trees
    pairs: Trees
    bank: Bank


@dataclass(frozen=True, slots=True, eq=False)
class LearnedParts:
    """locator, refiner: the nets. places: predicts the IoU of a refined box with a hand. pairs: of a pair, the lower
    of both."""

    locator: IntegerNetwork
    refiner: IntegerNetwork
    places: Trees
    pairs: Trees


@dataclass(frozen=True, slots=True, eq=False)
class Selector:
    """What is needed for either choice."""

    classical: ClassicalParts
    learned: LearnedParts


def save_selector(path: Path, selector: Selector) -> None:
    """Write the file under a temporary name, then rename it."""
    learned, classical = selector.learned, selector.classical
    arrays: dict[str, NDArray[Any]] = {
        "version": np.array(VERSION, np.int32),
        **_tree_arrays("regions", classical.regions),
        **_tree_arrays("region_pairs", classical.pairs),
        **bank_arrays("bank", classical.bank),
        **_tree_arrays("places", learned.places),
        **_tree_arrays("place_pairs", learned.pairs),
        **network_arrays("locator", learned.locator),
        **network_arrays("refiner", learned.refiner),
    }
    temporary = path.with_name(path.name + ".part")
    with temporary.open("wb") as stream:
        np.savez_compressed(stream, **arrays)  # type: ignore[arg-type]
    os.replace(temporary, path)


def load_classical(path: str | os.PathLike[str] | None = None) -> ClassicalParts:
    """The classical choice of a file; without a path, of the bundled one. Raises SelectorError."""

    def read(arrays: Mapping[str, NDArray[Any]]) -> ClassicalParts:
        return ClassicalParts(
            _trees(arrays, "regions", cells.COLUMNS + BANK_NUMBERS),
            _trees(arrays, "region_pairs", PAIR_COLUMNS),
            bank_from(arrays, "bank"),
        )

    return _read(path, read)


def load_learned(path: str | os.PathLike[str] | None = None) -> LearnedParts:
    """The learned choice of a file; without a path, of the bundled one. Raises SelectorError."""

    def read(arrays: Mapping[str, NDArray[Any]]) -> LearnedParts:
        return LearnedParts(
            network_from(arrays, "locator"),
            network_from(arrays, "refiner"),
            _trees(arrays, "places", PLACE_COLUMNS),
            _trees(arrays, "place_pairs", PAIR_COLUMNS),
        )

    return _read(path, read)


def _read(path: str | os.PathLike[str] | None, read: Callable[[Mapping[str, NDArray[Any]]], Parts]) -> Parts:
    file = Path(path) if path is not None else BUNDLED
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise SelectorError(f"{file}: larger than {LARGEST_FILE} bytes, so it is no selector; {REMEDY}")
        _check_unpacked_size(file)
        with np.load(file, allow_pickle=False) as stored:
            if int(stored["version"]) != VERSION:
                raise SelectorError(f"{file}: version {int(stored['version'])}, expected {VERSION}; {REMEDY}")
            return read(stored)
    except SelectorError:
        raise
    except OSError as error:
        raise SelectorError(f"{file}: cannot be read ({error.strerror}); {REMEDY}") from None
    except _DAMAGES as error:
        raise SelectorError(f"{file}: no valid selector ({error}); {REMEDY}") from None


def _check_unpacked_size(file: Path) -> None:
    """Refuse an archive that would unpack to far more than it is. Raises ValueError."""
    with zipfile.ZipFile(file) as archive:
        if sum(member.file_size for member in archive.infolist()) > LARGEST_UNPACKED:
            raise ValueError(f"it unpacks to more than {LARGEST_UNPACKED} bytes")


def _tree_arrays(part: str, trees: Trees) -> dict[str, NDArray[Any]]:
    return {f"{part}_{name}": np.asarray(getattr(trees, name)) for name in (*_ARRAYS, *_SCALARS)}


def _trees(arrays: Mapping[str, NDArray[Any]], part: str, columns: int) -> Trees:
    trees = Trees(
        feature=arrays[f"{part}_feature"].astype(np.int16),
        threshold=arrays[f"{part}_threshold"].astype(np.float32),
        left=arrays[f"{part}_left"].astype(np.int16),
        right=arrays[f"{part}_right"].astype(np.int16),
        value=arrays[f"{part}_value"].astype(np.float32),
        base=float(arrays[f"{part}_base"]),
        depth=int(arrays[f"{part}_depth"]),
    )
    trees.check(columns)
    return trees
