"""The selector's data file: the trees that score regions and pairs, as plain arrays."""

import os
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.cells import CellSettings
from lightgesture.features.pairs import COLUMNS as PAIR_COLUMNS
from lightgesture.features.trees import Trees

VERSION = 1
LARGEST_FILE = 8 * 1024 * 1024
"""Bytes; a file beyond this is refused unread."""

BUNDLED = Path(__file__).parent / "data" / "selector.npz"

_ARRAYS = ("feature", "threshold", "left", "right", "value")
_SCALARS = ("base", "depth")


class SelectorError(ValueError):
    """A selector file that cannot be used: one line with the file, the reason and the remedy."""


@dataclass(frozen=True, slots=True, eq=False)
class Selector:
    """regions: predicts the IoU of a region with a hand. pairs: of a pair, the lower of both."""

    regions: Trees
    pairs: Trees


def save_selector(path: Path, selector: Selector) -> None:
    """Write the file under a temporary name, then rename it."""
    arrays: dict[str, Any] = {"version": np.int32(VERSION)}
    for part, trees in (("regions", selector.regions), ("pairs", selector.pairs)):
        for name in (*_ARRAYS, *_SCALARS):
            arrays[f"{part}_{name}"] = np.asarray(getattr(trees, name))
    temporary = path.with_name(path.name + ".part")
    with temporary.open("wb") as stream:
        np.savez_compressed(stream, **arrays)
    os.replace(temporary, path)


def _trees(arrays: dict[str, NDArray[Any]], part: str, columns: int) -> Trees:
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


def load_selector(path: str | os.PathLike[str] | None = None) -> Selector:
    """Read a selector; without a path, the bundled one. Raises SelectorError."""
    file = Path(path) if path is not None else BUNDLED
    remedy = "make it again with: lightgesture train regions"
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise SelectorError(f"{file}: larger than {LARGEST_FILE} bytes, so it is no selector; {remedy}")
        with np.load(file, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
        if int(arrays["version"]) != VERSION:
            raise SelectorError(f"{file}: version {int(arrays['version'])}, expected {VERSION}; {remedy}")
        cells = 7 * CellSettings().cells ** 2 + 9
        return Selector(_trees(arrays, "regions", cells), _trees(arrays, "pairs", PAIR_COLUMNS))
    except SelectorError:
        raise
    except OSError as error:
        raise SelectorError(f"{file}: cannot be read ({error.strerror}); {remedy}") from None
    except (KeyError, ValueError, TypeError, EOFError, zipfile.BadZipFile) as error:
        raise SelectorError(f"{file}: no valid selector ({error}); {remedy}") from None
