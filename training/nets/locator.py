"""Training of the locator. Needs torch."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from lightgesture.features.find.locator import EDGES, HEAT, INPUT
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.training.nets.architectures import LOCATOR_INPUT, LOCATOR_OUTPUTS, locator_nodes
from lightgesture.training.nets.locator_samples import LocatorSamples
from lightgesture.training.nets.net_training import Batch, LoopSettings, Precision, giou
from lightgesture.training.nets.region_nets import train_region_net, typical_inputs
from lightgesture.training.nets.started import STARTED, start_from
from lightgesture.training.nets.torch_network import TorchNetwork

BATCH = 32
RATE = 2.5e-3


def train_locator(
    samples: LocatorSamples,
    steps: int,
    precision: Precision,
    start: IntegerNetwork | None,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
) -> IntegerNetwork:
    """The trained net in integers. start: a net to go on from, None to begin with random weights."""
    torch.manual_seed(seed)
    net = TorchNetwork({INPUT: LOCATOR_INPUT}, locator_nodes(), LOCATOR_OUTPUTS)
    # Hands are rare: a net that begins by saying so need not unlearn thousands of false peaks first.
    for name, bias, rest in ((HEAT, -4.0, 0.01), (EDGES, 1.0, 0.01)):
        torch.nn.init.constant_(net.layers[name].bias, bias)  # type: ignore[arg-type]
        torch.nn.init.normal_(net.layers[name].weight, 0.0, rest)  # type: ignore[arg-type]

    def batch(rng: np.random.Generator) -> Batch:
        drawn = [samples.draw(rng) for _ in range(BATCH)]
        seen = torch.from_numpy(np.stack([one for one, _ in drawn])).permute(0, 3, 1, 2)
        targets = [one for _, one in drawn]
        maps = ([t.heat for t in targets], [t.weight for t in targets], [t.box for t in targets])
        weights = torch.from_numpy(np.stack([t.box_weight for t in targets]))
        return {INPUT: seen}, (*(torch.from_numpy(np.stack(m)) for m in maps), weights)

    if start is not None:
        start_from(net, start, typical_inputs(batch, seed, steps))
    rate = RATE if start is None else STARTED * RATE
    loop = LoopSettings(steps, rate, precision=precision)
    return train_region_net(net, batch, locator_loss, loop, seed, checkpoint, progress)


def locator_loss(outputs: Mapping[str, Tensor], truth: tuple[Tensor, ...]) -> Tensor:
    """Focal loss of the heat (Zhou et al., 2019), GIoU and smoothed distance of the boxes."""
    heat, weight, box, box_weight = truth
    logits = outputs[HEAT]
    chance, middle = torch.sigmoid(logits), (heat > 0.999).float()
    hit = middle * (1 - chance) ** 2 * functional.logsigmoid(logits)
    miss = (1 - middle) * (1 - heat) ** 4 * chance**2 * functional.logsigmoid(-logits)
    focal = (-(hit + miss) * weight).sum(dim=(0, 2, 3)) / middle.sum(dim=(0, 2, 3)).clamp(min=1)
    inside = box_weight > 0
    own = outputs[EDGES].permute(0, 2, 3, 1)[inside]
    wanted, share = box.permute(0, 2, 3, 1)[inside], box_weight[inside]
    total = share.sum().clamp(min=1)
    signs = torch.tensor([-1.0, -1.0, 1.0, 1.0])
    overlap = ((1 - giou(own.clamp(-2, 6).exp() * signs, wanted * signs)) * share).sum() / total
    distance = functional.smooth_l1_loss(own, wanted.clamp(min=0.5).log(), reduction="none").mean(1)
    return focal[0] + 0.3 * focal[1] + 2 * overlap + 0.5 * (distance * share).sum() / total
