"""Training of the support vector machine from samples; needs no manifest, and NumPy alone.

It starts as a least-squares support vector machine of fixed size (Suykens, Van Gestel, De Brabanter, De Moor and
Vandewalle, "Least Squares Support Vector Machines", 2002, chapter 6): the radial kernel is approximated by its values
at a few vectors drawn from the data (Nyström; Williams and Seeger, NIPS 2001), and there each class against all others
is a ridge regression. From there on its vectors, its projection and its weights are learnt together (`descent`).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float
from lightgesture.features.vector import VectorSettings, block_lengths
from lightgesture.models.calibration import softmax
from lightgesture.models.classes import CLASSES
from lightgesture.models.errors import ModelError
from lightgesture.models.svm import SvmClassifier, radial_kernel
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.pool.kept_sources import LEAST_FITTED, HeldOut, kept_samples
from lightgesture.training.pool.patch_kinds import CONTOUR, PATCH, SMALLEST_HAND
from lightgesture.training.samples import TrainingSample
from lightgesture.training.svm.descent import Machine, descend
from lightgesture.training.svm.projection import ROWS, Described, Progress, describe, fit_projection, in_parts
from lightgesture.training.temperature import fit_temperature

Double = NDArray[np.float64]

DIMENSIONS: Final = 64
"""Of the space of the kernel, beside one for each contour number, 16 to 128; more cost time and size."""
WIDTH: Final = 2.0
"""At first, gamma times the mean squared distance of two samples, 0.5 to 8; larger is a narrower kernel."""
RIDGE: Final = 1e-5
"""At first, weight of the squared norm of the machine against the mean squared error."""
UNFITTED_TEMPERATURE: Final = 0.42
"""Of the softmax where too few hands are kept from the machine to fit it: that of the shipped model."""


@dataclass(frozen=True, slots=True)
class SvmSettings:
    """How the machine is trained."""

    features: VectorSettings = field(default_factory=lambda: VectorSettings(patch=PATCH, contour=CONTOUR))
    """How a patch becomes a vector."""
    directions: int = 256
    """Principal directions of the gradients that the machine learns from, 64 to 512, which cost time in training alone;
    0 leaves the gradients out."""
    centres: int = 2000
    """Expansion vectors, 200 to 4000; more read a little better and cost time and size."""
    steps: int = 40000
    """Of the descent; accuracy grows to some 40,000. 0 leaves the machine as it starts."""


def train_svm(
    samples: Iterable[TrainingSample],
    settings: SvmSettings | None = None,
    *,
    classes: Sequence[str] = CLASSES,
    seed: int = 0,
    progress: Progress | None = None,
) -> tuple[SvmModel, HeldOut]:
    """Train on samples of at least two of `classes`; the answers are for samples of the sources that are kept out.

    Only the principal directions, which know no classes, are those of all samples.
    The same samples, settings and seed give the same model on one machine with one number of threads. Of so few
    samples that none can be kept out there are no answers, and the temperature is `UNFITTED_TEMPERATURE`.
    Raises ModelError for a sample of an unknown class or of an unreadable box and for less than two classes.
    """
    settings = settings or SvmSettings()
    progress = progress or _silent
    data = describe(samples, settings.features, classes, progress)
    if len(np.unique(data.truth)) < 2:
        raise ModelError("the samples hold less than two classes; a classifier needs at least two")
    kept = kept_samples(data.truth, data.sources, data.hands)
    mean, projection = fit_projection(data.vectors, settings.features, settings.directions)
    reduced = np.concatenate(
        [((part - mean) @ projection).astype(np.float16) for part in in_parts(data.vectors)]
    )
    answered = _rows_of(data, kept)
    learnt = _rows_of(replace(data, vectors=reduced), ~kept)
    # The vectors of many samples take most of the memory, and are done with.
    del data, reduced
    weights = sample_weights(learnt.truth, learnt.sources) * learnt.weights
    machine = _start(learnt, weights, len(classes), settings, seed, progress)
    machine = descend(machine, learnt.vectors, learnt.truth, weights, settings.steps, seed, progress)
    model = SvmModel(
        classes=tuple(classes),
        features=settings.features,
        mean=mean,
        # As the file stores them, so that what is scored is what is shipped.
        projection=(projection @ machine.projection).astype(np.float16).astype(np.float32),
        centres=machine.centres.astype(np.float16).astype(np.float32),
        weights=machine.weights,
        bias=machine.bias,
        gamma=1.0,
        temperature=1.0,
        smallest_hand=SMALLEST_HAND,
    )
    return _calibrated(model, answered)


def _silent(_step: str, _done: int, _total: int) -> None:
    pass


def _rows_of(data: Described, chosen: NDArray[np.bool_]) -> Described:
    return Described(
        data.vectors[chosen],
        data.truth[chosen],
        data.sources[chosen],
        data.hands[chosen],
        data.original[chosen],
        data.weights[chosen],
    )


def _start(
    learnt: Described,
    weights: Float,
    classes: int,
    settings: SvmSettings,
    seed: int,
    progress: Progress,
) -> Machine:
    """The machine of fixed size in the first dimensions. learnt: its vectors are reduced."""
    reduced, truth = learnt.vectors, learnt.truth
    contour = block_lengths(settings.features)[1]
    gradients = reduced.shape[1] - contour
    first = np.arange(reduced.shape[1])
    first = first[(first < DIMENSIONS) | (first >= gradients)]
    points = np.concatenate([part[:, first] for part in in_parts(reduced)])
    scale = np.float32(np.sqrt(WIDTH / (2.0 * float(points.var(axis=0).sum()))))
    points *= scale
    random = np.random.default_rng(seed)
    centres = points[np.sort(random.choice(len(points), min(settings.centres, len(points)), replace=False))]
    targets = np.where(truth[:, None] == np.arange(classes), np.float32(1.0), np.float32(-1.0))
    own, bias = fit_fixed_size(points, centres, 1.0, targets, weights, RIDGE, progress)
    projection = np.zeros((reduced.shape[1], len(first)), np.float32)
    projection[first, np.arange(len(first))] = scale
    return Machine(projection, centres, own, bias)


def _calibrated(model: SvmModel, kept: Described) -> tuple[SvmModel, HeldOut]:
    """The model with its temperature, and its answers for what was kept from it.

    The temperature is that of the originals; where these are few that of their altered copies, too.
    """
    classifier = SvmClassifier(model)
    parts = [classifier.scores(part) for part in in_parts(kept.vectors)]
    scores = np.concatenate([np.empty((0, len(model.classes)), np.float32), *parts])
    fitting = kept.original if kept.original.sum() >= LEAST_FITTED else np.ones(len(scores), bool)
    temperature = UNFITTED_TEMPERATURE
    if fitting.sum() >= LEAST_FITTED:
        temperature = fit_temperature(scores[fitting], kept.truth[fitting])
    answers = HeldOut(softmax(scores, temperature), kept.truth, kept.sources, kept.original)
    return replace(model, temperature=temperature), answers


def sample_weights(truth: NDArray[np.int64], sources: NDArray[np.str_]) -> Float:
    """Weight of each sample, float32 (n,), mean 1.

    A source counts by the square root of its samples in a class, and a class by the square root of its sources'
    weight: thousands of pictures of one person teach little more than dozens, yet what is frequent should stay so.
    """
    keys = np.char.add(np.char.add(truth.astype(str), " "), sources)
    _, members, sizes = np.unique(keys, return_inverse=True, return_counts=True)
    weights = 1.0 / np.sqrt(sizes[members.reshape(-1)])
    for label in np.unique(truth):
        weights[truth == label] /= np.sqrt(weights[truth == label].sum())
    return np.asarray(weights / weights.mean(), np.float32)


def kernel_basis(centres: Float, gamma: float) -> Double:
    """Kernel values at the centres times this (m, r) are the features of the machine: K^(-1/2), rank r."""
    values, vectors = np.linalg.eigh(radial_kernel(centres, centres, gamma).astype(np.float64))
    kept = values > 1e-6 * values[-1]
    return np.asarray(vectors[:, kept] / np.sqrt(values[kept]))


def fit_fixed_size(
    points: Float,
    centres: Float,
    gamma: float,
    targets: Float,
    sample_weights: Float,
    ridge: float,
    progress: Progress,
) -> tuple[Float, Float]:
    """Weights of the centres, float32 (m, k), and bias (k,), that are best in the weighted least squares.

    points: (n, p). targets: (n, k). sample_weights: (n,). ridge: weight of the squared norm of the machine against
    the mean squared error.
    """
    basis = kernel_basis(centres, gamma)
    single = basis.astype(np.float32)
    size = basis.shape[1] + 1
    squares, products = np.zeros((size, size)), np.zeros((size, targets.shape[1]))
    for start in range(0, len(points), ROWS):
        rows = slice(start, start + ROWS)
        features = radial_kernel(points[rows], centres, gamma) @ single
        # A column of ones for the bias.
        features = np.concatenate([features, np.ones((len(features), 1), np.float32)], axis=1)
        weighted = (features * sample_weights[rows, None]).T
        squares += weighted @ features
        products += weighted @ targets[rows]
        progress("sum over samples", min(start + ROWS, len(points)), len(points))
    penalty = np.full(size, ridge * float(sample_weights.sum()))
    penalty[-1] = 1e-9
    squares[np.diag_indices_from(squares)] += penalty
    solution = np.linalg.solve(squares, products)
    return (basis @ solution[:-1]).astype(np.float32), solution[-1].astype(np.float32)
