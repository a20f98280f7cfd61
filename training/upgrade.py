"""Rewrites a hand net of format 1 or a selector of version 2 in today's format, with the same numbers.

`python -m lightgesture.training.upgrade OLD NEW`. They had every array of a net as a member of its own, and no
`.tflite`. Nothing is trained again.
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find import cells, choice, pairs
from lightgesture.features.find.bank_file import bank_from
from lightgesture.features.find.selector_file import (
    BANK_NUMBERS,
    ClassicalParts,
    LearnedParts,
    Selector,
    trees_from,
)
from lightgesture.features.net.file import check_network
from lightgesture.features.net.network import IntegerNetwork, Node, Quantisation, Weights
from lightgesture.features.outline.contours import ContourSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.models.cnn import CnnModel
from lightgesture.training.model_files import write_cnn_model, write_selector

Arrays = Mapping[str, NDArray[Any]]


def upgrade(old: Path, new: Path) -> None:
    """Write the file `old` anew as `new`."""
    with np.load(old, allow_pickle=False) as file:
        arrays = dict(file)
    if "header" not in arrays:
        write_selector(_selector(arrays), new)
        return
    header = json.loads(arrays["header"].tobytes())
    contour = header["contour"]
    write_cnn_model(
        CnnModel(
            tuple(header["classes"]),
            PatchSettings(**header["patch"]),
            _network(arrays, "net"),
            header["temperature"],
            header["smallest_hand"],
            None if contour is None else ContourSettings(**contour),
            arrays["contour_mean"],
            arrays["contour_deviation"],
        ),
        new,
    )


def _selector(arrays: Arrays) -> Selector:
    classical = ClassicalParts(
        trees_from(arrays, "regions", cells.COLUMNS + BANK_NUMBERS),
        trees_from(arrays, "region_pairs", pairs.COLUMNS),
        bank_from(arrays, "bank"),
    )
    learned = LearnedParts(
        _network(arrays, "locator"),
        _network(arrays, "refiner"),
        trees_from(arrays, "places", choice.COLUMNS),
        trees_from(arrays, "place_pairs", pairs.COLUMNS),
    )
    return Selector(classical, learned)


def _network(arrays: Arrays, prefix: str) -> IntegerNetwork:
    layout = json.loads(arrays[f"{prefix}_layout"].tobytes())
    nodes = tuple(Node(**{**item, "inputs": tuple(item["inputs"])}) for item in layout["nodes"])
    weights = {
        node.name: Weights(
            *(arrays[f"{prefix}_{node.name}_{end}"] for end in ("weights", "biases", "scales"))
        )
        for node in nodes
        if f"{prefix}_{node.name}_weights" in arrays
    }
    inputs = {name: tuple(shape) for name, shape in layout["inputs"].items()}
    scales = {name: Quantisation(*item) for name, item in layout["quantisation"].items()}
    network = IntegerNetwork(inputs, nodes, tuple(layout["outputs"]), weights, scales)
    check_network(network)
    return network


if __name__ == "__main__":
    upgrade(Path(sys.argv[1]), Path(sys.argv[2]))
