"""Samples as vectors, and the main directions of these, in which the support vector machine begins."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import cut_patch
from lightgesture.features.types import Float
from lightgesture.features.vector import VectorSettings, block_lengths, feature_vectors
from lightgesture.models import ModelError
from lightgesture.training.samples import TrainingSample

Double = NDArray[np.float64]
Progress = Callable[[str, int, int], None]
"""Told the name of the step, what is done of it and what it has in all (0 where that is not known)."""

CHUNK = 64
"""Patches described at once: more do not fit the processor's cache and take longer each."""

CONTOUR_WEIGHT = 0.15
"""Variance of the contour numbers against that of the gradients at first, 0 to 1."""

ROWS = 4096
"""Rows held at once in single precision, which bounds the memory."""


@dataclass(frozen=True, slots=True, eq=False)
class Described:
    """Samples. vectors: (n, d). truth: int (n,), index of the class. sources: (n,), names. hands: int (n,), numbers of
    the hands, -1 for none. original: bool (n,). weights: float32 (n,)."""

    vectors: NDArray[np.float16]
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    hands: NDArray[np.int64]
    original: NDArray[np.bool_]
    weights: Float


def describe(
    samples: Iterable[TrainingSample], settings: VectorSettings, classes: Sequence[str], progress: Progress
) -> Described:
    """Feature vectors and truth of all samples; pictures are let go at once."""
    index = {name: number for number, name in enumerate(classes)}
    vectors: list[NDArray[np.float16]] = []
    patches: list[NDArray[np.uint8]] = []
    truth: list[int] = []
    sources: list[str] = []
    hands: list[int] = []
    original: list[bool] = []
    weights: list[float] = []
    for sample in samples:
        if sample.token not in index:
            raise ModelError(f"{sample.source}: {sample.token!r} is no class; known are {', '.join(classes)}")
        try:
            patches.append(cut_patch(sample.image, sample.box, sample.side, settings.patch))
        except ValueError as error:
            raise ModelError(f"{sample.source}: {error}; correct the sample") from error
        truth.append(index[sample.token])
        sources.append(sample.source)
        hands.append(sample.hand)
        original.append(sample.original)
        weights.append(sample.weight)
        if len(patches) == CHUNK:
            vectors.append(feature_vectors(np.stack(patches), settings).astype(np.float16))
            patches.clear()
            progress("describe samples", len(truth), 0)
    if patches:
        vectors.append(feature_vectors(np.stack(patches), settings).astype(np.float16))
    if not vectors:
        raise ModelError("there are no samples; give a manifest or folders with pictures")
    return Described(
        np.concatenate(vectors),
        np.array(truth),
        np.array(sources),
        np.array(hands),
        np.array(original),
        np.array(weights, np.float32),
    )


def in_parts(rows: NDArray[np.float16]) -> Iterator[Float]:
    """The rows (n, d), `ROWS` at a time, in single precision."""
    for start in range(0, len(rows), ROWS):
        yield rows[start : start + ROWS].astype(np.float32)


def fit_projection(
    vectors: NDArray[np.float16], features: VectorSettings, directions: int
) -> tuple[Float, Float]:
    """Mean (d,) and projection (d, p): principal directions of the gradients, then the scaled contour numbers.

    directions: see `SvmSettings`.
    """
    gradients, contour = block_lengths(features)
    mean = vectors.mean(axis=0, dtype=np.float64)
    variances, main = _principal_directions(vectors[:, :gradients], mean[:gradients], directions)
    kept = len(variances)
    deviation = vectors[:, gradients:].std(axis=0, dtype=np.float64)
    spread = float(variances.sum()) if kept else 1.0
    scale = np.sqrt(CONTOUR_WEIGHT * spread / contour) / np.maximum(deviation, 1e-6)
    projection = np.zeros((gradients + contour, kept + contour))
    projection[:gradients, :kept] = main
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
    for part in in_parts(rows):
        centred = part - mean.astype(np.float32)
        scatter += centred.T @ centred
    values, directions = np.linalg.eigh(scatter / len(rows))
    return values[::-1][:most], directions[:, ::-1][:, :most]
