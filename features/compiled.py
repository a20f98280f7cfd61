"""The loops of the classical way compiled by numba, where the extra `fast` is installed; nothing needs them.

They are compiled when they are first asked for, once, and kept in the user's cache folder. Where numba is not there, is
of a version that does not serve, or has no folder to keep them in, the plain loops do the same and give the same
answers; of all but the first of these one line is told through `logging`.
"""

import logging
import os
import tempfile
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.cells import CellLoops
from lightgesture.features.find.classical import Loops
from lightgesture.features.find.trees import FlatTrees
from lightgesture.features.skin_map import SkinLoops

SWITCHED_OFF: Final = "LIGHTGESTURE_PLAIN"
"""Environment variable: any text in it keeps numba out."""
SIGNATURES: Final = {
    "red": "u2[:,::1](u1[:,:,::1], i8)",
    "redness": "u2[:,::1](u1[:,:,::1], u2[:,::1], i8, f4[::1], f4[::1], f4[::1])",
    "counts": "i8[::1](u2[:,::1], i8, i8, i8)",
    "look_up": "u1[:,::1](u2[:,::1], i8, i8, u1[::1])",
    "sums": "i4[:,:,::1](u1[:,::1], u1[:,::1], i2[:,::1], i2[:,::1])",
    "cells": "f4[:,::1](i4[:,:,::1], i4[:,::1])",
    "distinct": "i8[::1](i4[:,::1], i8)",
    "walk": "i8[::1](i8[::1], i8[::1], f4[::1], i8[::1], i4[::1], i8, f4[:,::1])",
}
"""Types of what each loop of `find/kernels.py` gives and takes, in numba's notation, so that none is compiled in the
middle of a stream."""


@lru_cache(maxsize=1)
def best_loops() -> Loops:
    """Compiled loops where they can be had, else the plain ones. The first call may take seconds."""
    if os.environ.get(SWITCHED_OFF):
        return Loops()
    try:
        import numba
    except ModuleNotFoundError:
        return Loops()
    except Exception as error:
        return _plain(f"numba cannot be loaded ({_line(error)})")
    folder = cache_folder()
    try:
        return compiled_loops(numba, folder)
    except OSError as error:
        return _plain(
            f"{folder}: cannot be written ({error.strerror}), where numba would keep what it compiles"
        )
    except Exception as error:
        # Numba raises what it likes where a version, a processor or a kept file does not suit it.
        return _plain(f"numba {getattr(numba, '__version__', '')} does not serve ({_line(error)})")


def _plain(reason: str) -> Loops:
    logging.getLogger("lightgesture").warning("%s; slower loops with the same answers are used", reason)
    return Loops()


def _line(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]


def cache_folder() -> Path:
    """`lightgesture/numba` under the user's cache directory (XDG Base Directory Specification)."""
    named = os.environ.get("XDG_CACHE_HOME", "")
    # The specification wants relative paths ignored.
    root = Path(named) if os.path.isabs(named) else Path.home() / ".cache"
    return root / "lightgesture" / "numba"


def compiled_loops(numba: ModuleType, folder: Path) -> Loops:
    """Every loop, compiled now or taken from `folder`; numba's own NUMBA_CACHE_DIR goes before it.

    Raises OSError where the folder cannot be written: without it a program would compile at every start. Raises
    whatever numba does.
    """
    from lightgesture.features.find import kernels

    if numba.config.DISABLE_JIT:
        raise RuntimeError("NUMBA_DISABLE_JIT is set")
    kept = numba.config.CACHE_DIR
    if not kept:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    numba.config.CACHE_DIR = kept or str(folder)
    try:
        found = {
            name: numba.njit(types, cache=True, error_model="numpy")(getattr(kernels, name))
            for name, types in SIGNATURES.items()
        }
    finally:
        numba.config.CACHE_DIR = kept
    return _joined(found)


def _joined(found: dict[str, Callable[..., Any]]) -> Loops:
    walk = found["walk"]

    def walk_trees(trees: FlatTrees, rows: NDArray[np.float32]) -> NDArray[np.int64]:
        total: NDArray[np.int64] = walk(
            trees.roots, trees.feature, trees.threshold, trees.children, trees.leaf, trees.depth, rows
        )
        return total

    skin = SkinLoops(
        _of_writeable(found["red"]), _of_writeable(found["redness"]), found["counts"], found["look_up"]
    )
    return Loops(skin, CellLoops(_of_writeable(found["sums"]), found["cells"]), found["distinct"], walk_trees)


def _of_writeable(loop: Callable[..., Any]) -> Callable[..., Any]:
    """The loop, also for pictures that a camera or a profile gives as read-only or as a view, for which nothing was
    compiled."""

    def called(*arrays: Any) -> Any:
        return loop(*(_own(one) if isinstance(one, np.ndarray) else one for one in arrays))

    return called


def _own(array: NDArray[Any]) -> NDArray[Any]:
    flags = array.flags
    return array if flags.c_contiguous and flags.writeable else array.copy()
