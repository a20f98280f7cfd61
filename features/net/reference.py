"""The reference: the integers of a network computed in NumPy, as LiteRT's own reference kernels define them.

Plain, without a run-time to install. The fast run-time is tested against it, and it runs where that is missing.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.network import IntegerNetwork, Node, Quantisation, same_padding

Levels = NDArray[np.int8]
Wide = NDArray[np.int64]

ADD_SHIFT = 20
"""Bits by which an addition widens its operands before it scales them (LiteRT's reference kernel)."""
MULTIPLIER_BITS = 31
LARGEST_PRODUCT = 255 * 127
"""Of a level without its zero point and a weight."""
EXACT_IN_FLOAT32 = 2**24
"""float32 holds every integer up to here, so sums below it may take the fast matrix product."""
LOWEST, HIGHEST = -128, 127


@dataclass(frozen=True, slots=True, eq=False)
class _Layer:
    """weights: of a weighted node as floats wide enough for exact sums: (k, k, in, out), depthwise (k, k, channels),
    dense (in, out). factors: to the scale of the output."""

    weights: NDArray[np.floating]
    biases: Wide
    factors: NDArray[np.float64]


class NumpyRunner:
    """Runs a network on any batch and any height and width that its layers allow."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = network
        self._layers = {
            node.name: _layer(network, node) for node in network.nodes if node.name in network.weights
        }

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]:
        """int8 (n, h, w, channels) for each input -> the same for each output."""
        tensors = self.tensors(inputs)
        return {name: tensors[name] for name in self._network.outputs}

    def tensors(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]:
        """The same of every input and node."""
        tensors = dict(inputs)
        for node in self._network.nodes:
            tensors[node.name] = self._compute(node, [tensors[name] for name in node.inputs])
        return tensors

    def _compute(self, node: Node, sources: list[Levels]) -> Levels:
        if node.op == "upsample":
            return sources[0].repeat(2, axis=1).repeat(2, axis=2)
        scales = [self._network.quantisation[name] for name in node.inputs]
        result = self._network.quantisation[node.name]
        if node.op == "add":
            return _add(node, sources, scales, result)
        layer = self._layers[node.name]
        sums = _weighted_sums(node, layer.weights, sources[0], scales[0].zero)
        return _activate(multiply(sums + layer.biases, layer.factors), result, node.activation)


def multiply(values: Wide, factors: NDArray[np.float64] | float) -> Wide:
    """Values times factors, rounded to the nearest, halves upwards."""
    multipliers, shifts = fixed_point(factors)
    return np.asarray((values * multipliers + (np.int64(1) << (shifts - 1))) >> shifts)


def fixed_point(factors: NDArray[np.float64] | float) -> tuple[Wide, Wide]:
    """31-bit multipliers and right shifts: factor = multiplier / 2**shift."""
    mantissas, exponents = np.frexp(np.asarray(factors, np.float64))
    multipliers = np.rint(mantissas * (1 << MULTIPLIER_BITS)).astype(np.int64)
    return multipliers, np.asarray(MULTIPLIER_BITS - exponents.astype(np.int64))


def addition_factors(scales: Sequence[Quantisation], result: Quantisation) -> tuple[list[float], float]:
    """What brings each widened operand of an addition to a common scale, and their sum to the result's."""
    twice_largest = 2.0 * max(scale.scale for scale in scales)
    own = [scale.scale / twice_largest for scale in scales]
    return own, twice_largest / ((1 << ADD_SHIFT) * result.scale)


def bounds(result: Quantisation, activation: str) -> tuple[int, int]:
    """The lowest and highest integer that an activation leaves."""
    if activation != "relu6":
        return LOWEST, HIGHEST
    return max(LOWEST, result.zero), min(HIGHEST, result.zero + round(6.0 / result.scale))


def _layer(network: IntegerNetwork, node: Node) -> _Layer:
    own = network.weights[node.name]
    weights = own.weights
    if node.op == "conv":
        weights = weights.transpose(1, 2, 3, 0)
    elif node.op == "depthwise":
        weights = weights[0]
    else:
        weights = weights.T
    summed = weights.size // len(own.biases)
    exact = np.float32 if summed * LARGEST_PRODUCT < EXACT_IN_FLOAT32 else np.float64
    return _Layer(
        np.ascontiguousarray(weights, dtype=exact), own.biases.astype(np.int64), network.factors(node)
    )


def _weighted_sums(node: Node, weights: NDArray[np.floating], levels: Levels, zero: int) -> Wide:
    """Sums of products over the taps of each output cell: int64 (n, h, w, channels)."""
    source = levels.astype(weights.dtype) - weights.dtype.type(zero)
    if node.op == "dense":
        flat = source.reshape(len(source), weights.shape[0])
        return np.asarray(flat @ weights, np.int64)[:, None, None, :]
    # The zero point was taken off, so what is padded counts as the value 0.
    parts = _taps(source, node)
    if node.op == "depthwise":
        sums = sum(part * weights[row, column] for row, column, part in parts)
    else:
        sums = sum(part @ weights[row, column] for row, column, part in parts)
    return np.asarray(sums, np.int64)


def _taps(source: NDArray[np.generic], node: Node) -> list[tuple[int, int, NDArray[np.generic]]]:
    """(row, column, what each output cell sees there) for every place of the kernel."""
    rows, columns = source.shape[1:3]
    padding = same_padding(rows, node.kernel, node.stride), same_padding(columns, node.kernel, node.stride)
    padded = np.pad(source, ((0, 0), *padding, (0, 0)))
    height, width = -(-rows // node.stride), -(-columns // node.stride)
    parts = []
    for row in range(node.kernel):
        for column in range(node.kernel):
            last_row = row + node.stride * (height - 1) + 1
            last_column = column + node.stride * (width - 1) + 1
            part = padded[:, row : last_row : node.stride, column : last_column : node.stride]
            parts.append((row, column, part))
    return parts


def _add(node: Node, sources: list[Levels], scales: list[Quantisation], result: Quantisation) -> Levels:
    """Both operands on a common scale, added, and brought to the result's."""
    factors, last = addition_factors(scales, result)
    total = np.zeros(sources[0].shape, np.int64)
    for levels, scale, factor in zip(sources, scales, factors, strict=True):
        total += multiply((levels.astype(np.int64) - scale.zero) << ADD_SHIFT, factor)
    return _activate(multiply(total, last), result, node.activation)


def _activate(values: Wide, result: Quantisation, activation: str) -> Levels:
    return np.asarray(np.clip(values + result.zero, *bounds(result, activation)), np.int8)
