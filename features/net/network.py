"""A small integer network as data: its layers and the shapes that follow, its int8 weights, every tensor's scale.

Numbers follow the 8-bit quantisation specification of LiteRT (Jacob et al., "Quantization and Training of Neural
Networks for Efficient Integer-Arithmetic-Only Inference", 2018): value = scale * (integer - zero), weights symmetric
with a scale for each output channel, biases int32 with the product of the input's and the weights' scales.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WEIGHTED = ("conv", "depthwise", "dense")
"""Operations with weights."""
PASSING = ("upsample",)
"""Operations that hand values on unchanged, so that their output has the scale of their input."""
OPERATIONS = (*WEIGHTED, *PASSING, "add")
ACTIVATIONS = ("none", "relu6")

LARGEST_SIDE, MOST_CHANNELS, MOST_NODES, MOST_INPUTS, LARGEST_KERNEL, LARGEST_STRIDE = (
    4096,
    1024,
    256,
    8,
    7,
    4,
)
LARGEST_NAME = 64
LARGEST_TENSOR = 2**24
"""Values of one tensor of one picture: bounds the memory that a file may ask for."""
MOST_TAPS = 2**15
"""Products summed by one output value: 2**15 of at most 255 * 127 stay below 2**30, half of what int32 holds."""

Shape = tuple[int, int, int]
"""Height, width, channels; a vector has height and width 1."""


class NetworkError(ValueError):
    """A network that cannot be used: one line with the reason."""


@dataclass(frozen=True, slots=True)
class Node:
    """One layer.

    op: "conv" (padding as TensorFlow's SAME: at stride 2 the odd row or column goes below or to the right), "depthwise"
    (likewise, one filter a channel), "dense" (over all of a picture: rows, then columns, then channels), "add" (of two
    tensors), "upsample" (each cell doubled both ways). inputs: names of earlier nodes or of inputs. channels: of the
    output, for conv and dense. kernel, stride: for conv and depthwise. activation: "none" or "relu6" (0 to 6), of
    weighted layers and add.
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
class LiteRtFile:
    """A network as LiteRT reads it, for pictures of the training's size.

    content: of the `.tflite` file. sizes: for each node "upsample" the byte at which height and width of its output
    stand, two int32: all in the file that another size of the inputs changes.
    """

    content: bytes
    sizes: Mapping[str, int]


@dataclass(frozen=True, slots=True, eq=False)
class IntegerNetwork:
    """inputs: shape of each input, height and width those of the training. nodes: in the order of computation.
    outputs: names. weights: for each weighted node. quantisation: for every input and node. litert: the same network
    for LiteRT, None where only NumPy is to run it."""

    inputs: Mapping[str, Shape]
    nodes: tuple[Node, ...]
    outputs: tuple[str, ...]
    weights: Mapping[str, Weights]
    quantisation: Mapping[str, Quantisation]
    litert: LiteRtFile | None = None

    def factors(self, node: Node) -> NDArray[np.float64]:
        """What brings the sums of a weighted node to the scale of its output, for each channel."""
        own, result = self.quantisation[node.inputs[0]], self.quantisation[node.name]
        return self.weights[node.name].scales.astype(np.float64) * own.scale / result.scale


def same_padding(size: int, kernel: int, stride: int) -> tuple[int, int]:
    """Rows before and after, so that the output has ceil(size / stride) rows."""
    total = max((-(-size // stride) - 1) * stride + kernel - size, 0)
    return total // 2, total - total // 2


def infer_shapes(inputs: Mapping[str, Shape], nodes: Sequence[Node]) -> dict[str, Shape]:
    """Shape of every tensor for inputs of these shapes. Raises NetworkError."""
    if len(nodes) > MOST_NODES:
        raise NetworkError(f"{len(nodes)} nodes are more than {MOST_NODES}")
    if not 1 <= len(inputs) <= MOST_INPUTS:
        raise NetworkError(f"{len(inputs)} inputs; 1 to {MOST_INPUTS} are allowed")
    shapes: dict[str, Shape] = {}
    for name, shape in inputs.items():
        _check_name(name)
        shapes[name] = _checked_shape(name, tuple(shape))
    for node in nodes:
        _check_node(node, shapes)
        shapes[node.name] = _checked_shape(
            node.name, _output_shape(node, [shapes[name] for name in node.inputs])
        )
    return shapes


def weight_shape(node: Node, source: Shape) -> tuple[int, ...]:
    """Shape of a node's weights for an input of the shape `source`."""
    if node.op == "conv":
        return node.channels, node.kernel, node.kernel, source[2]
    if node.op == "depthwise":
        return 1, node.kernel, node.kernel, source[2]
    return node.channels, source[0] * source[1] * source[2]


def taps(node: Node, source: Shape) -> int:
    """Products summed by one output value of a weighted layer."""
    if node.op == "dense":
        return source[0] * source[1] * source[2]
    return node.kernel * node.kernel * (source[2] if node.op == "conv" else 1)


def _output_shape(node: Node, sources: Sequence[Shape]) -> Shape:
    height, width, channels = sources[0]
    if node.op == "dense":
        return 1, 1, node.channels
    if node.op == "upsample":
        return 2 * height, 2 * width, channels
    if node.op == "add":
        if sources[1] != sources[0]:
            raise NetworkError(f"{node.name}: the shapes {sources[0]} and {sources[1]} do not fit add")
        return height, width, channels
    rows, columns = -(-height // node.stride), -(-width // node.stride)
    return rows, columns, node.channels if node.op == "conv" else channels


def _check_name(name: str) -> None:
    if not (name.isidentifier() and name.isascii() and len(name) <= LARGEST_NAME):
        raise NetworkError(
            f"{name[:LARGEST_NAME]!r} is no name of a tensor: letters, digits and _, up to {LARGEST_NAME}"
        )


def _check_node(node: Node, known: Mapping[str, Shape]) -> None:
    _check_name(node.name)
    if node.op not in OPERATIONS:
        raise NetworkError(f"{node.name}: unknown operation {node.op!r}; known are {', '.join(OPERATIONS)}")
    allowed = ACTIVATIONS if node.op in (*WEIGHTED, "add") else ACTIVATIONS[:1]
    if node.activation not in allowed:
        raise NetworkError(
            f"{node.name}: activation {node.activation!r} of {node.op} is not {', '.join(allowed)}"
        )
    if node.name in known:
        raise NetworkError(f"{node.name}: the name is used twice")
    if len(node.inputs) != (2 if node.op == "add" else 1):
        raise NetworkError(f"{node.name}: {len(node.inputs)} inputs do not fit {node.op}")
    if unknown := [name for name in node.inputs if name not in known]:
        raise NetworkError(f"{node.name}: its input {unknown[0]} does not come before it")
    if not (1 <= node.kernel <= LARGEST_KERNEL and 1 <= node.stride <= LARGEST_STRIDE):
        raise NetworkError(f"{node.name}: kernel must be 1 to {LARGEST_KERNEL}, stride 1 to {LARGEST_STRIDE}")
    source = known[node.inputs[0]]
    if node.op in WEIGHTED and taps(node, source) > MOST_TAPS:
        raise NetworkError(f"{node.name}: sums {taps(node, source)} products, more than {MOST_TAPS}")


def _checked_shape(name: str, shape: tuple[int, ...]) -> Shape:
    if len(shape) != 3 or not all(1 <= side <= LARGEST_SIDE for side in shape[:2]):
        raise NetworkError(
            f"{name}: shape {shape} is not height, width, channels with sides up to {LARGEST_SIDE}"
        )
    height, width, channels = shape
    if not 1 <= channels <= MOST_CHANNELS:
        raise NetworkError(f"{name}: {channels} channels; 1 to {MOST_CHANNELS} are allowed")
    if height * width * channels > LARGEST_TENSOR:
        raise NetworkError(f"{name}: shape {shape} holds more than {LARGEST_TENSOR} values")
    return height, width, channels
