"""Fourier descriptors of outlines: the same few numbers for each, made for many outlines at once.

Persoon and Fu, "Shape Discrimination Using Fourier Descriptors", IEEE Transactions on Systems, Man, and Cybernetics
7(3), 1977: the points of a closed outline are a periodic complex function, and its low frequencies are its coarse
shape. Place and size are divided out. Orientation is kept, because raised hands have their fingers above: with it,
hands are told from other things much better than without.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Contour = NDArray[np.int32]
Float = NDArray[np.float32]

SMALLEST_SPREAD = 1e-6
"""Pixels; outlines spread less than this round their centre are points and are not enlarged to size 1."""


@dataclass(frozen=True, slots=True)
class DescriptorSettings:
    """points: taken from each outline, 8 to 256. harmonics: frequencies kept each way round, 1 to points / 2 - 1.

    Raises ValueError outside these ranges.
    """

    points: int = 32
    harmonics: int = 8

    def __post_init__(self) -> None:
        if not (8 <= self.points <= 256 and 1 <= self.harmonics < self.points / 2):
            raise ValueError(f"{self.points} points and {self.harmonics} harmonics do not make a descriptor")

    @property
    def length(self) -> int:
        """Numbers that describe one outline: two parts of a coefficient for each frequency each way round."""
        return 4 * self.harmonics


def describe_outlines(contours: Sequence[Contour], settings: DescriptorSettings | None = None) -> Float:
    """Descriptors, float32 (n, settings.length): real parts of all frequencies, then imaginary ones.

    contours: closed outlines pixel by pixel (CHAIN_APPROX_NONE), int32 (k, 2), k of at least 1, as OpenCV walks
    round regions. Moved, enlarged: the same. Mirrored (and walked in the same sense): imaginary parts keep, real
    parts turn their sign. Turned: others. The outline starts at its highest point, so that where it was begun does
    not matter.
    """
    settings = settings or DescriptorSettings()
    if not contours:
        return np.zeros((0, settings.length), np.float32)
    x, y = _sample(contours, settings.points)
    x -= x.mean(axis=1, keepdims=True)
    y -= y.mean(axis=1, keepdims=True)
    spread = np.sqrt((np.square(x) + np.square(y)).mean(axis=1, keepdims=True))
    start = y.argmin(axis=1)
    transform, shifts = _transform(settings)
    coefficients = (np.concatenate([x, y], axis=1) / np.maximum(spread, SMALLEST_SPREAD)) @ transform
    real, imaginary = coefficients[:, : 2 * settings.harmonics], coefficients[:, 2 * settings.harmonics :]
    cosine, sine = shifts[0][start], shifts[1][start]
    return np.concatenate([real * cosine - imaginary * sine, real * sine + imaginary * cosine], axis=1)


def _sample(contours: Sequence[Contour], count: int) -> tuple[Float, Float]:
    """`count` points of each outline, evenly spaced among its own: x and y, float32 (n, count)."""
    lengths = np.array([len(contour) for contour in contours])
    first = np.cumsum(lengths) - lengths
    chosen = first[:, None] + lengths[:, None] * np.arange(count) // count
    points = np.concatenate(contours)[chosen].astype(np.float32)
    return points[..., 0].copy(), points[..., 1].copy()


@lru_cache(maxsize=4)
def _transform(settings: DescriptorSettings) -> tuple[Float, Float]:
    """The Fourier transform as a real matrix, float32 (2 points, 4 harmonics), and the cosines and sines that begin
    the outline at another of its points, float32 (2, points, 2 harmonics)."""
    kept = np.arange(1, settings.harmonics + 1)
    frequencies = np.concatenate([kept, -kept])
    angles = np.outer(np.arange(settings.points), frequencies) * (2 * np.pi / settings.points)
    cosine, sine = np.cos(angles), np.sin(angles)
    matrix = np.block([[cosine, -sine], [sine, cosine]]) / settings.points
    return matrix.astype(np.float32), np.stack([cosine, sine]).astype(np.float32)


def mirrored(descriptors: Float) -> Float:
    """Descriptors of the same outlines flipped left to right, float32 (n, settings.length)."""
    half = descriptors.shape[1] // 2
    return np.concatenate([-descriptors[:, :half], descriptors[:, half:]], axis=1)
