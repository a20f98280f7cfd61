"""How like the hand each pixel of a patch is by its colour, without a model of skin.

Fisher's linear discriminant ("The Use of Multiple Measurements in Taxonomic Problems", 1936) of the pixels in the
middle of the patch against those round it is the direction of colour in which this hand differs from this room or
water.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

FLAT: Final = 1e-9
"""Deviations of colour, and ranges of it, that are nothing but rounding errors."""


@lru_cache(maxsize=1)
def _square_roots() -> NDArray[np.float64]:
    return np.asarray(np.sqrt(np.arange(256) / 255.0), np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class Regions:
    """Of a patch of p pixels. middle: indices of the pixels taken for hand. shares: float64 (p, 2), of each pixel in
    the mean of the middle and of the rim. both: (p,), their sum. even: (p,), 1 / p. bump: (p,), mean 0, deviation
    `prior`. evenness: (3, 3), what is added to the scatter."""

    middle: NDArray[np.intp]
    shares: NDArray[np.float64]
    both: NDArray[np.float64]
    even: NDArray[np.float64]
    bump: NDArray[np.float64]
    evenness: NDArray[np.float64]


def make_regions(
    size: int, middle: tuple[float, float], rim: float, evenness: float, prior: float
) -> Regions:
    """Of a patch `size` pixels wide: middle, its half axes along x and y; all as `ContourSettings` has them."""
    axis = (np.arange(size) + 0.5) / size * 2.0 - 1.0
    is_middle = (axis[None, :] / middle[0]) ** 2 + (axis[:, None] / middle[1]) ** 2 < 1.0
    near = max(1, round(rim * size))
    is_rim = np.zeros((size, size), bool)
    is_rim[:near] = True
    is_rim[: size * 3 // 4, :near] = is_rim[: size * 3 // 4, -near:] = True
    bump = np.exp(-(axis[None, :] ** 2) - axis[:, None] ** 2)
    shares = np.stack([region.reshape(-1) / region.sum() for region in (is_middle, is_rim)])
    return Regions(
        np.flatnonzero(is_middle),
        np.asfortranarray(shares.T),
        shares.sum(axis=0),
        np.full(size * size, 1.0 / size**2),
        (prior * (bump - bump.mean()) / bump.std()).reshape(-1),
        evenness * np.eye(3),
    )


def hand_likeness(patches: NDArray[np.uint8], regions: Regions) -> NDArray[np.uint8]:
    """Patches, uint8 (n, size, size, 3), each along the colour direction in which its middle differs from its rim,
    stretched to 0 to 255: uint8 (n, size, size)."""
    count, size = patches.shape[:2]
    # Channel by channel in memory: products of few rows are then quick.
    planes = np.ascontiguousarray(patches.reshape(count, size * size, 3).transpose(0, 2, 1))
    colours = np.asarray(cv2.LUT(planes.reshape(3 * count, -1), _square_roots()), np.float64)
    colours = colours.reshape(count, 3, -1)
    # Products of each patch by itself: in one of all together, what a patch gives would depend on the others' number,
    # by a rounding error that can move a pixel over the threshold.
    centres = colours @ regions.shares
    # The scatter round both centres: the mean products less the products of the means.
    scatter = (colours * regions.both) @ colours.transpose(0, 2, 1)
    scatter -= centres @ centres.transpose(0, 2, 1)
    scatter += regions.evenness
    differences = centres[..., :1] - centres[..., 1:]
    directions = np.empty((count, 3, 1))
    for direction, one, difference in zip(directions, scatter, differences, strict=True):
        cv2.solve(one, difference, direction, cv2.DECOMP_CHOLESKY)
    return _stretched(directions.transpose(0, 2, 1) @ colours, regions).reshape(count, size, size)


def _stretched(values: NDArray[np.float64], regions: Regions) -> NDArray[np.uint8]:
    """Rows of (n, 1, p), in deviations from their means and with the bump on it, brought to 0 to 255; written to."""
    values -= (values @ regions.even)[..., None]
    deviations = np.sqrt(np.square(values) @ regions.even)
    # Of a flat patch nothing but the bump is left.
    deviations[deviations <= FLAT] = np.inf
    values /= deviations[..., None]
    values += regions.bump
    values -= values.min(axis=2, keepdims=True)
    values *= 255.0 / np.maximum(values.max(axis=2, keepdims=True), FLAT)
    return values.astype(np.uint8)
