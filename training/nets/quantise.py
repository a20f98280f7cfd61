"""A trained network made integer: batch normalisation folded, ranges measured, weights rounded. Needs torch."""

from collections.abc import Iterable, Mapping

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from lightgesture.features.net.file import LARGEST_WEIGHT, check_network
from lightgesture.features.net.flatbuffer import with_litert
from lightgesture.features.net.network import IntegerNetwork, Node, Quantisation, Weights
from lightgesture.training.nets.torch_network import TorchNetwork

Range = tuple[float, float]

STANDARD_RANGE = (-3.0, 3.0)
"""Of the standardised values of pictures, patches and outlines."""
CALIBRATION = 12
"""Batches from which the range of each tensor is measured."""
LEAST_SCALE = 1e-8
"""Of the weights of a channel that training has emptied."""


def quantise(
    module: TorchNetwork, batches: Iterable[Mapping[str, Tensor]], inputs: Mapping[str, Range]
) -> IntegerNetwork:
    """The network in integers, with its `.tflite` file.

    batches: typical inputs, from which the range of every tensor is measured. inputs: the range of each input,
    which is known. Every range is widened to hold 0, which is what padding stands for.
    """
    module.eval()
    ranges: dict[str, Range] = dict(inputs)
    with torch.no_grad():
        for batch in batches:
            tensors = module.all_tensors(batch)
            for node in module.nodes:
                low, high = ranges.get(node.name, (0.0, 0.0))
                values = tensors[node.name]
                ranges[node.name] = min(low, float(values.min())), max(high, float(values.max()))
    scales = {name: _quantisation(*limits) for name, limits in ranges.items()}
    weights = {}
    for node in module.nodes:
        if node.op == "upsample":
            scales[node.name] = scales[node.inputs[0]]
        elif node.name in module.layers:
            weights[node.name] = _weights(module, node, scales[node.inputs[0]].scale)
    network = IntegerNetwork(module.inputs, module.nodes, module.outputs, weights, scales)
    check_network(network)
    return with_litert(network)


def _quantisation(low: float, high: float) -> Quantisation:
    scale = float(np.float32(max((high - low) / 255.0, LEAST_SCALE)))
    return Quantisation(scale, int(np.clip(round(-128 - low / scale), -128, 127)))


def folded(module: TorchNetwork, node: Node) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Weights (in the layout of `features.net.network.Weights`) and biases with the batch normalisation in them."""
    layer = module.layers[node.name]
    assert isinstance(layer, nn.Conv2d | nn.Linear)
    weights = layer.weight.detach()
    biases = layer.bias.detach() if layer.bias is not None else torch.zeros(len(weights))
    if node.name in module.norms:
        norm = module.norms[node.name]
        assert isinstance(norm, nn.BatchNorm1d | nn.BatchNorm2d)
        assert norm.running_mean is not None
        assert norm.running_var is not None
        gain = norm.weight.detach() / torch.sqrt(norm.running_var + norm.eps)
        weights = weights * gain.reshape(-1, *[1] * (weights.ndim - 1))
        biases = (biases - norm.running_mean) * gain + norm.bias.detach()
    if node.op == "conv":
        weights = weights.permute(0, 2, 3, 1)
    elif node.op == "depthwise":
        weights = weights.permute(1, 2, 3, 0)
    return weights.contiguous().numpy(), biases.numpy()


def _weights(module: TorchNetwork, node: Node, input_scale: float) -> Weights:
    values, biases = folded(module, node)
    axis = 3 if node.op == "depthwise" else 0
    others = tuple(index for index in range(values.ndim) if index != axis)
    scales = np.maximum(np.abs(values).max(axis=others) / LARGEST_WEIGHT, LEAST_SCALE).astype(np.float32)
    shape = [1] * values.ndim
    shape[axis] = -1
    levels = np.clip(np.rint(values / scales.reshape(shape)), -LARGEST_WEIGHT, LARGEST_WEIGHT).astype(np.int8)
    limit = np.iinfo(np.int32)
    wide = np.rint(biases.astype(np.float64) / (scales.astype(np.float64) * input_scale))
    return Weights(levels, np.clip(wide, limit.min, limit.max).astype(np.int32), scales)
