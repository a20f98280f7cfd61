"""The convolutional network of the paper, in floating point, trained on our patches. Needs torch.

Islam, Ho and Sattar, "Dynamic Reconfiguration of Mission Parameters in Underwater Human-Robot Collaboration", ICRA
2018: patches of 32 × 32 × 3, two convolutions with max pooling and normalisation, fully connected layers, a soft-max.
The widths below are ours, common ones of that time. It sees colours from 0 to 1, and is trained by Adam on single
labels.
"""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn
from torch.nn import functional

from lightgesture.features.patch import PatchSettings, cut_patches
from lightgesture.features.types import Box
from lightgesture.training.pool.patch_pool import PatchPool
from lightgesture.training.svm.machine import sample_weights

Float = NDArray[np.float32]


MAPS: Final = (32, 64)
"""Of the two convolutions."""

WHOLE: Final = 256
"""Units of the dense layer between them and the classes."""

KERNEL: Final = 5
"""Side of the convolutions, pixels."""

BATCH: Final = 128
"""Patches a step of the optimiser."""

RATE: Final = 1e-3
"""Of the optimiser."""


def make_paper_net(classes: int, size: int, seed: int) -> nn.Sequential:
    """The layers with random weights, for patches of `size` pixels, (n, 3, size, size) -> scores (n, classes)."""
    torch.manual_seed(seed)
    first, second = MAPS
    layers = []
    for inputs, outputs in ((3, first), (first, second)):
        convolution = nn.Conv2d(inputs, outputs, KERNEL, padding="same")
        layers += [convolution, nn.ReLU(), nn.MaxPool2d(2), nn.LocalResponseNorm(4)]
    dense = nn.Linear(second * (size // 4) ** 2, WHOLE)
    return nn.Sequential(*layers, nn.Flatten(), dense, nn.ReLU(), nn.Linear(WHOLE, classes))


def train_paper_net(
    pool: PatchPool,
    margin: int,
    classes: Sequence[str],
    steps: int,
    seed: int,
    progress: Callable[[str], None],
) -> nn.Sequential:
    """A net trained on the middle of every patch of a pool, sources and classes weighted as for the other models."""
    number = {name: index for index, name in enumerate(classes)}
    truth = np.array([number[name] for name in pool.tokens], np.int64)
    weights = sample_weights(truth, pool.sources).astype(np.float64)
    cumulative = np.cumsum(weights) / weights.sum()
    size = pool.patches.shape[1] - 2 * margin
    inner = slice(margin, margin + size)
    random = np.random.default_rng(seed)
    net = make_paper_net(len(classes), size, seed)
    optimiser = torch.optim.Adam(net.parameters(), RATE)
    for step in range(1, steps + 1):
        rows = np.minimum(np.searchsorted(cumulative, random.random(BATCH)), len(truth) - 1)
        patches = np.stack([pool.patches[row, inner, inner] for row in rows])
        loss = functional.cross_entropy(net(as_inputs(patches)), torch.from_numpy(truth[rows]))
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        if step % 500 == 0 or step == steps:
            progress(f"paper's net: step {step} of {steps}, loss {float(loss.detach()):.3f}")
    return net.eval()


def as_inputs(patches: NDArray[np.uint8]) -> torch.Tensor:
    """Patches, uint8 (n, size, size, 3) -> float32 (n, 3, size, size), 0 to 1."""
    return torch.from_numpy(np.ascontiguousarray(patches)).permute(0, 3, 1, 2).float() / 255.0


class PaperNetClassifier:
    """Reads hands in given boxes with a trained net; its probabilities are not calibrated, as in the paper."""

    def __init__(self, net: nn.Sequential, classes: Sequence[str], patch: PatchSettings) -> None:
        self.classes, self._net, self._patch = tuple(classes), net, patch

    @property
    def weights(self) -> int:
        """Numbers that were learned."""
        return sum(value.numel() for value in self._net.parameters())

    def probabilities(
        self, image_bgr: NDArray[np.uint8], boxes: Sequence[Box], sides: Sequence[str]
    ) -> Float:
        """float32 (number of boxes, number of classes), rows that sum to one."""
        patches = cut_patches(image_bgr, boxes, sides, self._patch)
        with torch.no_grad():
            return np.asarray(torch.softmax(self._net(as_inputs(patches)), dim=1).numpy(), np.float32)
