"""What two selector files have in common. A part that equals the shipped one was not trained without anything."""

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.selector import SelectorName
from lightgesture.features.find.selector_file import load_classical, load_learned
from lightgesture.features.net.network import IntegerNetwork

File = str | os.PathLike[str] | None
"""Path of a selector file; None for the bundled one."""


def shared_parts(selector: SelectorName, first: File, second: File = None) -> tuple[str, ...]:
    """Names of the trained parts of one choice that are the same in both files. Raises SelectorError."""
    parts, others = _parts(selector, first), _parts(selector, second)
    return tuple(name for name, part in parts.items() if np.array_equal(part, others[name]))


def _parts(selector: SelectorName, file: File) -> Mapping[str, NDArray[Any]]:
    """What training decides of each part: values of leaves, centres of the bank, weights of a net."""
    if selector == "classical":
        classical = load_classical(file)
        return {
            "trees": classical.regions.value,
            "trees of pairs": classical.pairs.value,
            "bank": classical.bank.centres,
        }
    learned = load_learned(file)
    return {
        "locator": _weights(learned.locator),
        "refiner": _weights(learned.refiner),
        "trees": learned.places.value,
        "trees of pairs": learned.pairs.value,
    }


def _weights(network: IntegerNetwork) -> NDArray[np.int8]:
    return np.concatenate([own.weights.ravel() for own in network.weights.values()])
