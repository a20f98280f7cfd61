"""A net that goes on learning from the integers of a trained one. Needs torch."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import torch
from torch import Tensor, nn

from lightgesture.errors import UsageError
from lightgesture.features.net.network import IntegerNetwork, Node
from lightgesture.training.nets.torch_network import TorchNetwork

STARTED: Final = 0.4
"""Share of the usual rate at which a net goes on that has learnt already."""


def start_from(
    module: TorchNetwork, network: IntegerNetwork, batch: Mapping[str, Tensor], *, but_the_last: bool = False
) -> None:
    """Give the module the weights of a network of the same layers, changed in place; strides and the size of pictures
    may be others, since what edges and fingers look like changes little with them.

    but_the_last: the last layer is another one and stays as it is, for a net that is to answer another question.

    batch: typical inputs. The integers hold no batch normalisation; each is set to what it would be if it changed
    nothing on this batch, so that the net begins where the other one ended. Raises UsageError for other layers.
    """
    nodes, others = module.nodes, network.nodes
    if but_the_last:
        nodes, others = nodes[:-1], others[:-1]
    if _layers(nodes) != _layers(others) or not _same_shapes(module, network, nodes):
        raise UsageError("the file to start from holds a net of other layers; start from one of this version")
    tensors = dict(batch)
    with torch.no_grad():
        for node in nodes:
            if node.name in module.layers:
                _load(module, network, node)
            if node.name in module.norms:
                _set_norm(module, network, node, tensors)
            tensors[node.name] = module.compute(node, [tensors[name] for name in node.inputs])


def _layers(nodes: Sequence[Node]) -> list[Node]:
    """The nodes without their strides."""
    return [replace(node, stride=1) for node in nodes]


def _same_shapes(module: TorchNetwork, network: IntegerNetwork, nodes: Sequence[Node]) -> bool:
    """Whether each of the nodes has as many weights in the module as in the network."""
    layers = {node.name: module.layers[node.name] for node in nodes if node.name in module.layers}
    return all(
        isinstance(layer, nn.Conv2d | nn.Linear)
        and layer.weight.numel() == network.weights[name].weights.size
        for name, layer in layers.items()
    )


def _load(module: TorchNetwork, network: IntegerNetwork, node: Node) -> None:
    layer = module.layers[node.name]
    assert isinstance(layer, nn.Conv2d | nn.Linear)
    own = network.weights[node.name]
    shape = [1] * own.weights.ndim
    shape[3 if node.op == "depthwise" else 0] = -1
    values = torch.from_numpy(own.weights.astype(np.float32) * own.scales.reshape(shape))
    if node.op == "conv":
        values = values.permute(0, 3, 1, 2)
    elif node.op == "depthwise":
        values = values.permute(3, 0, 1, 2)
    layer.weight.copy_(values)
    if layer.bias is not None:
        layer.bias.copy_(_biases(network, node))


def _biases(network: IntegerNetwork, node: Node) -> Tensor:
    own = network.weights[node.name]
    scale = network.quantisation[node.inputs[0]].scale
    return torch.from_numpy((own.biases * own.scales.astype(np.float64) * scale).astype(np.float32))


def _set_norm(
    module: TorchNetwork, network: IntegerNetwork, node: Node, tensors: Mapping[str, Tensor]
) -> None:
    norm = module.norms[node.name]
    assert isinstance(norm, nn.BatchNorm1d | nn.BatchNorm2d)
    values = module.weighted(node, tensors[node.inputs[0]])
    axes = [0, *range(2, values.ndim)]
    mean, variance = values.mean(dim=axes), values.var(dim=axes, unbiased=False)
    assert norm.running_mean is not None
    assert norm.running_var is not None
    norm.running_mean.copy_(mean)
    norm.running_var.copy_(variance)
    norm.weight.copy_(torch.sqrt(variance + norm.eps))
    norm.bias.copy_(_biases(network, node) + mean)
