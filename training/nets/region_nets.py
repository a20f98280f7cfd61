"""What the nets that find hands share of their training. Needs torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.nets.net_training import Batch, LoopSettings, train_net
from lightgesture.training.nets.quantise import CALIBRATION, STANDARD_RANGE, quantise
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.nets.window_samples import WindowSamples

Draw = Callable[[np.random.Generator], Batch]


def train_region_net(
    net: TorchNetwork,
    batch: Draw,
    loss: Callable[[Mapping[str, Tensor], tuple[Tensor, ...]], Tensor],
    settings: LoopSettings,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
) -> IntegerNetwork:
    """The net that `train_net` gives, in integers. Batches after its last step say how far each tensor reaches."""
    trained = train_net(net, batch, loss, settings, seed, checkpoint, progress)
    later = (batch(np.random.default_rng((seed, settings.steps + 1, i)))[0] for i in range(CALIBRATION))
    return quantise(trained, later, dict.fromkeys(net.inputs, STANDARD_RANGE))


def typical_inputs(batch: Draw, seed: int, steps: int) -> Mapping[str, Tensor]:
    """Inputs that no step of so many learns from, for a net that goes on from another one."""
    return batch(np.random.default_rng((seed, steps)))[0]


def window_batches(samples: WindowSamples, name: str, pictures: int) -> Draw:
    """Draws the windows of so many pictures, for a net whose input has this name, and their targets."""

    def batch(rng: np.random.Generator) -> Batch:
        windows, targets = zip(*(samples.draw(rng) for _ in range(pictures)), strict=True)
        seen = torch.from_numpy(np.concatenate(windows)).permute(0, 3, 1, 2)
        return {name: seen}, (torch.from_numpy(np.concatenate(targets)),)

    return batch


def hand_loss(logits: Tensor, targets: Tensor) -> Tensor:
    """Cross-entropy of hand or not. logits: (n,). targets: (n, 6) of `window_samples`."""
    weight, hand = targets[:, 5], targets[:, 0]
    each = functional.binary_cross_entropy_with_logits(logits, hand * 0.98 + 0.01, reduction="none")
    return (each * weight).sum() / weight.sum().clamp(min=1)
