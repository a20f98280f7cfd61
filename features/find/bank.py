"""The contour bank: outlines of hands, class by class, to which a region's outline may be near.

The fourth step of Islam, Ho and Sattar, "Dynamic Reconfiguration of Mission Parameters in Underwater Human-Robot
Collaboration" (ICRA 2018), chooses hands by their distance to such a bank. They compare Hu moments contour by contour;
here every outline is a short vector, so that all distances are one matrix product. Beside the hands the bank holds
outlines of other things: being near to a hand says little unless it is farther from them.

The vectors are Fourier descriptors: Persoon and Fu, "Shape Discrimination Using Fourier Descriptors", IEEE Transactions
on Systems, Man, and Cybernetics 7(3), 1977. The points of a closed outline are a periodic complex function, and its low
frequencies are its coarse shape. Place and size are divided out. Orientation is kept, because raised hands have their
fingers above: with it, hands are told from other things much better than without.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Contour, Float

OTHER: Final = "other"
"""Name of the class of outlines that are no hands."""
SMALLEST_SPREAD: Final = 1e-6
"""Pixels; outlines spread less than this round their centre are points and are not enlarged to size 1."""
MOST_CENTRES: Final = 4096
"""Of what a file may hold."""
LONGEST_DESCRIPTOR: Final = 256
"""Numbers of one descriptor that a file may hold."""


@dataclass(frozen=True, slots=True)
class DescriptorSettings:
    """How outlines are described. Raises ValueError outside the ranges."""

    points: int = 32
    """Points taken from each outline, 8 to 256; the cost grows with them."""
    harmonics: int = 8
    """Frequencies kept each way round, 1 to points / 2 - 1: more tell finer bends apart."""

    def __post_init__(self) -> None:
        if not (8 <= self.points <= 256 and 1 <= self.harmonics < self.points / 2):
            raise ValueError(f"{self.points} points and {self.harmonics} harmonics do not make a descriptor")

    @property
    def length(self) -> int:
        """Numbers that describe one outline: two parts of a coefficient for each frequency each way round."""
        return 4 * self.harmonics


@dataclass(frozen=True, slots=True, eq=False)
class Bank:
    """classes: names, each once. centres: float32 (m, settings.length), descriptors of typical outlines. owner: int16
    (m,), the class of each centre as an index into `classes`, ascending, every class at least once. settings: how the
    descriptors are made.

    Raises ValueError where these do not fit together.
    """

    classes: tuple[str, ...]
    centres: Float
    owner: NDArray[np.int16]
    settings: DescriptorSettings

    def __post_init__(self) -> None:
        if self.centres.ndim != 2 or self.centres.shape[1] != self.settings.length:
            raise ValueError(
                f"centres {self.centres.shape} do not have the {self.settings.length} numbers of a descriptor"
            )
        if not np.isfinite(self.centres).all():
            raise ValueError("centres hold numbers that are not finite")
        if self.owner.shape != self.centres.shape[:1] or (np.diff(self.owner) < 0).any():
            raise ValueError("owner does not name a class for each centre, class by class")
        if not self.classes or len(set(self.classes)) != len(self.classes):
            raise ValueError("classes are none, or one stands twice")
        if not np.array_equal(np.unique(self.owner), np.arange(len(self.classes))):
            raise ValueError("a class has no centre, or a centre no class")


@dataclass(frozen=True, slots=True)
class BankLoops:
    """The passes over outlines.

    sampled: (points, starts, lengths, count) -> float32 (n, 2 count), so many points of each outline, x and then y from
        their middle; int64 (n,), the first of the highest of them.
    turned: (coefficients, start, shifts) -> float32 (n, 4 harmonics): Fourier coefficients, real parts and then
        imaginary ones, of outlines that begin at another of their points. shifts: of `_transform`.
    """

    sampled: Callable[
        [NDArray[np.int32], NDArray[np.int64], NDArray[np.int64], int], tuple[Float, NDArray[np.int64]]
    ]
    turned: Callable[[Float, NDArray[np.int64], Float], Float]


def bank_distances(contours: Sequence[Contour], bank: Bank) -> Float:
    """Distance of each outline to the nearest centre of each class, float32 (n, classes), at least 0.

    contours: as `describe_outlines` takes them. Descriptors are of outlines of size 1, so 0.1 is near and 1 is far.
    """
    return distances_from(describe_outlines(contours, bank.settings), bank)


def distances_from(described: Float, bank: Bank) -> Float:
    """`bank_distances` of outlines that are described, float32 (n, settings.length)."""
    # |a - b|² = |a|² - 2 ab + |b|²: all pairs by one matrix product; rounding may leave a tiny negative square.
    factors, constant, starts = _of_centres(bank)
    squares = described @ factors
    squares += np.square(described).sum(axis=1, keepdims=True)
    squares += constant
    nearest = np.minimum.reduceat(squares, starts, axis=1)
    return np.asarray(np.sqrt(np.maximum(nearest, 0.0)), np.float32)


@lru_cache(maxsize=4)
def _of_centres(bank: Bank) -> tuple[Float, Float, NDArray[np.intp]]:
    """-2 times the centres, a column each; their squares; where each class begins."""
    starts = np.searchsorted(bank.owner, np.arange(len(bank.classes)))
    return -2.0 * bank.centres.T, np.square(bank.centres).sum(axis=1), starts


def hand_proximity(distances: Float, bank: Bank) -> Float:
    """How much nearer each outline is to a hand than to other things, float32 (n,), 0 to 1, 0.5 where equally near.

    distances: of `bank_distances`. Raises ValueError for a bank without the class `OTHER` or without any hand.
    """
    if OTHER not in bank.classes or len(bank.classes) < 2:
        raise ValueError(f"the bank must hold hands and the class {OTHER!r}; build it with both")
    other, hand = distances[:, bank.classes.index(OTHER)], nearest_hand(distances, bank)
    both = other + hand
    return np.asarray(np.where(both > 0.0, other / np.maximum(both, 1e-9), 0.5), np.float32)


def nearest_hand(distances: Float, bank: Bank) -> Float:
    """float32 (n,): the distance of each outline to the nearest hand. distances: of `bank_distances`."""
    hands = [index for index, name in enumerate(bank.classes) if name != OTHER]
    return np.asarray(distances.take(hands, axis=1).min(axis=1), np.float32)


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
    lengths = np.array([len(contour) for contour in contours])
    return describe_points(np.concatenate(contours), np.cumsum(lengths) - lengths, lengths, settings)


def describe_points(
    points: NDArray[np.int32],
    starts: NDArray[np.int64],
    lengths: NDArray[np.int64],
    settings: DescriptorSettings,
    loops: BankLoops | None = None,
) -> Float:
    """`describe_outlines` of outlines in one array, int32 (m, 2). starts, lengths: int64 (n,), where each begins and
    how many points it has."""
    loops = loops or PLAIN
    sampled, start = loops.sampled(points, starts, lengths, settings.points)
    squares = np.square(sampled)
    x, y = squares[:, : settings.points], squares[:, settings.points :]
    spread = np.sqrt((x + y).sum(axis=1, keepdims=True) / np.float32(settings.points))
    transform, shifts = _transform(settings)
    return loops.turned((sampled / np.maximum(spread, SMALLEST_SPREAD)) @ transform, start, shifts)


def _plain_sampled(
    points: NDArray[np.int32], starts: NDArray[np.int64], lengths: NDArray[np.int64], count: int
) -> tuple[Float, NDArray[np.int64]]:
    # Evenly spaced among its own.
    chosen = starts[:, None] + lengths[:, None] * np.arange(count) // count
    sampled = np.empty((len(starts), 2 * count), np.float32)
    for axis, half in enumerate((sampled[:, :count], sampled[:, count:])):
        half[:] = points[:, axis].take(chosen)
        half -= half.sum(axis=1, keepdims=True) / np.float32(count)
    return sampled, sampled[:, count:].argmin(axis=1)


def _plain_turned(coefficients: Float, start: NDArray[np.int64], shifts: Float) -> Float:
    half = coefficients.shape[1] // 2
    real, imaginary = coefficients[:, :half], coefficients[:, half:]
    cosine, sine = shifts[0][start], shifts[1][start]
    return np.concatenate([real * cosine - imaginary * sine, real * sine + imaginary * cosine], axis=1)


PLAIN: Final = BankLoops(_plain_sampled, _plain_turned)


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


def bank_from(arrays: Mapping[str, NDArray[Any]], prefix: str) -> Bank:
    """The bank of a file's arrays, whose names begin with `prefix`. Raises KeyError or ValueError."""
    centres = arrays[f"{prefix}_centres"]
    if centres.ndim != 2 or len(centres) > MOST_CENTRES or centres.shape[1] > LONGEST_DESCRIPTOR:
        raise ValueError(f"centres of shape {centres.shape} are no bank")
    settings = DescriptorSettings(int(arrays[f"{prefix}_points"]), int(arrays[f"{prefix}_harmonics"]))
    return Bank(
        classes=tuple(str(name) for name in arrays[f"{prefix}_classes"]),
        centres=centres.astype(np.float32),
        owner=arrays[f"{prefix}_owner"].astype(np.int16),
        settings=settings,
    )
