"""Larger nets whose answers a hand net learns from, kept in a file so that each is asked once. Needs torch.

A teacher is asked about a patch without the shifts and the covered parts that the hand net sees it with: asking it
anew at every step would take longer than the step itself.
"""

import threading
from collections.abc import Callable
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray

from lightgesture.errors import UsageError
from lightgesture.models.cnn import PATCH, SCORES
from lightgesture.results.atomic import replacing
from lightgesture.training.nets.architectures import teacher_nodes
from lightgesture.training.nets.hand_net import NetSettings, make_net, tells_landmarks, train_hand_net
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.nets.net_training import net_outputs
from lightgesture.training.nets.torch_network import TorchNetwork

Answers = NDArray[np.float16]
ASKED_AT_ONCE = 256


def teach(
    samples: HandSamples,
    count: int,
    settings: NetSettings,
    seed: int,
    jobs: int,
    folder: Path,
    progress: Callable[[str], None],
) -> Answers:
    """Mean scores of `count` nets for every chosen row, (rows, classes); what is in `folder` already is used.

    The nets differ in their first weights and in what they draw. jobs: of them that learn at a time, a thread each.
    """
    path = folder / "answers.npy"
    if not path.exists():
        # Weights are drawn from one generator of the process, so before the threads begin.
        nets = [_teacher_net(samples, settings, seed + number) for number in range(count)]

        stopping = threading.Event()

        def taught_answers(number: int) -> NDArray[np.float32]:
            checkpoint = folder / f"teacher{number + 1}.pt"
            net = train_hand_net(
                nets[number], samples, None, settings, seed + number, checkpoint, progress, stopping
            )
            return answers_of(net, samples, settings)

        with ThreadPoolExecutor(max(1, min(jobs, count))) as pool:
            learning = [pool.submit(taught_answers, number) for number in range(count)]
            try:
                for one in wait(learning, return_when=FIRST_EXCEPTION).done:
                    one.result()
            finally:
                # Ctrl-C reaches this thread alone, and a failure one other; else the rest would learn to the end.
                stopping.set()
        total = sum((one.result() for one in learning), np.zeros((len(samples), len(samples.classes))))
        with replacing(path) as temporary, temporary.open("wb") as stream:
            np.save(stream, (total / count).astype(np.float16))
    answers = np.asarray(np.load(path), np.float16)
    if answers.shape != (len(samples), len(samples.classes)):
        raise UsageError(
            f"{path}: holds answers about other patches; remove it and run the same command again"
        )
    return answers


def teacher(
    samples: HandSamples, settings: NetSettings, seed: int, folder: Path, progress: Callable[[str], None]
) -> TorchNetwork:
    """The first of the nets that teach, from `folder`, where `teach` left it, or trained on."""
    net = _teacher_net(samples, settings, seed)
    return train_hand_net(net, samples, None, settings, seed, folder / "teacher1.pt", progress)


def _teacher_net(samples: HandSamples, settings: NetSettings, seed: int) -> TorchNetwork:
    nodes, learnt = teacher_nodes(len(samples.classes)), tells_landmarks(samples, settings)
    return make_net(nodes, samples.size, 0, seed, landmarks=learnt)


def answers_of(net: TorchNetwork, samples: HandSamples, settings: NetSettings) -> NDArray[np.float32]:
    """A net's scores for every chosen row, (rows, classes)."""
    torch.set_num_threads(1)
    parts = []
    for first in range(0, len(samples), ASKED_AT_ONCE):
        patches = torch.from_numpy(samples.middles(first, first + ASKED_AT_ONCE)).permute(0, 3, 1, 2)
        with torch.no_grad():
            parts.append(net_outputs(net, {PATCH: patches}, settings.precision)[SCORES].numpy())
    return np.concatenate(parts)
