"""The nets as tables of layers with flat arrays, and what they answer to test inputs."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.export.files import FlatFiles
from lightgesture.features.net.network import (
    WEIGHTED,
    IntegerNetwork,
    Node,
    Quantisation,
    Shape,
    infer_shapes,
    same_padding,
)
from lightgesture.features.net.reference import (
    ADD_SHIFT,
    NumpyRunner,
    addition_factors,
    bounds,
    fixed_point,
)

Levels = NDArray[np.int8]

VECTORS: Final = 3
"""Test inputs of a net: noise, a ramp, and the zero point alone."""


def export_net(files: FlatFiles, name: str, network: IntegerNetwork, extra: Mapping[str, Any]) -> None:
    """Write the net as `name`.json, `name`.bin and, for LiteRT, `name`.tflite. extra: goes into the JSON too."""
    shapes = infer_shapes(network.inputs, network.nodes)
    content = {
        **extra,
        "inputs": [
            {"name": one, "shape": list(shape), **_scale(network.quantisation[one])}
            for one, shape in network.inputs.items()
        ],
        "outputs": list(network.outputs),
        "layers": [_layer(files, name, network, node, shapes) for node in network.nodes],
        "vectors": _vectors(files, name, network),
    }
    files.add_json(f"{name}.json", content)
    if network.litert is not None:
        files.add_file(f"{name}.tflite", network.litert.content)


def _layer(
    files: FlatFiles, name: str, network: IntegerNetwork, node: Node, shapes: Mapping[str, Shape]
) -> dict[str, Any]:
    result = network.quantisation[node.name]
    layer: dict[str, Any] = {
        "name": node.name,
        "op": node.op,
        "inputs": list(node.inputs),
        "shape": list(shapes[node.name]),
        **_scale(result),
    }
    if node.op == "upsample":
        return layer
    layer["lowest"], layer["highest"] = bounds(result, node.activation)
    if node.op == "add":
        own, last = addition_factors([network.quantisation[one] for one in node.inputs], result)
        layer["widening_shift"] = ADD_SHIFT
        layer["operands"] = [_fixed(factor) for factor in own]
        layer["sum"] = _fixed(last)
        return layer
    if node.op in ("conv", "depthwise"):
        height, width, _ = shapes[node.inputs[0]]
        layer |= {
            "kernel": node.kernel,
            "stride": node.stride,
            "padding_above_below": list(same_padding(height, node.kernel, node.stride)),
            "padding_left_right": list(same_padding(width, node.kernel, node.stride)),
        }
    assert node.op in WEIGHTED
    multipliers, shifts = fixed_point(network.factors(node))
    own_weights = network.weights[node.name]
    arrays: dict[str, NDArray[Any]] = {
        "weights": own_weights.weights,
        "biases": own_weights.biases,
        "scales": own_weights.scales,
        "multipliers": multipliers,
        "shifts": shifts.astype(np.int32),
    }
    layer["arrays"] = {
        kind: files.add_array(name, f"{node.name}/{kind}", array) for kind, array in arrays.items()
    }
    return layer


def _vectors(files: FlatFiles, name: str, network: IntegerNetwork) -> dict[str, Any]:
    """Inputs and the outputs of each, and every tensor of the first."""
    inputs = {
        one: _test_inputs(shape, network.quantisation[one].zero) for one, shape in network.inputs.items()
    }
    runner = NumpyRunner(network)
    outputs = runner.run(inputs)
    first = runner.tensors({one: levels[:1] for one, levels in inputs.items()})

    def stored(part: str, tensors: Mapping[str, Levels]) -> dict[str, str]:
        return {
            one: files.add_array("vectors", f"{name}/{part}/{one}", levels) for one, levels in tensors.items()
        }

    return {
        "inputs": stored("input", inputs),
        "outputs": stored("output", outputs),
        "every_tensor_of_the_first": stored("first", first),
    }


def _test_inputs(shape: Shape, zero: int) -> Levels:
    """int8 (VECTORS, h, w, channels), the same in every run."""
    noise = np.random.default_rng(7).integers(-128, 128, shape)
    rows, columns, channels = np.ogrid[: shape[0], : shape[1], : shape[2]]
    ramp = (3 * rows + 2 * columns + 40 * channels) % 256 - 128
    return np.stack([noise, ramp, np.full(shape, zero)]).astype(np.int8)


def _scale(quantisation: Quantisation) -> dict[str, float | int]:
    return {"scale": quantisation.scale, "zero": quantisation.zero}


def _fixed(factor: float) -> dict[str, int]:
    multiplier, shift = fixed_point(factor)
    return {"multiplier": int(multiplier), "shift": int(shift)}
