"""Training of the refiner. Needs torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

import torch
from torch import Tensor
from torch.nn import functional

from lightgesture.features.find.refiner import BOX, HAND, INPUT
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.nets.architectures import REFINER_INPUT, REFINER_OUTPUTS, refiner_nodes
from lightgesture.training.nets.net_training import LoopSettings, Precision, giou
from lightgesture.training.nets.region_nets import (
    hand_loss,
    train_region_net,
    typical_inputs,
    window_batches,
)
from lightgesture.training.nets.started import STARTED, start_from
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.nets.window_samples import WindowSamples

PICTURES = 32
"""Of one batch."""
RATE = 2e-3
LEAST_SIDE = 0.02
"""Of a box in window sides, so that the overlap always has a slope."""


def train_refiner(
    samples: WindowSamples,
    steps: int,
    precision: Precision,
    start: IntegerNetwork | None,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
) -> IntegerNetwork:
    """The trained net in integers. start: a net to go on from, None to begin with random weights."""
    torch.manual_seed(seed)
    net = TorchNetwork({INPUT: REFINER_INPUT}, refiner_nodes(), REFINER_OUTPUTS)

    batch = window_batches(samples, INPUT, PICTURES)
    if start is not None:
        start_from(net, start, typical_inputs(batch, seed, steps))
    rate = RATE if start is None else STARTED * RATE
    loop = LoopSettings(steps, rate, warm_up=200, mean=0.998, precision=precision)
    return train_region_net(net, batch, refiner_loss, loop, seed, checkpoint, progress)


def refiner_loss(outputs: Mapping[str, Tensor], truth: tuple[Tensor, ...]) -> Tensor:
    """Cross-entropy of hand or not, GIoU and smoothed distance of the boxes of hands."""
    (targets,) = truth
    loss, hand = hand_loss(outputs[HAND][:, 0], targets), targets[:, 0]
    if not bool((hand > 0).any()):
        return loss
    own, wanted = outputs[BOX][hand > 0], targets[hand > 0, 1:5]
    corners = torch.cat([own[:, :2], torch.maximum(own[:, 2:], own[:, :2] + LEAST_SIDE)], dim=1)
    return loss + (1 - giou(corners, wanted)).mean() + functional.smooth_l1_loss(own * 8, wanted * 8)
