"""What changes a net's weights at each step: AdamW, for its matrices Muon if wanted. Needs torch."""

from typing import Any

import torch
from torch import Tensor, nn

from lightgesture.training.nets.torch_network import TorchNetwork

MOMENTUM = 0.95
"""Of Muon; what its author found to suit nets of every size."""


class NetOptimiser:
    """AdamW for all weights, or for those that are no matrix of a layer within the net, and Muon for these.

    Muon (Jordan et al., "Muon: An optimizer for hidden layers in neural networks", 2024) makes every step's matrix
    orthogonal, so that no few directions rule it. A convolution is the matrix of its output channels by the pixels and
    channels that each sees. Layers that give an output and depthwise ones, whose rows have nothing to do with each
    other, stay with AdamW.
    """

    def __init__(self, net: TorchNetwork, rate: float, matrix_rate: float, decay: float) -> None:
        """rate: highest, of AdamW. matrix_rate: highest, of Muon, 0 for AdamW alone. decay: of weights, not of biases.

        The net must be in channels-last order and keep its storage from now on: Muon sees it as matrices in place.
        """
        inner = _matrices(net) if matrix_rate else []
        known = {id(weights) for weights in inner}
        others = [weights for weights in net.parameters() if id(weights) not in known]
        groups = [
            {"params": [weights for weights in others if weights.ndim > 1], "weight_decay": decay},
            {"params": [weights for weights in others if weights.ndim <= 1], "weight_decay": 0.0},
        ]
        self._inner = inner
        self._flat = [nn.Parameter(_rows(weights.data).view(len(weights), -1)) for weights in inner]
        self._rated: list[tuple[torch.optim.Optimizer, float]] = [(torch.optim.AdamW(groups, rate), rate)]
        if inner:
            muon = torch.optim.Muon(self._flat, lr=matrix_rate, weight_decay=decay, momentum=MOMENTUM)
            self._rated.append((muon, matrix_rate))

    def step(self, share: float) -> None:
        """Change the weights by their gradients, at a share of the highest rates, and forget the gradients."""
        for flat, weights in zip(self._flat, self._inner, strict=True):
            if weights.grad is not None:
                flat.grad = _rows(weights.grad).reshape(len(weights), -1)
            weights.grad = None
        for optimiser, rate in self._rated:
            for group in optimiser.param_groups:
                group["lr"] = rate * share
            optimiser.step()
            optimiser.zero_grad()

    def state_dict(self) -> dict[str, Any]:
        """What `load_state_dict` needs to go on as if never interrupted."""
        return {str(number): own.state_dict() for number, (own, _) in enumerate(self._rated)}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Go on from there."""
        for number, (own, _) in enumerate(self._rated):
            own.load_state_dict(state[str(number)])


def _matrices(net: TorchNetwork) -> list[Tensor]:
    inner = [node.name for node in net.nodes if node.op in ("conv", "dense") and node.name not in net.outputs]
    return [weights for name in inner if isinstance(weights := net.layers[name].weight, Tensor)]


def _rows(weights: Tensor) -> Tensor:
    """Weights or gradients, the output channels first, then in the order in which channels-last memory keeps them."""
    return weights.permute(0, 2, 3, 1) if weights.ndim == 4 else weights
