"""Training of a hand net on a pool of patches, if wanted from larger nets' answers too. Needs torch."""

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.nn import functional

from lightgesture.features.net.network import IntegerNetwork, Node, Shape
from lightgesture.features.outline.contours import ContourSettings, contour_vectors
from lightgesture.features.types import Float
from lightgesture.models.cnn import CONTOUR, PATCH, SCORES
from lightgesture.training.nets.hand_samples import HandBatch, HandSamples, standardised
from lightgesture.training.nets.landmark_task import LANDMARKS, landmark_loss, with_head, without_head
from lightgesture.training.nets.net_training import Batch, LoopSettings, Precision, train_net
from lightgesture.training.nets.quantise import CALIBRATION, STANDARD_RANGE, quantise
from lightgesture.training.nets.torch_network import TorchNetwork

BATCH = 128
"""Patches of a step."""
RATE = 3e-3
"""Highest learning rate of what is no matrix within the net."""
MATRIX_RATE = 0.05
"""Highest of the matrices, see `optimisers`."""
LONGEST_WARM_UP = 300
"""Steps in which the rates rise, at most a quarter of all."""
SMOOTHING = 0.05
"""Share of the truth that is spread over all classes, 0 to 0.2, where the labels alone teach."""
SOFTNESS = 2.0
"""Temperature of the teachers' and the net's answers where they are compared."""


@dataclass(frozen=True, slots=True)
class NetSettings:
    """How long and in what a net learns."""

    steps: int
    """Of the optimiser."""
    precision: Precision = "float32"
    """See `net_training.PRECISIONS`."""
    landmarks: float = 0.0
    """Weight of the landmarks beside the classes, 0 to 10; 0: they are not learnt. See `landmark_task`."""


@dataclass(frozen=True, slots=True, eq=False)
class OutlineScale:
    """mean, deviation: float32 (c,), of the outline's numbers; empty for a net without."""

    mean: Float
    deviation: Float

    def apply(self, contours: Float) -> Float:
        """Standardised, float32 (n, c), within the range that the integers hold."""
        values = (contours - self.mean) / self.deviation
        return np.asarray(np.clip(values, *STANDARD_RANGE), np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class LearntNet:
    """net: in floating point. samples: what it learnt from. scale: of the outline's numbers."""

    net: TorchNetwork
    samples: HandSamples
    scale: OutlineScale

    def scores(self, patches: NDArray[np.uint8], contour: ContourSettings) -> Float:
        """Of patches, uint8 (n, size, size, 3), as float32 (n, classes)."""
        seen = HandBatch(standardised(patches), contour_vectors(patches, contour), np.zeros(0, np.int64))
        known = self.scale if CONTOUR in self.net.inputs else None
        with torch.no_grad():
            return np.asarray(self.net(inputs_of(seen, known))[SCORES].numpy(), np.float32)


def make_net(
    nodes: tuple[Node, ...], size: int, contours: int, seed: int, *, landmarks: bool = False
) -> TorchNetwork:
    """A net with random weights for patches of `size` pixels and so many numbers of the outline, if wanted with a head
    for landmarks."""
    torch.manual_seed(seed)
    inputs: dict[str, Shape] = {PATCH: (size, size, 3)}
    if contours:
        inputs[CONTOUR] = (1, 1, contours)
    if landmarks:
        return TorchNetwork(inputs, with_head(nodes), (SCORES, LANDMARKS))
    return TorchNetwork(inputs, nodes, (SCORES,))


def tells_landmarks(samples: HandSamples, settings: NetSettings) -> bool:
    """Whether a net that learns from these samples with these settings has a head for landmarks."""
    return settings.landmarks > 0.0 and samples.has_landmarks


def train_hand_net(
    net: TorchNetwork,
    samples: HandSamples,
    scale: OutlineScale | None,
    settings: NetSettings,
    seed: int,
    checkpoint: Path,
    progress: Callable[[str], None],
    stopping: threading.Event | None = None,
) -> TorchNetwork:
    """The trained net in floating point; goes on at `checkpoint` where there is one. scale: None for a net without
    outline. stopping: see `train_net`.

    It takes one thread: a step of so small a net is no quicker on two, and so no number of cores changes the result.
    """
    torch.set_num_threads(1)

    def batch(rng: np.random.Generator) -> Batch:
        drawn = samples.draw(rng, BATCH)
        inputs = inputs_of(drawn, scale if CONTOUR in net.inputs else None)
        classes = drawn.truth if drawn.answers is None else drawn.answers
        truth = (classes,) if drawn.landmarks is None else (classes, drawn.landmarks)
        return inputs, tuple(torch.from_numpy(values) for values in truth)

    def loss(outputs: Mapping[str, Tensor], truth: tuple[Tensor, ...]) -> Tensor:
        far = class_loss(outputs[SCORES], truth[0])
        if LANDMARKS in outputs:
            far = far + settings.landmarks * landmark_loss(outputs[LANDMARKS], truth[1])
        return far

    warm_up = max(1, min(LONGEST_WARM_UP, settings.steps // 4))
    loop = LoopSettings(settings.steps, RATE, MATRIX_RATE, warm_up=warm_up, precision=settings.precision)
    return train_net(net, batch, loss, loop, seed, checkpoint, progress, stopping)


def class_loss(scores: Tensor, truth: Tensor) -> Tensor:
    """Of scores, (n, classes), against classes, int64 (n,), or what teachers answered, float (n, classes)."""
    if truth.ndim == 1:
        return functional.cross_entropy(scores, truth, label_smoothing=SMOOTHING)
    # Of teachers it learns what they say and nothing else (Hinton, Vinyals and Dean, 2015).
    wanted = torch.softmax(truth / SOFTNESS, dim=1)
    far = functional.kl_div(torch.log_softmax(scores / SOFTNESS, dim=1), wanted, reduction="batchmean")
    return SOFTNESS**2 * far


def to_integers(
    net: TorchNetwork, samples: HandSamples, scale: OutlineScale, settings: NetSettings, seed: int
) -> IntegerNetwork:
    """The net in integers without a head for landmarks, the ranges of its tensors measured on batches of its own
    training."""
    drawn = (
        samples.draw(np.random.default_rng((seed, settings.steps + 1, i)), 128) for i in range(CALIBRATION)
    )
    known = scale if CONTOUR in net.inputs else None
    inputs = (inputs_of(one, known) for one in drawn)
    return quantise(without_head(net), inputs, dict.fromkeys(net.inputs, STANDARD_RANGE))


def inputs_of(batch: HandBatch, scale: OutlineScale | None) -> dict[str, Tensor]:
    """A batch as the net's inputs; scale: None for a net without outline."""
    inputs = {PATCH: torch.from_numpy(batch.patches).permute(0, 3, 1, 2)}
    if scale is not None:
        inputs[CONTOUR] = torch.from_numpy(scale.apply(batch.contours))[:, :, None, None]
    return inputs
