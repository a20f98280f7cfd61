"""The contour bank as plain arrays, to be kept among others in one `.npz`."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.bank import Bank
from lightgesture.features.find.descriptors import DescriptorSettings

MOST_CENTRES, LONGEST_DESCRIPTOR = 4096, 256
"""Limits of what a file may hold."""


def bank_arrays(prefix: str, bank: Bank) -> dict[str, NDArray[Any]]:
    """All that a bank holds, under names that begin with `prefix`."""
    return {
        f"{prefix}_classes": np.array(bank.classes, np.str_),
        f"{prefix}_centres": bank.centres.astype(np.float32),
        f"{prefix}_owner": bank.owner.astype(np.int16),
        f"{prefix}_points": np.array(bank.settings.points, np.int32),
        f"{prefix}_harmonics": np.array(bank.settings.harmonics, np.int32),
    }


def bank_from(arrays: Mapping[str, NDArray[Any]], prefix: str) -> Bank:
    """The bank that `bank_arrays` stored. Raises KeyError or ValueError."""
    centres = arrays[f"{prefix}_centres"]
    if centres.ndim != 2 or len(centres) > MOST_CENTRES or centres.shape[1] > LONGEST_DESCRIPTOR:
        raise ValueError(f"centres of shape {centres.shape} are no bank")
    settings = DescriptorSettings(int(arrays[f"{prefix}_points"]), int(arrays[f"{prefix}_harmonics"]))
    return Bank(
        classes=tuple(str(name) for name in arrays[f"{prefix}_classes"]),
        centres=centres.astype(np.float32),
        owner=arrays[f"{prefix}_owner"].astype(np.int16),
        settings=settings,
    )
