"""A small integer network as data: its layers, its int8 weights, and the scale and zero point of every tensor.

Numbers follow the 8-bit quantisation specification of LiteRT (Jacob et al., "Quantization and Training of Neural
Networks for Efficient Integer-Arithmetic-Only Inference", 2018): value = scale * (integer - zero), weights symmetric with
a scale for each output channel, biases int32 with the product of the input's and the weights' scales.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WEIGHTED = ("conv", "depthwise", "dense")
OPERATIONS = (*WEIGHTED, "add", "upsample")
ACTIVATIONS = ("none", "relu6")
LARGEST_SIDE, MOST_CHANNELS, MOST_NODES, LARGEST_KERNEL = 4096, 1024, 256, 7
"""Limits of what a file may ask for."""

Shape = tuple[int, int, int]
"""Height, width, channels; a dense layer's output has height and width 1."""


class NetworkError(ValueError):
    """A network that cannot be used: one line with the reason."""


@dataclass(frozen=True, slots=True)
class Node:
    """One layer.

    op: "conv" (padding as TensorFlow's SAME), "depthwise" (likewise, one filter a channel), "dense" (over all of a
    picture, height first, channels last), "add" (of two tensors), "upsample" (each cell doubled both ways). inputs: names
    of nodes or inputs. channels: of the output, for conv and dense. kernel, stride: for conv and depthwise.
    activation: "none" or "relu6" (0 to 6), for all but upsample.
    """

    name: str
    op: str
    inputs: tuple[str, ...]
    channels: int = 0
    kernel: int = 1
    stride: int = 1
    activation: str = "none"


@dataclass(frozen=True, slots=True)
class Quantisation:
    """value = scale * (integer - zero)."""

    scale: float
    zero: int


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """weights: int8, conv (out, k, k, in), depthwise (1, k, k, channels), dense (out, in). biases: int32 (out,).
    scales: float32 (out,), of the weights of each output channel."""

    weights: NDArray[np.int8]
    biases: NDArray[np.int32]
    scales: NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class IntegerNetwork:
    """inputs: shape of each input, height and width those of the training. nodes: in the order of computation.
    outputs: names. weights: for each weighted node. quantisation: for every input and node."""

    inputs: Mapping[str, Shape]
    nodes: tuple[Node, ...]
    outputs: tuple[str, ...]
    weights: Mapping[str, Weights]
    quantisation: Mapping[str, Quantisation]

    def check(self) -> None:
        """Refuse what does not fit together. Raises NetworkError."""
        shapes = infer_shapes(self.inputs, self.nodes)
        if missing := [name for name in self.outputs if name not in shapes]:
            raise NetworkError(f"output {missing[0]} is no node")
        for name in shapes:
            _check_quantisation(name, self.quantisation.get(name))
        for node in self.nodes:
            if node.op in WEIGHTED:
                _check_weights(node, self.weights.get(node.name), shapes)


def same_padding(size: int, kernel: int, stride: int) -> tuple[int, int]:
    """Rows before and after, so that the output has ceil(size / stride) rows."""
    total = max((-(-size // stride) - 1) * stride + kernel - size, 0)
    return total // 2, total - total // 2


def infer_shapes(inputs: Mapping[str, Shape], nodes: Sequence[Node]) -> dict[str, Shape]:
    """Shape of every tensor for inputs of these shapes. Raises NetworkError."""
    if len(nodes) > MOST_NODES:
        raise NetworkError(f"{len(nodes)} nodes are more than {MOST_NODES}")
    shapes = {name: tuple(shape) for name, shape in inputs.items()}
    for name, shape in shapes.items():
        _check_shape(name, shape)
    for node in nodes:
        _check_node(node, shapes)
        shape = _output_shape(node, [shapes[name] for name in node.inputs])
        _check_shape(node.name, shape)
        shapes[node.name] = shape
    return shapes  # type: ignore[return-value]


def weight_shape(node: Node, source: Shape) -> tuple[int, ...]:
    """Shape of a node's weights for an input of the shape `source`."""
    if node.op == "conv":
        return node.channels, node.kernel, node.kernel, source[2]
    if node.op == "depthwise":
        return 1, node.kernel, node.kernel, source[2]
    return node.channels, source[0] * source[1] * source[2]


def _output_shape(node: Node, sources: Sequence[tuple[int, ...]]) -> Shape:
    height, width, channels = sources[0]
    if node.op == "dense":
        return 1, 1, node.channels
    if node.op == "upsample":
        return 2 * height, 2 * width, channels
    if node.op == "add":
        if sources[1] != sources[0]:
            raise NetworkError(f"{node.name} adds tensors of different shapes, {sources[0]} and {sources[1]}")
        return height, width, channels
    rows, columns = -(-height // node.stride), -(-width // node.stride)
    return rows, columns, node.channels if node.op == "conv" else channels


def _check_node(node: Node, known: Mapping[str, object]) -> None:
    if node.op not in OPERATIONS:
        raise NetworkError(f"{node.name}: unknown operation {node.op!r}")
    if node.activation not in ACTIVATIONS:
        raise NetworkError(f"{node.name}: unknown activation {node.activation!r}")
    if node.name in known:
        raise NetworkError(f"{node.name}: the name is used twice")
    if len(node.inputs) != (2 if node.op == "add" else 1):
        raise NetworkError(f"{node.name}: {len(node.inputs)} inputs do not fit {node.op}")
    if unknown := [name for name in node.inputs if name not in known]:
        raise NetworkError(f"{node.name}: its input {unknown[0]} does not come before it")
    if not (1 <= node.kernel <= LARGEST_KERNEL and 1 <= node.stride <= 4):
        raise NetworkError(f"{node.name}: kernel 1 to {LARGEST_KERNEL}, stride 1 to 4")


def _check_shape(name: str, shape: tuple[int, ...]) -> None:
    if len(shape) != 3 or not all(1 <= side <= LARGEST_SIDE for side in shape[:2]):
        raise NetworkError(f"{name}: shape {shape} is not height, width, channels up to {LARGEST_SIDE}")
    if not 1 <= shape[2] <= MOST_CHANNELS:
        raise NetworkError(f"{name}: {shape[2]} channels; 1 to {MOST_CHANNELS} are allowed")


def _check_quantisation(name: str, quantisation: Quantisation | None) -> None:
    if quantisation is None:
        raise NetworkError(f"{name} has no scale")
    if not (0.0 < quantisation.scale < np.inf) or not -128 <= quantisation.zero <= 127:
        raise NetworkError(f"{name}: scale {quantisation.scale} or zero point {quantisation.zero} out of range")


def _check_weights(node: Node, weights: Weights | None, shapes: Mapping[str, Shape]) -> None:
    expected = weight_shape(node, shapes[node.inputs[0]])
    if weights is None or weights.weights.shape != expected:
        raise NetworkError(f"{node.name}: its weights must have the shape {expected}")
    channels = shapes[node.name][2]
    if weights.biases.shape != (channels,) or weights.scales.shape != (channels,):
        raise NetworkError(f"{node.name}: {channels} biases and scales are needed")
    if not (np.isfinite(weights.scales).all() and (weights.scales > 0).all()):
        raise NetworkError(f"{node.name}: the scales of its weights must be above 0")


def quantise(values: NDArray[np.floating], quantisation: Quantisation) -> NDArray[np.int8]:
    """Nearest integers, clipped to int8."""
    levels = np.rint(np.asarray(values) * np.float32(1.0 / quantisation.scale)) + quantisation.zero
    return np.clip(levels, -128, 127).astype(np.int8)


def dequantise(levels: NDArray[np.int8], quantisation: Quantisation) -> NDArray[np.float32]:
    """What the integers stand for."""
    return (levels.astype(np.float32) - np.float32(quantisation.zero)) * np.float32(quantisation.scale)
