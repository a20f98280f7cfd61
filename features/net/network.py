"""A small integer network as data: its layers, its int8 weights, and the scale and zero point of every tensor.

Numbers follow the 8-bit quantisation specification of LiteRT (Jacob et al., "Quantization and Training of Neural
Networks for Efficient Integer-Arithmetic-Only Inference", 2018): value = scale * (integer - zero), weights symmetric
with a scale for each output channel, biases int32 with the product of the input's and the weights' scales.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.nodes import (
    PASSING,
    WEIGHTED,
    NetworkError,
    Node,
    Shape,
    infer_shapes,
    same_padding,
    weight_shape,
)

__all__ = [
    "IntegerNetwork",
    "NetworkError",
    "Node",
    "Quantisation",
    "Shape",
    "Weights",
    "dequantise",
    "infer_shapes",
    "quantise",
    "same_padding",
]

LARGEST_WEIGHT = 127
"""Weights are symmetric, so -128 is not used."""
LARGEST_BIAS = 2**30
"""Biases and the sum of all products stay below this each, so that their sum fits int32."""
LEAST_FACTOR, LARGEST_FACTOR = 2.0**-31, 2.0**8
"""Of input scale times weight scale over output scale: what the kernels of XNNPACK take."""
LEAST_RATIO, LARGEST_RATIO = 2.0**-10, 2.0**8
"""Of the scale of an operand of an addition over that of the sum: likewise."""


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
        computed = {node.name for node in self.nodes}
        if not self.outputs or len(set(self.outputs)) != len(self.outputs):
            raise NetworkError("the outputs must be one or more different nodes")
        if missing := [name for name in self.outputs if name not in computed]:
            raise NetworkError(f"output {missing[0]} is no node")
        for name in shapes:
            _check_quantisation(name, self.quantisation.get(name))
        for node in self.nodes:
            if node.op in WEIGHTED:
                _check_weights(node, self.weights.get(node.name), shapes)
            self._check_scales(node)

    def factors(self, node: Node) -> NDArray[np.float64]:
        """What brings the sums of a weighted node to the scale of its output, for each channel."""
        own, result = self.quantisation[node.inputs[0]], self.quantisation[node.name]
        return self.weights[node.name].scales.astype(np.float64) * own.scale / result.scale

    def _check_scales(self, node: Node) -> None:
        sources = [self.quantisation[name] for name in node.inputs]
        result = self.quantisation[node.name]
        if node.op in WEIGHTED:
            factors = self.factors(node)
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


def quantise(values: NDArray[np.floating], quantisation: Quantisation) -> NDArray[np.int8]:
    """Nearest integers, clipped to int8."""
    levels = np.rint(np.asarray(values) * np.float32(1.0 / quantisation.scale)) + quantisation.zero
    return np.asarray(np.clip(levels, -128, 127), np.int8)


def dequantise(levels: NDArray[np.int8], quantisation: Quantisation) -> NDArray[np.float32]:
    """What the integers stand for."""
    return (levels.astype(np.float32) - np.float32(quantisation.zero)) * np.float32(quantisation.scale)
