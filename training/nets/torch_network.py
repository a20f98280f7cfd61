"""A network of `features.net.network` nodes as a torch module, for training. Needs torch."""

from collections.abc import Mapping, Sequence

from torch import Tensor, nn
from torch.nn import functional

from lightgesture.features.net.network import Node, Shape, infer_shapes, same_padding


class TorchNetwork(nn.Module):
    """The same layers in floating point, pictures as (n, channels, h, w).

    Convolutions and dense layers are followed by batch normalisation, which is folded into them when the network is
    made integer; those that are outputs have a bias instead.
    """

    def __init__(self, inputs: Mapping[str, Shape], nodes: Sequence[Node], outputs: Sequence[str]) -> None:
        super().__init__()
        self.inputs, self.nodes, self.outputs = dict(inputs), tuple(nodes), tuple(outputs)
        shapes = infer_shapes(inputs, nodes)
        self.layers = nn.ModuleDict()
        self.norms = nn.ModuleDict()
        for node in self.nodes:
            layer = _layer(node, shapes[node.inputs[0]], has_bias=node.name in outputs)
            if layer is not None:
                self.layers[node.name] = layer
                if node.name not in outputs:
                    self.norms[node.name] = _norm(node, shapes[node.name][2])

    def forward(self, inputs: Mapping[str, Tensor]) -> dict[str, Tensor]:
        """Outputs by name: (n, channels, h, w), of dense layers (n, channels)."""
        tensors = self.all_tensors(inputs)
        return {name: tensors[name] for name in self.outputs}

    def all_tensors(self, inputs: Mapping[str, Tensor]) -> dict[str, Tensor]:
        """Inputs and what every node gives, by name."""
        tensors = dict(inputs)
        for node in self.nodes:
            tensors[node.name] = self.compute(node, [tensors[name] for name in node.inputs])
        return tensors

    def compute(self, node: Node, sources: list[Tensor]) -> Tensor:
        """What a node gives for what it takes."""
        if node.op == "upsample":
            return functional.interpolate(sources[0], scale_factor=2.0, mode="nearest")
        values = sources[0] + sources[1] if node.op == "add" else self.weighted(node, sources[0])
        if node.name in self.norms:
            values = self.norms[node.name](values)
        return functional.relu6(values) if node.activation == "relu6" else values

    def weighted(self, node: Node, source: Tensor) -> Tensor:
        """What a node's weights make of its input, before normalisation and activation."""
        if node.op != "dense":
            values: Tensor = self.layers[node.name](_padded(source, node))
            return values
        if source.ndim == 4:
            # The board keeps channels last, and so do the weights of a dense layer.
            source = source.permute(0, 2, 3, 1).flatten(1)
        flat: Tensor = self.layers[node.name](source)
        return flat


def _padded(values: Tensor, node: Node) -> Tensor:
    height, width = values.shape[2:]
    above, below = same_padding(height, node.kernel, node.stride)
    before, after = same_padding(width, node.kernel, node.stride)
    return functional.pad(values, (before, after, above, below)) if node.kernel > 1 else values


def _layer(node: Node, source: Shape, has_bias: bool) -> nn.Module | None:
    if node.op == "conv":
        return nn.Conv2d(source[2], node.channels, node.kernel, node.stride, bias=has_bias)
    if node.op == "depthwise":
        channels = source[2]
        return nn.Conv2d(channels, channels, node.kernel, node.stride, groups=channels, bias=has_bias)
    if node.op == "dense":
        return nn.Linear(source[0] * source[1] * source[2], node.channels, bias=has_bias)
    return None


def _norm(node: Node, channels: int) -> nn.Module:
    return nn.BatchNorm1d(channels) if node.op == "dense" else nn.BatchNorm2d(channels)
