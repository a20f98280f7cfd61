"""Batches for a hand net, drawn from a pool of altered patches."""

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.standardise import EVENNESS, LARGEST
from lightgesture.features.types import Float
from lightgesture.models import NONE
from lightgesture.training.pool.divers import SOURCE
from lightgesture.training.pool.patch_pool import PatchPool
from lightgesture.training.svm.machine import sample_weights

Random = np.random.Generator

_ROOTS = np.sqrt(np.arange(256, dtype=np.float32) / np.float32(255.0))


ERASED_SHARE: Final = 0.2
"""Of patches, those of which a part is covered."""
LARGEST_ERASED: Final = 0.4
"""Side of that part over the patch's."""


@dataclass(frozen=True, slots=True, eq=False)
class HandBatch:
    """patches: float32 (n, size, size, 3), standardised. contours: float32 (n, c), as measured. truth: int64 (n,).
    answers: float32 (n, classes), scores of other nets for the same patches, None where nobody gave any.
    landmarks: float32 (n, 42), x and y of each in turn, sides of the patch from its middle, NaN where unknown or
    covered; None where the pool has none."""

    patches: Float
    contours: Float
    truth: NDArray[np.int64]
    answers: Float | None = None
    landmarks: Float | None = None


def standardised(patches: NDArray[np.uint8]) -> Float:
    """What `features.standardise.channel_tables` makes of each patch, (n, h, w, 3), for many at once."""
    roots = _ROOTS[patches]
    mean = roots.mean(axis=(1, 2), keepdims=True)
    variance = np.square(roots).mean(axis=(1, 2), keepdims=True) - np.square(mean)
    values = (roots - mean) / (np.sqrt(np.maximum(variance, 0.0)) + np.float32(EVENNESS))
    return np.asarray(np.clip(values, -LARGEST, LARGEST), np.float32)


SHOWN_SHARE: Final = 0.06
"""Of patches, those of signs that real divers show, where there are any: few pictures, each worth many others."""
RESTING_SHARE: Final = 0.08
"""Those of other hands and things on real dives."""


class HandSamples:
    """Draws from the rows of a pool that are chosen, so that no person and no class rules."""

    def __init__(
        self,
        pool: PatchPool,
        chosen: NDArray[np.bool_],
        classes: Sequence[str],
        margin: int,
    ) -> None:
        """chosen: bool (n,), of the pool. margin: pixels by which a patch may be shifted each way."""
        self._pool, self._margin = pool, margin
        self._answers: NDArray[np.float16] | None = None
        self.classes = tuple(classes)
        self._rows = np.flatnonzero(chosen)
        index = {name: number for number, name in enumerate(classes)}
        self._truth = np.array([index[name] for name in pool.tokens[self._rows]], np.int64)
        # Beside the shapes that people show as no token, parts of hands and of rooms are a kind of their own.
        beside = np.where(pool.hands[self._rows] >= 0, "", " beside")
        sources = pool.sources[self._rows]
        weights = sample_weights(self._truth, np.char.add(sources, beside)).astype(np.float64)
        weights = _with_divers(weights, np.char.startswith(sources, SOURCE), self._truth, self.classes)
        self._cumulative = np.cumsum(weights) / weights.sum()

    def __len__(self) -> int:
        """Number of rows of the pool that are drawn from."""
        return len(self._rows)

    @property
    def size(self) -> int:
        """Side of a drawn patch, pixels."""
        return int(self._pool.patches.shape[1] - 2 * self._margin)

    @property
    def has_landmarks(self) -> bool:
        """Whether the landmarks of any row are known."""
        known = self._pool.landmarks
        return known is not None and bool(np.isfinite(known[self._rows]).any())

    def with_answers(self, answers: NDArray[np.float16]) -> "HandSamples":
        """The same, its batches with other nets' scores: (rows, classes), as `middles` counts the rows."""
        other = copy.copy(self)
        other._answers = answers
        return other

    def middles(self, first: int, last: int) -> Float:
        """The chosen rows `first` to `last` as they are, neither shifted nor covered: (n, size, size, 3)."""
        inner = slice(self._margin, self._margin + self.size)
        return standardised(np.asarray(self._pool.patches[self._rows[first:last]][:, inner, inner]))

    def draw_rows(self, random: Random, count: int) -> NDArray[np.int64]:
        """Which of the chosen rows a batch is made of."""
        drawn = np.searchsorted(self._cumulative, random.random(count))
        return np.asarray(np.minimum(drawn, len(self._rows) - 1), np.int64)

    def draw(self, random: Random, count: int) -> HandBatch:
        """`count` patches."""
        drawn = self.draw_rows(random, count)
        rows = self._rows[drawn]
        corners = random.integers(2 * self._margin + 1, size=(count, 2))
        seen = standardised(self._shifted(rows, corners))
        landmarks = self._landmarks(rows, corners)
        self._erase(seen, landmarks, random)
        answers = None if self._answers is None else self._answers[drawn].astype(np.float32)
        contours = self._pool.contours[rows].astype(np.float32)
        return HandBatch(seen, contours, self._truth[drawn], answers, landmarks)

    def _landmarks(self, rows: NDArray[np.int64], corners: NDArray[np.int64]) -> Float | None:
        """Of rows of the pool in the parts of them that begin at (top, left)."""
        if self._pool.landmarks is None:
            return None
        places = self._pool.landmarks[rows].astype(np.float32).reshape(len(rows), -1, 2)
        places = places * np.float32(self.size + 2 * self._margin) - corners[:, None, ::-1]
        return np.asarray(places / self.size - 0.5, np.float32).reshape(len(rows), -1)

    def _shifted(self, rows: NDArray[np.int64], corners: NDArray[np.int64]) -> NDArray[np.uint8]:
        size = self.size
        parts = [
            self._pool.patches[row, top : top + size, left : left + size]
            for row, (top, left) in zip(rows, corners, strict=True)
        ]
        return np.stack(parts)

    def _erase(self, seen: Float, landmarks: Float | None, random: Random) -> None:
        """Cover a part of some patches; the landmarks there become unknown, for there is nothing to tell them by."""
        size = seen.shape[1]
        for number in np.flatnonzero(random.random(len(seen)) < ERASED_SHARE):
            height, width = random.integers(2, max(3, round(LARGEST_ERASED * size)), 2)
            top, left = random.integers(size - height + 1), random.integers(size - width + 1)
            seen[number, top : top + height, left : left + width] = random.normal(0.0, 1.0, 3)
            if landmarks is not None:
                places = (landmarks[number].reshape(-1, 2) + 0.5) * size - (left, top)
                covered = ((places >= 0) & (places < (width, height))).all(axis=1)
                landmarks[number, np.repeat(covered, 2)] = np.nan


def _with_divers(
    weights: NDArray[np.float64],
    real: NDArray[np.bool_],
    truth: NDArray[np.int64],
    classes: Sequence[str],
) -> NDArray[np.float64]:
    """The weights, changed in place so that rows of real divers, `real`, have their shares."""
    sign = np.array([name != NONE for name in classes], np.bool_)[truth]
    left = 1.0
    for chosen, share in ((real & sign, SHOWN_SHARE), (real & ~sign, RESTING_SHARE)):
        if chosen.any():
            weights[chosen] *= share / weights[chosen].sum()
            left -= share
    weights[~real] *= left / weights[~real].sum()
    return weights
