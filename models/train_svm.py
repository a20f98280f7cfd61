"""Training of the support vector machine from samples; needs no manifest, and NumPy alone.

A least-squares support vector machine of fixed size (Suykens, Van Gestel, De Brabanter, De Moor and Vandewalle,
"Least Squares Support Vector Machines", 2002, chapter 6): the radial kernel is approximated by its values at a few
vectors drawn from the data (Nyström; Williams and Seeger, NIPS 2001), and there each class against all others
is a ridge regression. Its sums over the samples add up, so a fold is held out by subtracting its own sums, and
all folds together cost one pass.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import cut_patch
from lightgesture.features.vector import VectorSettings, block_lengths, feature_vectors
from lightgesture.models.calibration import fit_temperature, softmax
from lightgesture.models.errors import ModelError
from lightgesture.models.samples import CLASSES, TrainingSample
from lightgesture.models.svm import radial_kernel
from lightgesture.models.svm_file import SvmModel

Float = NDArray[np.float32]
Double = NDArray[np.float64]
Progress = Callable[[str, int, int], None]
"""Told the name of the step, what is done of it and what it has in all (0 where that is not known)."""

CHUNK = 64
"""Patches described at once: more do not fit the processor's cache and take longer each."""

ROWS = 4096
"""Kernel rows held at once, which bounds the memory."""


@dataclass(frozen=True, slots=True)
class SvmSettings:
    """How the machine is trained.

    features: how a patch becomes a vector. smallest_hand: longer side of the smallest box that is read, pixels.
    directions: principal directions of the gradients that are kept, 32 to 256; more cost time and size. 0 leaves the
        gradients out.
    contour_weight: variance of the contour numbers against that of the gradients, 0 to 1; alone they need any above 0.
    centres: expansion vectors, 500 to 8000. Accuracy grows with their logarithm, time and size with their number.
    width: gamma times the mean squared distance of two samples, 0.5 to 8; larger is a narrower kernel.
    altered_weight: weight of an altered copy beside 1 of an original; smaller reads plain pictures better,
        larger those in bad light and badly boxed ones.
    ridge: weight of the squared norm of the machine against the mean squared error.
    folds: groups of sources that are held out in turn for scores and temperature.
    """

    features: VectorSettings = field(default_factory=VectorSettings)
    smallest_hand: int = 12
    directions: int = 96
    contour_weight: float = 0.15
    centres: int = 5000
    width: float = 2.0
    altered_weight: float = 0.33
    ridge: float = 1e-5
    folds: int = 5


@dataclass(frozen=True, slots=True, eq=False)
class HeldOut:
    """Answers for the samples of each fold by a machine that saw none of its sources.

    probabilities: float32 (n, classes). truth: int (n,), index of the class. sources: (n,), names. original: bool
    (n,), False for altered copies.
    """

    probabilities: Float
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    original: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class _Described:
    vectors: NDArray[np.float16]
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    original: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class _Sums:
    """Sums over samples of weight × feature × feature (r, r) and weight × feature × target (r, k)."""

    features: Double
    targets: Double
    weight: float


def train_svm(
    samples: Iterable[TrainingSample],
    settings: SvmSettings | None = None,
    *,
    classes: Sequence[str] = CLASSES,
    seed: int = 0,
    progress: Progress | None = None,
) -> tuple[SvmModel, HeldOut]:
    """Train on samples of at least two of `classes`.

    The same samples, settings and seed give the same model on one machine with one number of threads.
    Raises ModelError for a sample of an unknown class or of an unreadable box, and for less than two classes.
    """
    settings = settings or SvmSettings()
    progress = progress or _silent
    data = _describe(samples, settings.features, classes, progress)
    if len(np.unique(data.truth)) < 2:
        raise ModelError("the samples hold less than two classes; a classifier needs at least two")
    mean, projection = _projection(data.vectors, settings)
    projected = [(part - mean) @ projection for part in _parts(data.vectors)]
    points = np.asarray(np.concatenate(projected), np.float32)
    random = np.random.default_rng(seed)
    chosen = random.choice(len(points), min(settings.centres, len(points)), replace=False)
    centres = points[np.sort(chosen)].astype(np.float16).astype(np.float32)
    gamma = settings.width / (2.0 * float(points.var(axis=0).sum()))
    basis = _basis(centres, gamma)
    folds = assign_folds(data.sources, settings.folds)
    weights = sample_weights(data.truth, data.sources)
    weights = weights * np.where(data.original, 1.0, settings.altered_weight).astype(np.float32)
    sums = _accumulate(points, centres, gamma, basis, data.truth, weights, folds, len(classes), progress)
    scores = _held_out_scores(points, centres, gamma, basis, sums, folds, settings.ridge)
    temperature = fit_temperature(scores[data.original], data.truth[data.original])
    solution = _solve(sums, settings.ridge)
    model = SvmModel(
        classes=tuple(classes),
        features=settings.features,
        mean=mean,
        projection=projection,
        centres=centres,
        weights=(basis @ solution[:-1]).astype(np.float32),
        bias=solution[-1].astype(np.float32),
        gamma=gamma,
        temperature=temperature,
        smallest_hand=settings.smallest_hand,
    )
    return model, HeldOut(softmax(scores, temperature), data.truth, data.sources, data.original)


def _silent(_step: str, _done: int, _total: int) -> None:
    pass


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


def _describe(
    samples: Iterable[TrainingSample], settings: VectorSettings, classes: Sequence[str], progress: Progress
) -> _Described:
    """Feature vectors and truth of all samples; pictures are let go at once."""
    index = {name: number for number, name in enumerate(classes)}
    vectors: list[NDArray[np.float16]] = []
    patches: list[NDArray[np.uint8]] = []
    truth: list[int] = []
    sources: list[str] = []
    original: list[bool] = []
    for sample in samples:
        if sample.token not in index:
            raise ModelError(f"{sample.source}: {sample.token!r} is no class; known are {', '.join(classes)}")
        try:
            patches.append(cut_patch(sample.image, sample.box, sample.side, settings.patch))
        except ValueError as error:
            raise ModelError(f"{sample.source}: {error}; correct the sample") from error
        truth.append(index[sample.token])
        sources.append(sample.source)
        original.append(sample.original)
        if len(patches) == CHUNK:
            vectors.append(feature_vectors(np.stack(patches), settings).astype(np.float16))
            patches.clear()
            progress("describe samples", len(truth), 0)
    if patches:
        vectors.append(feature_vectors(np.stack(patches), settings).astype(np.float16))
    if not vectors:
        raise ModelError("there are no samples; give a manifest or folders with pictures")
    return _Described(np.concatenate(vectors), np.array(truth), np.array(sources), np.array(original))


def _parts(rows: NDArray[np.float16]) -> Iterator[Float]:
    for start in range(0, len(rows), ROWS):
        yield rows[start : start + ROWS].astype(np.float32)


def _projection(vectors: NDArray[np.float16], settings: SvmSettings) -> tuple[Float, Float]:
    """Mean (d,) and projection (d, p): principal directions of the gradients, then the scaled contour numbers."""
    gradients, contour = block_lengths(settings.features)
    mean = vectors.mean(axis=0, dtype=np.float64)
    variances, directions = _principal_directions(
        vectors[:, :gradients], mean[:gradients], settings.directions
    )
    kept = len(variances)
    deviation = vectors[:, gradients:].std(axis=0, dtype=np.float64)
    spread = float(variances.sum()) if kept else 1.0
    scale = np.sqrt(settings.contour_weight * spread / contour) / np.maximum(deviation, 1e-6)
    projection = np.zeros((gradients + contour, kept + contour))
    projection[:gradients, :kept] = directions
    projection[gradients:, kept:] = np.diag(np.where(deviation > 1e-6, scale, 0.0))
    # As the file stores it, so that what is trained is what is shipped.
    return mean.astype(np.float32), projection.astype(np.float16).astype(np.float32)


def _principal_directions(rows: NDArray[np.float16], mean: Double, most: int) -> tuple[Double, Double]:
    """Variances (p,) and directions (d, p) of the largest spread of rows (n, d), largest first, p at most `most`."""
    length = rows.shape[1]
    if len(rows) < length:
        # Few rows: their own products (n, n) are smaller than the scatter (d, d).
        _, values, directions = np.linalg.svd(rows.astype(np.float64) - mean, full_matrices=False)
        return values[:most] ** 2 / len(rows), directions[:most].T
    scatter = np.zeros((length, length))
    for part in _parts(rows):
        centred = part - mean.astype(np.float32)
        scatter += centred.T @ centred
    values, directions = np.linalg.eigh(scatter / len(rows))
    return values[::-1][:most], directions[:, ::-1][:, :most]


def _basis(centres: Float, gamma: float) -> Double:
    """Kernel values at the centres times this (m, r) are the features of the machine: K^(-1/2), rank r."""
    values, vectors = np.linalg.eigh(radial_kernel(centres, centres, gamma).astype(np.float64))
    kept = values > 1e-6 * values[-1]
    return np.asarray(vectors[:, kept] / np.sqrt(values[kept]))


def _features(points: Float, centres: Float, gamma: float, basis: Float) -> Float:
    """Features of points (n, p), and a column of ones for the bias: float32 (n, r + 1)."""
    features = radial_kernel(points, centres, gamma) @ basis
    return np.concatenate([features, np.ones((len(points), 1), np.float32)], axis=1)


def _accumulate(
    points: Float,
    centres: Float,
    gamma: float,
    basis: Double,
    truth: NDArray[np.int64],
    weights: Float,
    folds: NDArray[np.int64],
    classes: int,
    progress: Progress,
) -> list[_Sums]:
    """The sums of each fold. Targets are 1 for the sample's own class and -1 for the others."""
    single = basis.astype(np.float32)
    size = basis.shape[1] + 1
    done = 0
    sums = []
    for fold in range(int(folds.max()) + 1):
        members = np.flatnonzero(folds == fold)
        features_sum, targets_sum = np.zeros((size, size)), np.zeros((size, classes))
        for start in range(0, len(members), ROWS):
            rows = members[start : start + ROWS]
            features = _features(points[rows], centres, gamma, single)
            targets = np.where(truth[rows, None] == np.arange(classes), 1.0, -1.0).astype(np.float32)
            weighted = (features * weights[rows, None]).T
            features_sum += weighted @ features
            targets_sum += weighted @ targets
            done += len(rows)
            progress("sum over samples", done, len(points))
        sums.append(_Sums(features_sum, targets_sum, float(weights[members].sum())))
    return sums


def _solve(sums: Sequence[_Sums], ridge: float) -> Double:
    """Coefficients of the features and, last, the bias: float64 (r + 1, k)."""
    total = np.sum([part.features for part in sums], axis=0)
    penalty = np.full(len(total), ridge * sum(part.weight for part in sums))
    penalty[-1] = 1e-9
    total[np.diag_indices_from(total)] += penalty
    return np.asarray(np.linalg.solve(total, np.sum([part.targets for part in sums], axis=0)))


def _held_out_scores(
    points: Float,
    centres: Float,
    gamma: float,
    basis: Double,
    sums: Sequence[_Sums],
    folds: NDArray[np.int64],
    ridge: float,
) -> Float:
    """Scores (n, k) of every sample by the machine of the other folds."""
    scores = np.zeros((len(points), sums[0].targets.shape[1]), np.float32)
    for fold in range(len(sums)):
        solution = _solve([part for number, part in enumerate(sums) if number != fold], ridge)
        weights = (basis @ solution[:-1]).astype(np.float32)
        members = np.flatnonzero(folds == fold)
        for start in range(0, len(members), ROWS):
            rows = members[start : start + ROWS]
            kernel = radial_kernel(points[rows], centres, gamma)
            scores[rows] = kernel @ weights + solution[-1].astype(np.float32)
    return scores
