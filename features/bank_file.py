"""The contour bank's data file: plain arrays, the same bytes for the same bank."""

import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture.features.bank import Bank
from lightgesture.features.descriptors import DescriptorSettings

VERSION = 1

BUNDLED = Path(__file__).parent / "data" / "bank.npz"

LARGEST_FILE = 4 * 1024 * 1024
"""Bytes; a file beyond this is refused unread."""

MOST_NUMBERS = 1 << 20
"""Numbers in the centres; a file that unpacks to more is refused before it is read."""

REMEDY = "make it again with: lightgesture train regions"


class BankError(ValueError):
    """A bank file that cannot be used: one line with the file, the reason and the remedy."""


def save_bank(path: Path, bank: Bank) -> None:
    """Write the file under a temporary name, then rename it. Raises OSError."""
    temporary = path.with_name(path.name + ".part")
    with temporary.open("wb") as stream:
        np.savez_compressed(
            stream,
            version=np.int32(VERSION),
            classes=np.array(bank.classes, np.str_),
            centres=bank.centres.astype(np.float32),
            owner=bank.owner.astype(np.int16),
            points=np.int32(bank.settings.points),
            harmonics=np.int32(bank.settings.harmonics),
        )
    os.replace(temporary, path)


def load_bank(path: str | os.PathLike[str] | None = None) -> Bank:
    """Read a bank; without a path, the bundled one. Raises BankError."""
    file = Path(path) if path is not None else BUNDLED
    try:
        if file.stat().st_size > LARGEST_FILE:
            raise BankError(f"{file}: larger than {LARGEST_FILE} bytes, so it is no bank; {REMEDY}")
        return _read(file)
    except BankError:
        raise
    except OSError as error:
        raise BankError(f"{file}: cannot be read ({error.strerror}); {REMEDY}") from None
    except (KeyError, ValueError, TypeError, EOFError, zipfile.BadZipFile) as error:
        reason = " ".join(str(error).split())
        raise BankError(f"{file}: no valid bank ({reason}); {REMEDY}") from None


def _read(file: Path) -> Bank:
    with zipfile.ZipFile(file) as archive:
        if sum(member.file_size for member in archive.infolist()) > 4 * MOST_NUMBERS + LARGEST_FILE:
            raise ValueError(f"it unpacks to more than {MOST_NUMBERS} numbers")
    with np.load(file, allow_pickle=False) as stored:
        arrays: dict[str, Any] = {name: stored[name] for name in stored.files}
    if int(arrays["version"]) != VERSION:
        raise ValueError(f"version {int(arrays['version'])}, expected {VERSION}")
    settings = DescriptorSettings(int(arrays["points"]), int(arrays["harmonics"]))
    return Bank(
        classes=tuple(str(name) for name in arrays["classes"]),
        centres=arrays["centres"].astype(np.float32),
        owner=arrays["owner"].astype(np.int16),
        settings=settings,
    )
