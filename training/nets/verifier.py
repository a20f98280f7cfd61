"""Training of the verifier. Needs torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from lightgesture.features.find.verifier import HAND, INPUT
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.nets.architectures import VERIFIER_INPUT, VERIFIER_OUTPUTS, verifier_nodes
from lightgesture.training.nets.net_training import Batch, LoopSettings, Precision, hand_loss, train_net
from lightgesture.training.nets.quantise import quantise
from lightgesture.training.nets.started import start_from
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.nets.window_samples import WindowSamples

PICTURES = 16
"""Of one batch."""
CALIBRATION = 12
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

    def batch(rng: np.random.Generator) -> Batch:
        windows, targets = zip(*(samples.draw(rng) for _ in range(PICTURES)), strict=True)
        seen = torch.from_numpy(np.concatenate(windows)).permute(0, 3, 1, 2)
        return {INPUT: seen}, (torch.from_numpy(np.concatenate(targets)),)

    start_from(net, start, batch(np.random.default_rng((seed, steps)))[0], but_the_last=True)
    loop = LoopSettings(steps, RATE, warm_up=200, mean=0.998, precision=precision)
    trained = train_net(net, batch, verifier_loss, loop, seed, checkpoint, progress)
    typical = (batch(np.random.default_rng((seed, steps + 1, i)))[0] for i in range(CALIBRATION))
    return quantise(trained, typical, {INPUT: (-3.0, 3.0)})


def verifier_loss(outputs: Mapping[str, Tensor], truth: tuple[Tensor, ...]) -> Tensor:
    """Cross-entropy of hand or not."""
    (targets,) = truth
    return hand_loss(outputs[HAND][:, 0], targets)
