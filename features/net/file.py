"""Networks as plain arrays, to be kept among others in one `.npz`."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import IntegerNetwork, NetworkError, Node, Quantisation, Weights

Arrays = Mapping[str, NDArray[Any]]

LARGEST_LAYOUT = 256 * 1024
"""Bytes of the text that lists the nodes."""


def network_arrays(prefix: str, network: IntegerNetwork) -> dict[str, NDArray[Any]]:
    """All that a network holds, under names that begin with `prefix`."""
    layout = {
        "inputs": {name: list(shape) for name, shape in network.inputs.items()},
        "outputs": list(network.outputs),
        "nodes": [asdict(node) for node in network.nodes],
        "quantisation": {name: [item.scale, item.zero] for name, item in network.quantisation.items()},
    }
    arrays: dict[str, NDArray[Any]] = {
        f"{prefix}_layout": np.frombuffer(json.dumps(layout).encode(), np.uint8)
    }
    for name, own in network.weights.items():
        arrays[f"{prefix}_{name}_weights"] = own.weights
        arrays[f"{prefix}_{name}_biases"] = own.biases
        arrays[f"{prefix}_{name}_scales"] = own.scales
    return arrays


def network_from(arrays: Arrays, prefix: str) -> IntegerNetwork:
    """The network that `network_arrays` stored. Raises NetworkError, one line."""
    try:
        text = arrays[f"{prefix}_layout"]
        if text.dtype != np.uint8 or text.nbytes > LARGEST_LAYOUT:
            raise NetworkError(f"the layout of {prefix} is no text of at most {LARGEST_LAYOUT} bytes")
        network = _network(json.loads(text.tobytes()), arrays, prefix)
    except NetworkError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise NetworkError(f"{prefix} is no valid network ({error})") from None
    network.check()
    return network


def _network(layout: Any, arrays: Arrays, prefix: str) -> IntegerNetwork:
    nodes = tuple(Node(**{**item, "inputs": tuple(item["inputs"])}) for item in layout["nodes"])
    weights = {
        node.name: Weights(
            _typed(arrays[f"{prefix}_{node.name}_weights"], np.int8),
            _typed(arrays[f"{prefix}_{node.name}_biases"], np.int32),
            _typed(arrays[f"{prefix}_{node.name}_scales"], np.float32),
        )
        for node in nodes
        if f"{prefix}_{node.name}_weights" in arrays
    }
    inputs = {str(name): tuple(int(side) for side in shape) for name, shape in layout["inputs"].items()}
    scales = {
        str(name): Quantisation(float(scale), int(zero))
        for name, (scale, zero) in layout["quantisation"].items()
    }
    return IntegerNetwork(inputs, nodes, tuple(layout["outputs"]), weights, scales)  # type: ignore[arg-type]


def _typed(array: NDArray[Any], kind: type[np.generic]) -> NDArray[Any]:
    if array.dtype != kind:
        raise NetworkError(f"an array of {array.dtype} stands where {np.dtype(kind)} is expected")
    return array
