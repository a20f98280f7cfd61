"""Training of the support vector machine from samples; needs no manifest, and NumPy alone.

A least-squares support vector machine of fixed size (Suykens, Van Gestel, De Brabanter, De Moor and Vandewalle,
"Least Squares Support Vector Machines", 2002, chapter 6): the radial kernel is approximated by its values at a few
vectors drawn from the data (Nyström; Williams and Seeger, NIPS 2001), and there each class against all others
is a ridge regression. Its sums over the samples add up, so a fold is held out by subtracting its own sums, and
all folds together cost one pass.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.vector import VectorSettings
from lightgesture.models.calibration import fit_temperature, softmax
from lightgesture.models.errors import ModelError
from lightgesture.models.fixed_size import accumulate, held_out_scores, kernel_basis, solve
from lightgesture.models.projection import Progress, describe, fit_projection, in_parts
from lightgesture.models.samples import CLASSES, TrainingSample
from lightgesture.models.svm_file import SvmModel

Float = NDArray[np.float32]


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
    data = describe(samples, settings.features, classes, progress)
    if len(np.unique(data.truth)) < 2:
        raise ModelError("the samples hold less than two classes; a classifier needs at least two")
    mean, projection = fit_projection(
        data.vectors, settings.features, settings.directions, settings.contour_weight
    )
    projected = [(part - mean) @ projection for part in in_parts(data.vectors)]
    points = np.asarray(np.concatenate(projected), np.float32)
    random = np.random.default_rng(seed)
    chosen = random.choice(len(points), min(settings.centres, len(points)), replace=False)
    centres = points[np.sort(chosen)].astype(np.float16).astype(np.float32)
    gamma = settings.width / (2.0 * float(points.var(axis=0).sum()))
    basis = kernel_basis(centres, gamma)
    folds = assign_folds(data.sources, settings.folds)
    weights = sample_weights(data.truth, data.sources)
    weights = weights * np.where(data.original, 1.0, settings.altered_weight).astype(np.float32)
    sums = accumulate(points, centres, gamma, basis, data.truth, weights, folds, len(classes), progress)
    scores = held_out_scores(points, centres, gamma, basis, sums, folds, settings.ridge)
    temperature = fit_temperature(scores[data.original], data.truth[data.original])
    solution = solve(sums, settings.ridge)
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
