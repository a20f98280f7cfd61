"""The reference: the integers of a network computed in NumPy, as LiteRT's own reference kernels do.

Slow and plain. It is what the fast run-time is tested against, and what runs where that is not installed.
"""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.network import IntegerNetwork, Node, Quantisation, same_padding

Levels = NDArray[np.int8]
Wide = NDArray[np.int64]

ADD_SHIFT = 20
"""Bits by which an addition widens its operands before it scales them."""


class NumpyRunner:
    """Runs a network of any input size and batch."""

    def __init__(self, network: IntegerNetwork) -> None:
        self._network = network

    def run(self, inputs: Mapping[str, Levels]) -> dict[str, Levels]:
        """int8 (n, h, w, channels) for each input -> the same for each output."""
        network = self._network
        tensors = dict(inputs)
        for node in network.nodes:
            tensors[node.name] = self._compute(node, [tensors[name] for name in node.inputs])
        return {name: tensors[name] for name in network.outputs}

    def _compute(self, node: Node, sources: list[Levels]) -> Levels:
        if node.op == "upsample":
            return sources[0].repeat(2, axis=1).repeat(2, axis=2)
        scales = self._network.quantisation
        if node.op == "add":
            quantised = [scales[name] for name in node.inputs]
            return _add(sources, quantised, scales[node.name], node.activation)
        weights = self._network.weights[node.name]
        own, result = scales[node.inputs[0]], scales[node.name]
        sums = _weighted_sums(node, sources[0].astype(np.int64) - own.zero, weights.weights.astype(np.int64))
        sums += weights.biases
        factors = weights.scales.astype(np.float64) * own.scale / result.scale
        scaled = np.empty_like(sums)
        for channel, factor in enumerate(factors):
            scaled[..., channel] = multiply(sums[..., channel], float(factor))
        return _activate(scaled, result, node.activation)


def multiply(values: Wide, factor: float) -> Wide:
    """Values times a factor, as a 31-bit multiplier and a shift, rounded to the nearest."""
    mantissa, exponent = math.frexp(factor)
    multiplier = round(mantissa * (1 << 31))
    shift = 31 - exponent
    return np.asarray((values * multiplier + (1 << (shift - 1))) >> shift)


def _weighted_sums(node: Node, source: Wide, weights: Wide) -> Wide:
    """Sums of products over the taps of each output cell: int64 (n, h, w, channels)."""
    if node.op == "dense":
        flat = source.reshape(len(source), -1)
        return np.asarray((flat @ weights.T)[:, None, None, :])
    rows, columns = source.shape[1:3]
    above, below = same_padding(rows, node.kernel, node.stride)
    before, after = same_padding(columns, node.kernel, node.stride)
    # The zero point was taken off, so what is padded counts as the value 0.
    padded = np.pad(source, ((0, 0), (above, below), (before, after), (0, 0)))
    height, width = -(-rows // node.stride), -(-columns // node.stride)
    channels = weights.shape[3] if node.op == "depthwise" else weights.shape[0]
    sums = np.zeros((len(source), height, width, channels), np.int64)
    for row in range(node.kernel):
        for column in range(node.kernel):
            last_row = row + node.stride * (height - 1) + 1
            last_column = column + node.stride * (width - 1) + 1
            part = padded[:, row : last_row : node.stride, column : last_column : node.stride]
            tap = weights[:, row, column]
            sums += part * tap[0] if node.op == "depthwise" else part @ tap.T
    return sums


def _add(
    sources: list[Levels], scales: list[Quantisation], result: Quantisation, activation: str
) -> Levels:
    """Both operands on a common scale, added, and brought to the result's."""
    twice_largest = 2.0 * max(scale.scale for scale in scales)
    total = np.zeros(sources[0].shape, np.int64)
    for levels, scale in zip(sources, scales, strict=True):
        shifted = (levels.astype(np.int64) - scale.zero) << ADD_SHIFT
        total += multiply(shifted, scale.scale / twice_largest)
    return _activate(multiply(total, twice_largest / ((1 << ADD_SHIFT) * result.scale)), result, activation)


def _activate(values: Wide, result: Quantisation, activation: str) -> Levels:
    low, high = -128, 127
    if activation == "relu6":
        low = max(low, result.zero)
        high = min(high, result.zero + round(6.0 / result.scale))
    return np.asarray(np.clip(values + result.zero, low, high), np.int8)
