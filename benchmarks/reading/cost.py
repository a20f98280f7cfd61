"""What reading a hand costs: size of the file, products, time in one thread, memory."""

import json
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import Final

import numpy as np

from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.benchmarks.timing import PEAK_MEMORY, Image, limited_threads
from lightgesture.features.net.runner import Network
from lightgesture.features.types import Box
from lightgesture.features.vector import block_lengths
from lightgesture.models.cnn import CnnClassifier
from lightgesture.models.loading import SHIPPED
from lightgesture.models.svm import SvmClassifier
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.nets.architectures import multiply_adds

NOTE = (
    "multiply_adds: a hand, of the net's layers, or of the SVM's matrix products (pooling of the gradients, "
    "projection,\ndistances, scores); outlines and standardising are in the times only. pair_ms: median processor "
    "time for both hands of a\nframe, from the picture to probabilities, one thread; model_ms: the net or the kernel "
    "machine alone. memory_mb: what a\nfresh process needs at most, more than OpenCV and NumPy, to load the model and "
    "read two hands."
)


CALLS: Final = 400
"""Timed calls, whose median counts; more are steadier."""

WARM_UP: Final = 40
"""Calls before the timed ones."""

STARTS: Final = 3
"""Fresh processes whose memory is measured."""


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """A frame with both hands of a diver, boxes in its pixels."""

    image: Image
    boxes: tuple[Box, Box]
    sides: tuple[str, str] = ("right", "left")


MEMORY = f"""{PEAK_MEMORY}
import json, sys
import cv2, numpy
cv2.setNumThreads(1)
picture = numpy.random.default_rng(0).integers(0, 255, (480, 640, 3), numpy.uint8)
cv2.resize(picture, (32, 32), interpolation=cv2.INTER_AREA)
before = peak_memory()
from lightgesture.models import load_classifier
classifier = load_classifier(sys.argv[1])
classifier.probabilities(picture, [(100, 100, 80, 90), (400, 100, 80, 90)], ["right", "left"])
print(json.dumps([before, peak_memory()]))
"""
"""What a new process runs."""


def cost_table(models: Mapping[str, Classifier], pair: Pair, calls: int = CALLS) -> Table:
    """One row a model; cells are empty where a classifier is of no known kind or the system does not tell."""
    rows = tuple(
        {"model": name, **_row(name, classifier, pair, calls)} for name, classifier in models.items()
    )
    columns = ("model", "file_kb", "weights", "multiply_adds", "pair_ms", "model_ms", "memory_mb")
    return Table("hands_cost", "What reading costs", columns, rows, NOTE)


def _row(name: str, classifier: Classifier, pair: Pair, calls: int) -> dict[str, Cell]:
    file = SHIPPED.get(name, Path(name))
    alone = model_alone(classifier)
    with limited_threads(1):
        whole = time_call(lambda: classifier.probabilities(pair.image, pair.boxes, pair.sides), calls)
        own = time_call(alone, calls) if alone is not None else None
    return {
        "file_kb": file.stat().st_size / 1000 if file.is_file() else None,
        "weights": count_weights(classifier),
        "multiply_adds": count_products(classifier),
        "pair_ms": whole,
        "model_ms": own,
        "memory_mb": added_memory(name) if file.is_file() else None,
    }


def time_call(call: Callable[[], object], calls: int) -> float:
    """Median milliseconds of processor time: in one thread those of a clock, less what others take."""
    times = []
    for number in range(WARM_UP + calls):
        start = process_time()
        call()
        if number >= WARM_UP:
            times.append((process_time() - start) * 1e3)
    return percentile(times, 50)


def model_alone(classifier: Classifier) -> Callable[[], object] | None:
    """A call of the net or the kernel machine with two hands, their features given; None for another kind."""
    if isinstance(classifier, CnnClassifier):
        net = classifier.model.network
        network = Network(net)
        inputs = {name: np.zeros((2, *shape), np.int8) for name, shape in net.inputs.items()}
        return lambda: network.run(inputs)
    if isinstance(classifier, SvmClassifier):
        machine, vectors = classifier, np.tile(classifier.model.mean, (2, 1))
        return lambda: machine.scores(vectors)
    return None


def count_weights(classifier: Classifier) -> int | None:
    """Numbers that were learned, None for another kind."""
    if isinstance(classifier, CnnClassifier):
        parts = classifier.model.network.weights.values()
        return sum(own.weights.size + own.biases.size for own in parts)
    if isinstance(classifier, SvmClassifier):
        model = classifier.model
        arrays = (model.mean, model.projection, model.centres, model.weights, model.bias)
        return sum(array.size for array in arrays)
    return None


def count_products(classifier: Classifier) -> int | None:
    """Multiply-adds for one hand, None for another kind; see the note of the table."""
    if isinstance(classifier, CnnClassifier):
        net = classifier.model.network
        return multiply_adds(net.inputs, net.nodes)
    return kernel_products(classifier.model) if isinstance(classifier, SvmClassifier) else None


def kernel_products(model: SvmModel) -> int:
    """Multiply-adds of the SVM's matrix products for one patch.

    The votes of each direction of the gradients within the rim, (size, size), are pooled to cells along both sides; the
    vector is projected; distances to the centres and the scores of the classes follow.
    """
    hog = model.features.hog
    size = model.features.patch.size - 2 * hog.rim
    cells = size // hog.cell
    pooling = hog.bins * (cells * size * size + cells * cells * size)
    length, width = sum(block_lengths(model.features)), model.projection.shape[1]
    count, classes = model.weights.shape
    return int(pooling + length * width + count * width + count * classes)


def added_memory(model: str) -> float | None:
    """Median of what some fresh processes need (MB of 1,048,576 bytes); None where the system does not tell.

    Raises subprocess.CalledProcessError where one fails.
    """
    command = [sys.executable, "-c", MEMORY, model]
    added = []
    for _ in range(STARTS):
        answer = subprocess.run(command, check=True, capture_output=True, text=True)
        before, after = json.loads(answer.stdout.splitlines()[-1])
        if before is not None:
            added.append(after - before)
    return percentile(added, 50) if added else None
