"""The contour bank: outlines of hands, class by class, to which a region's outline may be near.

The fourth step of Islam, Ho and Sattar, "Dynamic Reconfiguration of Mission Parameters in Underwater Human-Robot
Collaboration" (ICRA 2018), chooses hands by their distance to such a bank. They compare Hu moments contour by contour;
here every outline is a short vector (`descriptors`), so that all distances are one matrix product. Beside the hands the
bank holds outlines of other things: being near to a hand says little unless it is farther from them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.descriptors import (
    Contour,
    DescriptorSettings,
    Float,
    describe_outlines,
    mirrored,
)

OTHER = "other"
"""Name of the class of outlines that are no hands."""

OTHER_TIMES = 4
"""Centres of other things for one of each hand class: they are far more varied than one sign."""

ROUNDS = 30
"""Most rounds of k-means; it settles in fewer."""


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


def bank_distances(contours: Sequence[Contour], bank: Bank) -> Float:
    """Distance of each outline to the nearest centre of each class, float32 (n, classes), at least 0.

    contours: as `describe_outlines` takes them. Descriptors are of outlines of size 1, so 0.1 is near and 1 is far.
    """
    found = describe_outlines(contours, bank.settings)
    # |a - b|² = |a|² - 2 ab + |b|²: all pairs by one matrix product; rounding may leave a tiny negative square.
    squares = found @ (-2.0 * bank.centres.T)
    squares += np.square(found).sum(axis=1, keepdims=True)
    squares += np.square(bank.centres).sum(axis=1)
    starts = np.searchsorted(bank.owner, np.arange(len(bank.classes)))
    nearest = np.minimum.reduceat(squares, starts, axis=1)
    return np.asarray(np.sqrt(np.maximum(nearest, 0.0)), np.float32)


def hand_proximity(distances: Float, bank: Bank) -> Float:
    """How much nearer each outline is to a hand than to other things, float32 (n,), 0 to 1, 0.5 where equally near.

    distances: of `bank_distances`. Raises ValueError for a bank without the class `OTHER` or without any hand.
    """
    if OTHER not in bank.classes or len(bank.classes) < 2:
        raise ValueError(f"the bank must hold hands and the class {OTHER!r}; build it with both")
    index = bank.classes.index(OTHER)
    other = distances[:, index]
    hand = np.delete(distances, index, axis=1).min(axis=1)
    both = other + hand
    return np.asarray(np.where(both > 0.0, other / np.maximum(both, 1e-9), 0.5), np.float32)


def build_bank(
    contours_by_class: Mapping[str, Sequence[Contour]],
    per_class: int,
    seed: int,
    settings: DescriptorSettings | None = None,
) -> Bank:
    """A bank of at most `per_class` centres for each class, `OTHER_TIMES` as many for `OTHER`.

    contours_by_class: outlines as `describe_outlines` takes them; their mirror images count too, because either hand
    may make a sign. A class with fewer outlines than centres gives them all. The same arguments give the same bank.
    Raises ValueError for a class without an outline, or no class.
    """
    settings = settings or DescriptorSettings()
    rng = np.random.default_rng(seed)
    centres, owner = [], []
    for index, (name, contours) in enumerate(contours_by_class.items()):
        if not contours or per_class < 1:
            raise ValueError(
                f"class {name!r} has {len(contours)} outlines for {per_class} centres; give one at least"
            )
        described = describe_outlines(contours, settings)
        count = per_class * (OTHER_TIMES if name == OTHER else 1)
        found = k_means(np.concatenate([described, mirrored(described)]), count, rng)
        centres.append(found)
        owner.append(np.full(len(found), index, np.int16))
    if not centres:
        raise ValueError("no classes; give the outlines of one at least")
    return Bank(tuple(contours_by_class), np.concatenate(centres), np.concatenate(owner), settings)


# In quotes, for the name alone would load NumPy's random numbers, which only training draws.
def k_means(points: Float, count: int, rng: "np.random.Generator") -> Float:
    """`count` centres of points, float32 (n, d) -> (min(n, count), d).

    Lloyd's rounds from the seeding of Arthur and Vassilvitskii, "k-means++: The Advantages of Careful Seeding", 2007.
    """
    if len(points) <= count:
        return points
    chosen = [int(rng.integers(len(points)))]
    nearest = np.square(points - points[chosen[0]]).sum(axis=1)
    while len(chosen) < count and nearest.sum() > 0.0:
        chosen.append(int(rng.choice(len(points), p=nearest / nearest.sum())))
        nearest = np.minimum(nearest, np.square(points - points[chosen[-1]]).sum(axis=1))
    centres = points[chosen].astype(np.float64)
    assigned = np.full(len(points), -1)
    for _ in range(ROUNDS):
        squares = np.square(centres).sum(axis=1) - 2.0 * points @ centres.T
        before, assigned = assigned, squares.argmin(axis=1)
        if np.array_equal(before, assigned):
            break
        sums = np.zeros_like(centres)
        np.add.at(sums, assigned, points)
        sizes = np.bincount(assigned, minlength=len(centres))[:, None]
        # A centre that lost its last point stays where it was.
        centres = np.where(sizes > 0, sums / np.maximum(sizes, 1), centres)
    return np.asarray(centres, np.float32)
