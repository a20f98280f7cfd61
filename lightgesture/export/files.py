"""A folder of flat files: raw arrays, JSON, and a manifest that says where each array is; there whole or not at all."""

import hashlib
import json
import os
import shutil
import uuid
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture._version import __version__
from lightgesture.errors import UsageError
from lightgesture.features.files import read_whole

FORMAT: Final = 1
"""Version of the layout; raised whenever an older reader would misread a newer folder."""
MADE_BY: Final = "lightgesture export"
MANIFEST: Final = "manifest.json"
LARGEST_MANIFEST: Final = 1 << 20
"""Bytes of the list of files that is read back."""
ALIGNMENT: Final = 16
"""Arrays begin at multiples of so many bytes, so that a port can map a file and use it as it lies."""


class FlatFiles:
    """Collects the files of one export in memory."""

    def __init__(self) -> None:
        self._binaries: dict[str, bytearray] = {}
        self._arrays: dict[str, dict[str, Any]] = {}
        self._files: dict[str, bytes] = {}

    def add_array(self, file: str, name: str, array: NDArray[Any]) -> str:
        """Append an array to the file `file`.bin, little-endian, last axis fastest; its name, `file`/`name`."""
        own = np.asarray(array, order="C")
        content = own.astype(own.dtype.newbyteorder("<")).tobytes()
        binary = self._binaries.setdefault(f"{file}.bin", bytearray())
        binary.extend(bytes(-len(binary) % ALIGNMENT))
        full = f"{file}/{name}"
        self._arrays[full] = {
            "file": f"{file}.bin",
            "dtype": own.dtype.name,
            "shape": list(own.shape),
            "offset": len(binary),
            "bytes": len(content),
            "sha256": hashlib.sha256(content).hexdigest(),
        }
        binary.extend(content)
        return full

    def add_json(self, name: str, content: Mapping[str, Any]) -> None:
        """Add a JSON file."""
        self.add_file(name, (json.dumps(content, indent=1, allow_nan=False) + "\n").encode())

    def add_file(self, name: str, content: bytes) -> None:
        """Add a file as it is."""
        self._files[name] = content

    def all_files(self) -> dict[str, bytes]:
        """Every file by its name, the manifest last."""
        files = {**self._files, **{name: bytes(binary) for name, binary in self._binaries.items()}}
        manifest = {
            "made_by": MADE_BY,
            "format": FORMAT,
            "version": __version__,
            "byte_order": "little",
            "files": {
                name: {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
                for name, content in sorted(files.items())
            },
            "arrays": self._arrays,
        }
        return {**files, MANIFEST: (json.dumps(manifest, indent=1) + "\n").encode()}


def check_folder(folder: Path) -> None:
    """Refuse a folder that holds anything that no export wrote, before the work. Raises UsageError."""
    try:
        found = sorted(entry.name for entry in folder.iterdir())
    except FileNotFoundError:
        return
    except OSError as error:
        raise UsageError(
            f"{folder}: is no folder that can be read ({error.strerror}); name another"
        ) from error
    foreign = [name for name in found if name not in _known(folder)]
    if foreign:
        raise UsageError(
            f"{folder}: holds {foreign[0]}, which no export wrote; name a new or an empty folder"
        )


def write_folder(folder: Path, files: Mapping[str, bytes]) -> None:
    """Write all files to a folder beside `folder` and rename it, an older export going away.

    Raises UsageError where `folder` cannot be written or holds other files.
    """
    check_folder(folder)
    target = folder.resolve()
    token = uuid.uuid4().hex
    new, old = target.with_name(f".{token}.part"), target.with_name(f".{token}.old")
    try:
        new.mkdir(parents=True)
        for name, content in files.items():
            (new / name).write_bytes(content)
        try:
            if target.exists():
                os.rename(target, old)
            os.rename(new, target)
        except BaseException:  # an interruption between the two as well
            if old.exists() and not target.exists():
                os.rename(old, target)
            raise
    except OSError as error:
        raise UsageError(f"{folder}: cannot be written ({error.strerror}); name another folder") from error
    finally:
        for left in (new, old):
            shutil.rmtree(left, ignore_errors=True)


def _known(folder: Path) -> set[str]:
    """Names of the files that the export in this folder wrote; none where it holds no export."""
    try:
        manifest = json.loads(read_whole(folder / MANIFEST, LARGEST_MANIFEST))
        return {MANIFEST, *manifest["files"]} if manifest["made_by"] == MADE_BY else set()
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return set()
