"""Histograms of oriented gradients of a batch of patches, in NumPy.

Dalal and Triggs, "Histograms of Oriented Gradients for Human Detection", CVPR 2005: square-root compression,
centred differences without smoothing, the channel with the strongest gradient at each pixel, votes shared
between neighbouring bins and cells, overlapping blocks of 2 × 2 cells with L2-Hys normalisation. Shading and cast
change gradients by a factor, and the blocks divide it out.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class HogSettings:
    """What is counted.

    cell: side of a cell in pixels, 3 to 16; it must divide the patch's side.
    bins: directions between 0 and 180° (0 and 360° if `signed`), 4 to 18.
    signed: tell dark-to-bright from bright-to-dark. Without it a hand reads the same before a dark wall and
        before a bright window.
    clip: largest share of one entry in its block's norm, 0.1 to 1 (Lowe's 0.2).
    floor: added to a block's norm, in units of the compressed picture (0 to 1); below it a block is noise.
    """

    cell: int = 6
    bins: int = 9
    signed: bool = False
    clip: float = 0.2
    floor: float = 0.1


def hog_length(size: int, settings: HogSettings | None = None) -> int:
    """Numbers a patch of `size` × `size` pixels gives. Raises ValueError if cells do not fit the size."""
    settings = settings or HogSettings()
    if size % settings.cell or size < 2 * settings.cell:
        raise ValueError(
            f"a patch of {size} pixels does not hold whole cells of {settings.cell}; at least two must fit"
        )
    return 4 * settings.bins * (size // settings.cell - 1) ** 2


def hog(patches: NDArray[np.uint8], settings: HogSettings | None = None) -> Float:
    """Descriptors of patches, float32 (n, `hog_length`), each entry in 0 to 1.

    patches: uint8 (n, size, size, channels). Order of the entries: block row, block column, cell row and column in
    the block, bin; bin 0 is a gradient along x.
    """
    settings = settings or HogSettings()
    count, size = patches.shape[:2]
    length = hog_length(size, settings)
    pooling = _pooling(size, settings.cell)
    histograms = np.asarray(pooling @ _votes(patches, settings) @ pooling.T, np.float32)
    return _normalised_blocks(histograms, settings).reshape(count, length)


@lru_cache(maxsize=8)
def _pooling(size: int, cell: int) -> Float:
    """Share of each pixel row in each cell row, float32 (size / cell, size): linear between cell centres."""
    pixels = (np.arange(size, dtype=np.float32) + 0.5) / cell
    cells = np.arange(size // cell, dtype=np.float32) + 0.5
    return np.asarray(np.maximum(0.0, 1.0 - np.abs(pixels[None, :] - cells[:, None])), np.float32)


@lru_cache(maxsize=1)
def _square_roots() -> Float:
    return np.asarray(np.sqrt(np.arange(256) / 255.0), np.float32)


def _gradients(patches: NDArray[np.uint8]) -> tuple[Float, Float]:
    """Centred differences along x and y of the channel in which they are largest, float32 (n, size, size)."""
    compressed = _square_roots()[np.moveaxis(patches, 3, 0)]
    along_x, along_y = np.zeros_like(compressed), np.zeros_like(compressed)
    np.subtract(compressed[..., 2:], compressed[..., :-2], out=along_x[..., 1:-1])
    np.subtract(compressed[..., 2:, :], compressed[..., :-2, :], out=along_y[..., 1:-1, :])
    squared = along_x * along_x + along_y * along_y
    strongest_x, strongest_y, largest = along_x[0], along_y[0], squared[0]
    for channel in range(1, len(squared)):
        stronger = squared[channel] > largest
        strongest_x = np.where(stronger, along_x[channel], strongest_x)
        strongest_y = np.where(stronger, along_y[channel], strongest_y)
        largest = np.maximum(largest, squared[channel])
    return strongest_x, strongest_y


def _votes(patches: NDArray[np.uint8], settings: HogSettings) -> Float:
    """Gradient magnitude shared between the two nearest directions, float32 (n, bins, size, size)."""
    along_x, along_y = _gradients(patches)
    turn = np.float32(2.0 * np.pi if settings.signed else np.pi)
    position = np.arctan2(along_y, along_x) * np.float32(settings.bins / turn)
    position = np.where(position < 0, position + np.float32(settings.bins), position)
    magnitude = np.sqrt(along_x * along_x + along_y * along_y)
    bins = np.arange(settings.bins, dtype=np.float32)[:, None, None]
    distance = np.abs(position[:, None] - bins)
    np.minimum(distance, settings.bins - distance, out=distance)
    votes = np.subtract(np.float32(1.0), distance, out=distance)
    np.maximum(votes, np.float32(0.0), out=votes)
    return np.asarray(np.multiply(votes, magnitude[:, None], out=votes), np.float32)


def _normalised_blocks(histograms: Float, settings: HogSettings) -> Float:
    """L2-Hys of blocks of 2 × 2 cells, float32 (n, cells - 1, cells - 1, 2, 2, bins), from (n, bins, cells, cells)."""
    cells = np.moveaxis(histograms, 1, -1)
    top = np.stack([cells[:, :-1, :-1], cells[:, :-1, 1:]], axis=3)
    bottom = np.stack([cells[:, 1:, :-1], cells[:, 1:, 1:]], axis=3)
    blocks = np.stack([top, bottom], axis=3)
    floor = np.float32(settings.floor)
    norm = np.sqrt((blocks**2).sum(axis=(3, 4, 5), keepdims=True) + floor**2)
    blocks = np.minimum(blocks / norm, np.float32(settings.clip))
    norm = np.sqrt((blocks**2).sum(axis=(3, 4, 5), keepdims=True) + np.float32(1e-6))
    return np.asarray(blocks / norm, np.float32)
