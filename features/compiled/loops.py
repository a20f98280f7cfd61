"""The loops of the classical way compiled by numba, where the extra `fast` is installed; nothing needs them.

They are compiled when they are first asked for, once, and kept in the user's cache folder. Where numba is not there, is
of a version that does not serve, or has no folder to keep them in, the plain loops do the same and give the same
answers; of all but the first of these one line is told through `logging`.
"""

import hashlib
import logging
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from lightgesture.features.compiled.stages import joined
from lightgesture.features.find.classical import Loops

SWITCHED_OFF: Final = "LIGHTGESTURE_PLAIN"
"""Environment variable: any text in it keeps numba out."""
NUMBERS_FROM: Final = (
    "find/candidates.py",
    "find/cells.py",
    "find/forearms.py",
    "find/proposals.py",
    "skin_map.py",
)
"""Modules whose numbers are compiled into the loops."""
SIGNATURES: Final = {
    "skin": {
        "red": "Tuple((u2[:,::1], i8, i8))(u1[:,:,::1], i8)",
        "redness": "Tuple((u2[:,::1], i8, i8))(u1[:,:,::1], u2[:,::1], i8, f8[::1])",
        "stretch": "u1[:,::1](u2[:,::1], i8, i8)",
    },
    "cells": {
        "sums": "void(u1[:,::1], u1[:,::1], i4[:,:,::1])",
        "cells": "f4[:,::1](i4[:,:,::1], i4[:,::1])",
        "distinct": "i8[::1](i4[:,::1], i8)",
        "walk": "i8[::1](u4[::1], u2[::1], f4[::1], u4[::1], i4[::1], i8, f4[:,::1])",
    },
    "runs": {},
    "regions": {
        "nodes": "i4[:,::1](u1[:,::1], u8[:,::1], i8, f8[::1], i8, i8, i8)",
        "largest_parts": "Tuple((i4[:,::1], i4[:,::1]))(u1[:,::1], i8[:,::1], i4[:,::1], b1[::1], i8)",
        "outlines": "Tuple((i4[:,::1], i8[::1]))(u1[:,::1], i4[:,::1])",
    },
    "pairs": {
        "ratios": "f8[:,::1](f8[:,::1], f8[:,::1], i8)",
        "pair_rows": "f4[:,::1](f8[:,::1], f8[:,::1], f8[:,::1], f8[:,::1], i8, i8)",
    },
    "outlines": {
        "shapes": "f4[:,::1](i4[:,::1], i8[::1], i8[::1], i4[:,::1], b1[::1], i8, i8)",
        "colours": "f8[:,::1](u1[:,:,::1], u1[:,::1], i8[:,::1], i4[:,::1])",
        "overlaps": "f8[:,::1](i4[:,::1])",
        "sampled": "Tuple((f4[:,::1], i8[::1]))(i4[:,::1], i8[::1], i8[::1], i8)",
        "turned": "f4[:,::1](f4[:,::1], i8[::1], f4[:,:,::1])",
        "masks": "Tuple((u1[:,::1], i8[:,::1]))(i4[:,::1], i8[::1], i8[::1], i4[:,::1])",
        "arms": "f8[:,::1](u1[:,::1], i8[:,::1], i4[:,::1], f4[:,::1], i4[:,::1])",
    },
}
"""Types of what each loop of the modules beside this one gives and takes, in numba's notation, so that none is compiled
in the middle of a stream."""


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
    if numba.config.DISABLE_JIT:
        raise RuntimeError("NUMBA_DISABLE_JIT is set")
    kept = numba.config.CACHE_DIR
    # Numba looks whether a loop's own file has changed, and not at what it takes from others.
    folder = folder / version_of_loops()
    if not kept:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    numba.config.CACHE_DIR = kept or str(folder)
    try:
        found = {
            name: loop
            for module, types in SIGNATURES.items()
            for name, loop in _compiled(numba, module, types)
        }
    finally:
        numba.config.CACHE_DIR = kept
    return joined(found)


def version_of_loops() -> str:
    """Tells one version of the loops and their numbers from another."""
    digest = hashlib.sha256()
    own = Path(__file__).parent
    for path in (*(own / f"{name}.py" for name in SIGNATURES), *(own.parent / name for name in NUMBERS_FROM)):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def _compiled(
    numba: ModuleType, name: str, signatures: Mapping[str, str]
) -> Iterator[tuple[str, Callable[..., Any]]]:
    """The loops of a module beside this one, by their names."""
    module = import_module(f"lightgesture.features.compiled.{name}")
    for helper in module.HELPERS:
        # A compiled loop calls what its module has under a name, which must be compiled too; Python can call it still.
        plain = getattr(getattr(module, helper), "py_func", getattr(module, helper))
        setattr(module, helper, numba.njit(error_model="numpy")(plain))
    for loop, types in signatures.items():
        yield loop, numba.njit(types, cache=True, error_model="numpy")(getattr(module, loop))
