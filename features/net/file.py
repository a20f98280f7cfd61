"""A network from two members of an archive: its `.tflite` file, and the layout that says what stands where in it.

The weights are in the archive once, in the `.tflite`. They are looked at through the places that the layout names, and
nothing else of that file is believed: LiteRT is given it only where it is, byte for byte, what is written anew of what
was checked (`flatbuffer`).
"""

import hashlib
import json
from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import (
    PASSING,
    WEIGHTED,
    IntegerNetwork,
    LiteRtFile,
    NetworkError,
    Node,
    Quantisation,
    Shape,
    Weights,
    infer_shapes,
    weight_shape,
)

LAYOUT, TFLITE = "layout", "tflite"
"""Ends of the names of the two members."""
WEIGHTS, BIASES, SCALES, SIZE = "weights", "biases", "scales", "size"
"""What a node may have in the `.tflite`; the layout's places are by "node/weights" and so on."""

LARGEST_LAYOUT: Final = 256 * 1024
"""Bytes of the text that lists the nodes."""
LARGEST_WEIGHT: Final = 127
"""Weights are symmetric, so -128 is not used."""
LARGEST_BIAS: Final = 2**30
"""Biases and the sum of all products stay below this each, so that their sum fits int32."""
LEAST_FACTOR, LARGEST_FACTOR = 2.0**-31, 2.0**8
"""Of input scale times weight scale over output scale: what the kernels of XNNPACK take."""
LEAST_RATIO, LARGEST_RATIO = 2.0**-10, 2.0**8
"""Of the scale of an operand of an addition over that of the sum: likewise."""


def network_from(arrays: Mapping[str, NDArray[Any]], prefix: str) -> IntegerNetwork:
    """The network whose members are `prefix`_layout and `prefix`_tflite, both uint8. Raises NetworkError, one line."""
    try:
        text, file = arrays[f"{prefix}_{LAYOUT}"], arrays[f"{prefix}_{TFLITE}"]
        if text.dtype != np.uint8 or text.nbytes > LARGEST_LAYOUT or file.dtype != np.uint8:
            raise NetworkError(f"{prefix} is no text of at most {LARGEST_LAYOUT} bytes and a file")
        layout, content = json.loads(text.tobytes()), file.tobytes()
        if layout["sha256"] != hashlib.sha256(content).hexdigest():
            raise NetworkError(f"the layout of {prefix} belongs to another .tflite than the one beside it")
        network = _network(layout, content)
        check_network(network)
    except NetworkError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise NetworkError(f"{prefix} is no valid network ({error})") from None
    return network


def check_network(network: IntegerNetwork) -> None:
    """Refuse what does not fit together. Raises NetworkError."""
    shapes = infer_shapes(network.inputs, network.nodes)
    computed = {node.name for node in network.nodes}
    if not network.outputs or len(set(network.outputs)) != len(network.outputs):
        raise NetworkError("the outputs must be one or more different nodes")
    if missing := [name for name in network.outputs if name not in computed]:
        raise NetworkError(f"output {missing[0]} is no node")
    for name in shapes:
        _check_quantisation(name, network.quantisation.get(name))
    for node in network.nodes:
        if node.op in WEIGHTED:
            _check_weights(node, network.weights.get(node.name), shapes)
        _check_scales(network, node)


def _network(layout: dict[str, Any], content: bytes) -> IntegerNetwork:
    nodes = tuple(Node(**{**item, "inputs": tuple(item["inputs"])}) for item in layout["nodes"])
    inputs = {str(name): tuple(int(side) for side in shape) for name, shape in layout["inputs"].items()}
    shapes = infer_shapes(inputs, nodes)  # type: ignore[arg-type]
    places = layout["places"]
    weights = {
        node.name: _weights(node, shapes[node.inputs[0]], places, content)
        for node in nodes
        if node.op in WEIGHTED
    }
    scales = {
        str(name): Quantisation(float(scale), int(zero))
        for name, (scale, zero) in layout["quantisation"].items()
    }
    sizes = {node.name: int(places[f"{node.name}/{SIZE}"]) for node in nodes if node.op == "upsample"}
    for name, place in sizes.items():
        if tuple(_at(content, place, np.int32, (2,))) != shapes[name][:2]:
            raise NetworkError(f"the size of {name} does not stand where the layout says")
    file = LiteRtFile(content, sizes)
    return IntegerNetwork(inputs, nodes, tuple(layout["outputs"]), weights, scales, file)  # type: ignore[arg-type]


def _weights(node: Node, source: Shape, places: Mapping[str, int], content: bytes) -> Weights:
    shape = weight_shape(node, source)
    channels = (shape[3 if node.op == "depthwise" else 0],)
    return Weights(
        _at(content, places[f"{node.name}/{WEIGHTS}"], np.int8, shape),
        _at(content, places[f"{node.name}/{BIASES}"], np.int32, channels),
        _at(content, places[f"{node.name}/{SCALES}"], np.float32, channels),
    )


def _at(content: bytes, place: int, kind: type[np.generic], shape: tuple[int, ...]) -> NDArray[Any]:
    """The array at this byte, little-endian. Raises ValueError where it is not all in the file."""
    dtype = np.dtype(kind).newbyteorder("<")
    return np.frombuffer(content, dtype, int(np.prod(shape, dtype=np.int64)), place).reshape(shape)


def _check_quantisation(name: str, quantisation: Quantisation | None) -> None:
    if quantisation is None:
        raise NetworkError(f"{name} has no scale")
    if not (0.0 < quantisation.scale < np.inf) or not -128 <= quantisation.zero <= 127:
        raise NetworkError(
            f"{name}: scale {quantisation.scale} or zero point {quantisation.zero} out of range"
        )


def _check_weights(node: Node, weights: Weights | None, shapes: Mapping[str, Shape]) -> None:
    expected = weight_shape(node, shapes[node.inputs[0]])
    if weights is None or weights.weights.shape != expected:
        raise NetworkError(f"{node.name}: its weights must have the shape {expected}")
    channels = shapes[node.name][2]
    if weights.biases.shape != (channels,) or weights.scales.shape != (channels,):
        raise NetworkError(f"{node.name}: {channels} biases and scales are needed")
    arrays = weights.weights, weights.biases, weights.scales
    if [array.dtype.name for array in arrays] != ["int8", "int32", "float32"]:
        raise NetworkError(f"{node.name}: weights, biases and scales must be int8, int32 and float32")
    if weights.weights.min() < -LARGEST_WEIGHT:
        raise NetworkError(f"{node.name}: a weight is below -{LARGEST_WEIGHT}")
    if np.abs(weights.biases.astype(np.int64)).max() > LARGEST_BIAS:
        raise NetworkError(f"{node.name}: a bias is beyond {LARGEST_BIAS}")
    if not (np.isfinite(weights.scales).all() and (weights.scales > 0).all()):
        raise NetworkError(f"{node.name}: the scales of its weights must be above 0")


def _check_scales(network: IntegerNetwork, node: Node) -> None:
    sources = [network.quantisation[name] for name in node.inputs]
    result = network.quantisation[node.name]
    if node.op in WEIGHTED:
        factors = network.factors(node)
        if not (factors.min() >= LEAST_FACTOR and factors.max() < LARGEST_FACTOR):
            raise NetworkError(
                f"{node.name}: scales of input and weights over that of the output must be "
                f"{LEAST_FACTOR:.1e} to {LARGEST_FACTOR:.0f}, not {factors.min():.1e} to {factors.max():.1e}"
            )
    elif node.op in PASSING:
        if any(source != result for source in sources):
            raise NetworkError(f"{node.name}: the inputs of {node.op} must have the scale of its output")
    elif not all(LEAST_RATIO <= source.scale / result.scale < LARGEST_RATIO for source in sources):
        raise NetworkError(
            f"{node.name}: the scales of the inputs of {node.op} are too far from its output's"
        )
