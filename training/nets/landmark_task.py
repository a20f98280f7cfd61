"""The second task of a hand net's training: where the 21 landmarks of the hand lie. Needs torch.

A net that has to say where the fingers are sees a hand's shape and not only what its pictures have in common: cloth,
light, a room (Caruana, "Multitask learning", 1997). The head that says it reads the last map of the net in which
places are told apart. It is dropped before the net is made integer, so that nothing of it reaches the board.
"""

from collections.abc import Sequence

import torch
from torch import Tensor
from torch.nn import functional

from lightgesture.features.net.network import Node
from lightgesture.training.nets.architectures import WHOLE
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.pool.patch_landmarks import COORDINATES

LANDMARKS = "landmarks"
"""Name of the head."""
NEAR = 0.05
"""Sides of a patch, 1.6 pixels: up to there an error counts by its square, beyond it by its size."""


def with_head(nodes: Sequence[Node]) -> tuple[Node, ...]:
    """The nodes of a hand net and one more, which gives the landmarks: float32 (n, 42), x and y of each in turn,
    in sides of the patch from its middle."""
    source = next(node.inputs for node in nodes if node.name == WHOLE)
    return (*nodes, Node(LANDMARKS, "dense", source, COORDINATES))


def without_head(net: TorchNetwork) -> TorchNetwork:
    """The same net, its weights shared, without the head for landmarks, if it has one."""
    if LANDMARKS not in net.outputs:
        return net
    nodes = [node for node in net.nodes if node.name != LANDMARKS]
    bare = TorchNetwork(net.inputs, nodes, [name for name in net.outputs if name != LANDMARKS])
    bare.layers.update({name: layer for name, layer in net.layers.items() if name != LANDMARKS})
    bare.norms.update(dict(net.norms.items()))
    bare.train(net.training)
    return bare


def landmark_loss(told: Tensor, truth: Tensor) -> Tensor:
    """Mean of the smooth L1 loss (Girshick, "Fast R-CNN", 2015) of coordinates, (n, 42) each, in units of `NEAR`.

    What is NaN in the truth is unknown and counts as told rightly.
    """
    known = torch.isfinite(truth)
    wanted = torch.where(known, truth, told.detach())
    return functional.smooth_l1_loss(told / NEAR, wanted / NEAR)
