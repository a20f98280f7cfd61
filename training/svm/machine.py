"""Training of the support vector machine from samples; needs no manifest, and NumPy alone.

It starts as a least-squares support vector machine of fixed size (Suykens, Van Gestel, De Brabanter, De Moor and
Vandewalle, "Least Squares Support Vector Machines", 2002, chapter 6): the radial kernel is approximated by its values
at a few vectors drawn from the data (Nyström; Williams and Seeger, NIPS 2001), and there each class against all others
is a ridge regression. From there on its vectors, its projection and its weights are learnt together (`descent`).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.vector import VectorSettings, block_lengths
from lightgesture.models.calibration import fit_temperature, softmax
from lightgesture.models.errors import ModelError
from lightgesture.models.projection import Described, Progress, describe, fit_projection, in_parts
from lightgesture.models.samples import CLASSES, TrainingSample
from lightgesture.models.svm import SvmClassifier
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.svm.descent import DescentSettings, Machine, descend
from lightgesture.training.svm.fixed_size import fit_fixed_size

Float = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class SvmSettings:
    """How the machine is trained.

    features: how a patch becomes a vector. smallest_hand: longer side of the smallest box that is read, pixels.
    directions: principal directions of the gradients that the machine learns from, 64 to 512; they cost time in
        training alone. 0 leaves the gradients out.
    dimensions: of the space of the kernel, beside one for each contour number, 16 to 128; more cost time and size.
    contour_weight: variance of the contour numbers against that of the gradients at first, 0 to 1; alone they need
        any above 0.
    centres: expansion vectors, 200 to 4000; more read a little better and cost time and size.
    width: at first, gamma times the mean squared distance of two samples, 0.5 to 8; larger is a narrower kernel.
    ridge: at first, weight of the squared norm of the machine against the mean squared error.
    descent: how it is learnt from there.
    one_in: of so many groups of sources one is kept from the machine, for the temperature and the scores.
    """

    features: VectorSettings = field(default_factory=VectorSettings)
    smallest_hand: int = 12
    directions: int = 256
    dimensions: int = 64
    contour_weight: float = 0.15
    centres: int = 2000
    width: float = 2.0
    ridge: float = 1e-5
    descent: DescentSettings = field(default_factory=DescentSettings)
    one_in: int = 12


@dataclass(frozen=True, slots=True, eq=False)
class HeldOut:
    """Answers for samples by a machine that saw none of their sources.

    probabilities: float32 (n, classes). truth: int (n,), index of the class. sources: (n,), names. original: bool
    (n,), False for altered copies.
    """

    probabilities: Float
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    original: NDArray[np.bool_]


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
    The same samples, settings and seed give the same model on one machine with one number of threads.
    Raises ModelError for a sample of an unknown class or of an unreadable box, for less than two classes, and where so
    few samples are given that none can be kept out.
    """
    settings = settings or SvmSettings()
    progress = progress or _silent
    data = describe(samples, settings.features, classes, progress)
    if len(np.unique(data.truth)) < 2:
        raise ModelError("the samples hold less than two classes; a classifier needs at least two")
    kept = kept_samples(data.truth, data.sources, settings.one_in)
    mean, projection = fit_projection(
        data.vectors, settings.features, settings.directions, settings.contour_weight
    )
    reduced = np.concatenate(
        [((part - mean) @ projection).astype(np.float16) for part in in_parts(data.vectors)]
    )
    answered = _rows_of(data, kept)
    learnt = _rows_of(replace(data, vectors=reduced), ~kept)
    # The vectors of many samples take most of the memory, and are done with.
    del data, reduced
    weights = sample_weights(learnt.truth, learnt.sources) * learnt.weights
    machine = _start(learnt, weights, len(classes), settings, seed, progress)
    machine = descend(machine, learnt.vectors, learnt.truth, weights, settings.descent, seed, progress)
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
        smallest_hand=settings.smallest_hand,
    )
    return _calibrated(model, answered)


def _silent(_step: str, _done: int, _total: int) -> None:
    pass


def _rows_of(data: Described, chosen: NDArray[np.bool_]) -> Described:
    return Described(
        data.vectors[chosen],
        data.truth[chosen],
        data.sources[chosen],
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
    first = first[(first < settings.dimensions) | (first >= gradients)]
    points = np.concatenate([part[:, first] for part in in_parts(reduced)])
    scale = np.float32(np.sqrt(settings.width / (2.0 * float(points.var(axis=0).sum()))))
    points *= scale
    random = np.random.default_rng(seed)
    centres = points[np.sort(random.choice(len(points), min(settings.centres, len(points)), replace=False))]
    targets = np.where(truth[:, None] == np.arange(classes), np.float32(1.0), np.float32(-1.0))
    own, bias = fit_fixed_size(points, centres, 1.0, targets, weights, settings.ridge, progress)
    projection = np.zeros((reduced.shape[1], len(first)), np.float32)
    projection[first, np.arange(len(first))] = scale
    return Machine(projection, centres, own, bias)


def _calibrated(model: SvmModel, kept: Described) -> tuple[SvmModel, HeldOut]:
    """The model with its temperature, and its answers for what was kept from it; the temperature is that of
    originals where there are any."""
    classifier = SvmClassifier(model)
    scores = np.concatenate([classifier.scores(part) for part in in_parts(kept.vectors)])
    fitting = kept.original if kept.original.any() else np.ones(len(scores), bool)
    temperature = fit_temperature(scores[fitting], kept.truth[fitting])
    answers = HeldOut(softmax(scores, temperature), kept.truth, kept.sources, kept.original)
    return replace(model, temperature=temperature), answers


def kept_samples(truth: NDArray[np.int64], sources: NDArray[np.str_], one_in: int) -> NDArray[np.bool_]:
    """Which samples are kept from the machine, bool (n,): one of so many folds of the sources, less those that alone
    show a class. Where these are all, one sample in so many. Raises ModelError where nothing is left to keep."""
    for folds in (assign_folds(sources, one_in), np.arange(len(truth)) % one_in):
        kept = folds == one_in - 1
        kept &= np.isin(truth, truth[~kept])
        if kept.any():
            return np.asarray(kept)
    raise ModelError(
        f"{len(truth)} samples are too few: one in {one_in} is kept from the machine; give more of each class"
    )


def assign_folds(sources: NDArray[np.str_], folds: int) -> NDArray[np.int64]:
    """Fold of each sample, int (n,): whole sources, the largest first into the emptiest fold.

    With fewer sources than folds, samples are dealt out in turn instead.
    """
    names, members, sizes = np.unique(sources, return_inverse=True, return_counts=True)
    if len(names) < folds:
        return np.arange(len(sources)) % folds
    fold_of = np.zeros(len(names), np.int64)
    filled = np.zeros(folds)
    for source in np.argsort(-sizes, kind="stable"):
        fold_of[source] = filled.argmin()
        filled[fold_of[source]] += sizes[source]
    return np.asarray(fold_of[members.reshape(-1)])


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
