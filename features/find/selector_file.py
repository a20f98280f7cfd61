"""The selector's data file: nets and trees of the learned choice and trees of the classical one, as plain arrays."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.archive import ArchiveError, check_format, read_archive
from lightgesture.features.find.bank import Bank, bank_from
from lightgesture.features.find.candidates import PAIR_COLUMNS, PLACE_COLUMNS
from lightgesture.features.find.trees import Trees
from lightgesture.features.net.file import LAYOUT, network_from
from lightgesture.features.net.network import IntegerNetwork

KIND: Final = "selector"
FORMAT: Final = 5
"""Version of the file; raised whenever an older reader would misread a newer file."""
UNVERIFIED: Final = 4
"""Version without a verifier, which is read as it is."""
OLDER: Final = 3
"""Version whose locator saw pictures of half the size: its nets can learn on and nothing else; the classical choice is
as here."""
BUNDLED: Final = Path(__file__).resolve().parents[1] / "data" / "selector.npz"
BANK_NUMBERS: Final = 2
"""Numbers of a region that come from the bank of outlines."""
TREE_ARRAYS: Final = ("feature", "threshold", "left", "right", "value")
TREE_NUMBERS: Final = ("base", "depth")
"""What is stored of trees, each under the name of the part and this one."""
LOCATOR, REFINER, VERIFIER = "locator", "refiner", "verifier"
"""Beginnings of the names of each net's arrays."""
CLASSICAL_PARTS, LEARNED_PARTS = (
    ("glance", "extents", "extent_pairs", "bank"),
    ("places", "place_pairs", LOCATOR, REFINER, VERIFIER),
)
"""Beginnings of the names of what either choice needs; the rest stays packed."""
REMEDY: Final = "make it again with: lightgesture train regions"

Parts = TypeVar("Parts")


class SelectorError(ValueError):
    """A selector file that cannot be used: one line with the file, the reason and the remedy."""


@dataclass(frozen=True, slots=True, eq=False)
class ClassicalParts:
    """glance: predicts the IoU that a region has with a hand, with or without its forearm, by its cells alone. regions:
    the IoU of a region that stood out. pairs: of a pair, the lower of both. bank: outlines of hands."""

    glance: Trees
    regions: Trees
    pairs: Trees
    bank: Bank


@dataclass(frozen=True, slots=True, eq=False)
class LearnedParts:
    """locator, refiner: the nets. places: predicts the IoU of a refined box with a hand. pairs: of a pair, the lower
    of both. verifier: asked about places that the trees doubt, None in a file of before."""

    locator: IntegerNetwork
    refiner: IntegerNetwork
    places: Trees
    pairs: Trees
    verifier: IntegerNetwork | None = None


def load_classical(path: str | os.PathLike[str] | None = None) -> ClassicalParts:
    """The classical choice of a file; without a path, of the bundled one. Raises SelectorError."""
    from lightgesture.features.find.cells import COLUMNS

    def read(arrays: Mapping[str, NDArray[Any]]) -> ClassicalParts:
        return ClassicalParts(
            trees_from(arrays, "glance", COLUMNS),
            trees_from(arrays, "extents", COLUMNS + BANK_NUMBERS),
            trees_from(arrays, "extent_pairs", PAIR_COLUMNS),
            bank_from(arrays, "bank"),
        )

    return _read(path, CLASSICAL_PARTS, read, UNVERIFIED, OLDER)


def load_learned(path: str | os.PathLike[str] | None = None) -> LearnedParts:
    """The learned choice of a file; without a path, of the bundled one. Raises SelectorError."""

    def read(arrays: Mapping[str, NDArray[Any]]) -> LearnedParts:
        return LearnedParts(
            network_from(arrays, LOCATOR),
            network_from(arrays, REFINER),
            trees_from(arrays, "places", PLACE_COLUMNS),
            trees_from(arrays, "place_pairs", PAIR_COLUMNS),
            network_from(arrays, VERIFIER) if f"{VERIFIER}_{LAYOUT}" in arrays else None,
        )

    return _read(path, LEARNED_PARTS, read, UNVERIFIED)


def load_nets(path: str | os.PathLike[str]) -> tuple[IntegerNetwork, IntegerNetwork]:
    """Locator and refiner of a file, to learn on from; one of before will do. Raises SelectorError."""

    def read(arrays: Mapping[str, NDArray[Any]]) -> tuple[IntegerNetwork, IntegerNetwork]:
        return network_from(arrays, LOCATOR), network_from(arrays, REFINER)

    return _read(path, (LOCATOR, REFINER), read, UNVERIFIED, OLDER)


def _read(
    path: str | os.PathLike[str] | None,
    parts: tuple[str, ...],
    read: Callable[[Mapping[str, NDArray[Any]]], Parts],
    *older: int,
) -> Parts:
    file = Path(path) if path is not None else BUNDLED
    try:
        header, arrays = read_archive(file, lambda name: name.startswith(parts))
        check_format(file, header, KIND, FORMAT, *older)
        return read(arrays)
    except ArchiveError as error:
        raise SelectorError(f"{error}; {REMEDY}") from None
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        reason = " ".join(str(error).split())
        raise SelectorError(f"{file}: no valid selector ({reason}); {REMEDY}") from None


def trees_from(arrays: Mapping[str, NDArray[Any]], part: str, columns: int) -> Trees:
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
