"""Training of the verifier. Needs torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

import torch
from torch import Tensor

from lightgesture.features.find.verifier import HAND, INPUT
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.nets.architectures import VERIFIER_INPUT, VERIFIER_OUTPUTS, verifier_nodes
from lightgesture.training.nets.net_training import LoopSettings, Precision
from lightgesture.training.nets.region_nets import (
    hand_loss,
    train_region_net,
    typical_inputs,
    window_batches,
)
from lightgesture.training.nets.started import start_from
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.nets.window_samples import WindowSamples

PICTURES = 16
"""Of one batch."""
RATE = 1e-3
"""Of a net that has learnt already."""


def train_verifier(
    samples: WindowSamples,
    steps: int,
    precision: Precision,
    start: IntegerNetwork,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
) -> IntegerNetwork:
    """The trained net in integers. start: a larger net that reads hands, from whose weights it goes on. Raises
    UsageError for a net of other layers."""
    torch.manual_seed(seed)
    net = TorchNetwork({INPUT: VERIFIER_INPUT}, verifier_nodes(), VERIFIER_OUTPUTS)

    batch = window_batches(samples, INPUT, PICTURES)
    start_from(net, start, typical_inputs(batch, seed, steps), but_the_last=True)
    loop = LoopSettings(steps, RATE, warm_up=200, mean=0.998, precision=precision)
    return train_region_net(net, batch, verifier_loss, loop, seed, checkpoint, progress)


def verifier_loss(outputs: Mapping[str, Tensor], truth: tuple[Tensor, ...]) -> Tensor:
    """Cross-entropy of hand or not."""
    (targets,) = truth
    return hand_loss(outputs[HAND][:, 0], targets)
