"""The loop that trains a net: a cosine of the rate, a running mean of the weights, checkpoints. Needs torch."""

import copy
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

import numpy as np
import torch
from torch import Tensor

from lightgesture.results.atomic import replacing
from lightgesture.training.nets.optimisers import NetOptimiser
from lightgesture.training.nets.torch_network import TorchNetwork
from lightgesture.training.time_left import Pace

Batch = tuple[Mapping[str, Tensor], tuple[Tensor, ...]]
"""Inputs of the net and what the loss compares with."""
Precision = Literal["float32", "bfloat16"]
PRECISIONS: tuple[Precision, ...] = get_args(Precision)
"""In which a net is reckoned while it learns; its weights are kept in float32. bfloat16 takes two thirds of the time
on processors with instructions for it and several times as long on others."""


DECAY = 0.02
"""Of weights, a step, over the rate."""
LARGEST_GRADIENT = 5.0
"""Norm to which a step's gradient is cut."""
SAVE_EVERY = 500
"""Steps between checkpoints."""


@dataclass(frozen=True, slots=True)
class LoopSettings:
    """How a net learns."""

    steps: int
    """Of the optimiser."""
    rate: float
    """Highest learning rate."""
    matrix_rate: float = 0.0
    """That of the matrices of layers within the net, see `optimisers`; 0 where all learn alike."""
    warm_up: int = 300
    """Steps until the rates are reached."""
    mean: float = 0.999
    """Share of the running mean of the weights that each step keeps."""
    precision: Precision = "float32"
    """In which the net is reckoned, see `PRECISIONS`."""


def train_net(
    net: TorchNetwork,
    batch: Callable[[np.random.Generator], Batch],
    loss: Callable[[Mapping[str, Tensor], tuple[Tensor, ...]], Tensor],
    settings: LoopSettings,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
    stopping: threading.Event | None = None,
) -> TorchNetwork:
    """The running mean of the trained net; goes on at `checkpoint` where there is one.

    Step `n` draws its batch from (seed, n) alone, so that an interrupted training gives what a whole one gives.
    stopping: is set where another thread wants no more of it; KeyboardInterrupt is raised then.
    """
    # The order in memory that the system's convolutions of few channels are quickest in.
    net = net.to(memory_format=torch.channels_last)
    mean = copy.deepcopy(net)
    optimiser = NetOptimiser(net, settings.rate, settings.matrix_rate, DECAY)
    first = _resume(checkpoint, net, mean, optimiser)
    pace = Pace(settings.steps, first)
    net.train()
    for step, (inputs, truth) in _ahead(batch, first, settings.steps, seed):
        if stopping is not None and stopping.is_set():
            raise KeyboardInterrupt
        value = loss(net_outputs(net, inputs, settings.precision), truth)
        value.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(net.parameters(), LARGEST_GRADIENT)
        optimiser.step(_share_of_rate(step, settings))
        _average(mean, net, min(settings.mean, (step + 1) / (step + 10)))
        if (left := pace.line(step + 1)) is not None:
            loss_now = f"loss {float(value.detach()):.3f}"
            progress(f"{checkpoint.stem}: step {step + 1} of {settings.steps}, {loss_now}, {left}")
        if (step + 1) % SAVE_EVERY == 0 or step + 1 == settings.steps:
            state = {"net": net.state_dict(), "mean": mean.state_dict(), "optimiser": optimiser.state_dict()}
            with replacing(checkpoint) as temporary:
                torch.save({**state, "step": step + 1}, temporary)
    return mean.eval()


def net_outputs(net: TorchNetwork, inputs: Mapping[str, Tensor], precision: Precision) -> dict[str, Tensor]:
    """The net's outputs, reckoned in the given precision, in float32."""
    if precision == "float32":
        return net(inputs)  # type: ignore[no-any-return]
    with torch.autocast("cpu", dtype=torch.bfloat16):
        outputs = net(inputs)
    return {name: value.float() for name, value in outputs.items()}


def _ahead(
    batch: Callable[[np.random.Generator], Batch], first: int, steps: int, seed: int
) -> Iterator[tuple[int, Batch]]:
    """Steps and their batches; the next one is drawn while the net learns from the last."""
    with ThreadPoolExecutor(1) as pool:
        coming = pool.submit(batch, np.random.default_rng((seed, first)))
        for step in range(first, steps):
            drawn = coming.result()
            if step + 1 < steps:
                coming = pool.submit(batch, np.random.default_rng((seed, step + 1)))
            yield step, drawn


def _share_of_rate(step: int, settings: LoopSettings) -> float:
    cosine = 0.5 * (1.0 + np.cos(np.pi * step / settings.steps))
    return float(min(1.0, (step + 1) / settings.warm_up) * (cosine * 0.98 + 0.02))


def _resume(checkpoint: Path, net: TorchNetwork, mean: TorchNetwork, optimiser: NetOptimiser) -> int:
    if not checkpoint.exists():
        return 0
    state = torch.load(checkpoint, weights_only=True)
    net.load_state_dict(state["net"])
    mean.load_state_dict(state["mean"])
    optimiser.load_state_dict(state["optimiser"])
    return int(state["step"])


def _average(mean: TorchNetwork, net: TorchNetwork, keep: float) -> None:
    with torch.no_grad():
        for own, new in zip(mean.state_dict().values(), net.state_dict().values(), strict=True):
            if own.dtype.is_floating_point:
                own.lerp_(new, 1.0 - keep)
            else:
                own.copy_(new)


def giou(one: Tensor, other: Tensor) -> Tensor:
    """Generalised IoU (Rezatofighi et al., 2019) of corners (n, 4) each: (n,), -1 to 1."""
    low, high = torch.maximum(one[:, :2], other[:, :2]), torch.minimum(one[:, 2:], other[:, 2:])
    inner = (high - low).clamp(min=0).prod(dim=1)
    union = (one[:, 2:] - one[:, :2]).prod(dim=1) + (other[:, 2:] - other[:, :2]).prod(dim=1) - inner
    low, high = torch.minimum(one[:, :2], other[:, :2]), torch.maximum(one[:, 2:], other[:, 2:])
    hull = (high - low).prod(dim=1)
    return inner / union - (hull - union) / hull
