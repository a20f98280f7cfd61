"""Histograms of oriented gradients of a batch of patches.

Dalal and Triggs, "Histograms of Oriented Gradients for Human Detection", CVPR 2005: square-root compression,
centred differences without smoothing, the channel with the strongest gradient at each pixel, votes shared
between neighbouring bins and cells, overlapping blocks of 2 × 2 cells with L2-Hys normalisation. Shading and cast
change gradients by a factor, and the blocks divide it out.
"""

from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float


@dataclass(frozen=True, slots=True)
class HogSettings:
    """What is counted."""

    rim: int = 2
    """Pixels left out along each side of the patch: a hand's box leaves little of a hand there."""
    cell: int = 4
    """Side of a cell in pixels, 3 to 16; it must divide what is left of the patch's side."""
    bins: int = 8
    """Directions between 0 and 180° (0 and 360° if `signed`), 4 to 18."""
    signed: bool = False
    """Tell dark-to-bright from bright-to-dark. Without it a hand reads the same before a dark wall and before a bright
    window."""
    clip: float = 0.2
    """Largest share of one entry in its block's norm, 0.1 to 1 (Lowe's 0.2)."""
    floor: float = 0.1
    """Added to a block's norm, in units of the compressed picture (0 to 1); below it a block is noise."""


def hog_length(size: int, settings: HogSettings | None = None) -> int:
    """Numbers a patch of `size` × `size` pixels gives. Raises ValueError if cells do not fit the size."""
    settings = settings or HogSettings()
    inner = size - 2 * settings.rim
    if inner % settings.cell or inner < 2 * settings.cell:
        raise ValueError(
            f"a patch of {size} pixels less a rim of {settings.rim} does not hold whole cells of {settings.cell}; "
            "at least two must fit"
        )
    return 4 * settings.bins * (inner // settings.cell - 1) ** 2


def hog(patches: NDArray[np.uint8], settings: HogSettings | None = None) -> Float:
    """Descriptors of patches, float32 (n, `hog_length`), each entry in 0 to 1.

    patches: uint8 (n, size, size, channels). Order of the entries: block row, block column, cell row and column in
    the block, bin; bin 0 is a gradient along x.
    """
    settings = settings or HogSettings()
    length = hog_length(patches.shape[1], settings)
    inner = slice(settings.rim, patches.shape[1] - settings.rim)
    # Channel by channel in memory.
    planes = np.ascontiguousarray(patches[:, inner, inner].transpose(3, 0, 1, 2))
    count, size = planes.shape[1:3]
    pooling = _pooling(size, settings.cell)
    cells = len(pooling)
    votes = _votes(planes, settings).reshape(count, size, size * settings.bins)
    rows = (pooling @ votes).reshape(count, cells, size, settings.bins)
    histograms = np.asarray(pooling @ rows, np.float32)
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


def _differences(values: Float, step: int, shape: tuple[int, ...]) -> Float:
    """Of the values so many places on and so many back, all in one row; nothing at both ends of it."""
    row = values.reshape(-1)
    differences = np.empty_like(row)
    np.subtract(row[2 * step :], row[: -2 * step], out=differences[step:-step])
    return differences.reshape(shape)


def _gradients(planes: NDArray[np.uint8]) -> tuple[Float, Float, Float]:
    """Centred differences along x and y of the channel in which they are largest, and the sum of their squares there,
    float32 (n, size, size) each."""
    channels, _, size = planes.shape[:3]
    compressed = np.asarray(cv2.LUT(planes.reshape(-1, size), _square_roots()), np.float32)
    along_x, along_y = _differences(compressed, 1, planes.shape), _differences(compressed, size, planes.shape)
    # No pixel of the edge has two neighbours across it.
    along_x[..., :: size - 1] = 0.0
    along_y[..., :: size - 1, :] = 0.0
    squared = along_x * along_x + along_y * along_y
    strongest_x, strongest_y, largest = along_x[0], along_y[0], squared[0]
    for channel in range(1, channels):
        # OpenCV copies through a mask several times as fast as NumPy does.
        mask = (squared[channel] > largest).view(np.uint8).reshape(-1, size)
        for strongest, along in ((strongest_x, along_x), (strongest_y, along_y)):
            cv2.copyTo(along[channel].reshape(-1, size), mask, strongest.reshape(-1, size))
        np.maximum(largest, squared[channel], out=largest)
    return strongest_x, strongest_y, largest


def _votes(planes: NDArray[np.uint8], settings: HogSettings) -> Float:
    """Gradient magnitude shared between the two nearest directions, float32 (n, size, size, bins)."""
    along_x, along_y, squared = _gradients(planes)
    bins = settings.bins
    position = np.arctan2(along_y, along_x).reshape(-1)
    position *= np.float32(bins / (2.0 * np.pi if settings.signed else np.pi))
    # Positive; the bins of a turn more are the same bins.
    position += np.float32(bins)
    whole = np.floor(position)
    lower = whole.astype(np.intp)
    position -= whole
    magnitude = np.sqrt(squared, out=squared).reshape(-1)
    upper_share = np.multiply(magnitude, position, out=position)
    magnitude -= upper_share
    votes = np.zeros(len(lower) * bins, np.float32)
    first = np.arange(0, len(votes), bins)
    turns = _turns(bins)
    # Neighbouring bins are two, so that neither vote overwrites the other.
    votes[first + turns.take(lower)] = magnitude
    lower += 1
    votes[first + turns.take(lower)] = upper_share
    return votes.reshape(*along_x.shape, bins)


@lru_cache(maxsize=8)
def _turns(bins: int) -> NDArray[np.intp]:
    """The bin of each position from 0 to over two turns."""
    return np.arange(2 * bins + 2) % bins


def _normalised_blocks(cells: Float, settings: HogSettings) -> Float:
    """L2-Hys of blocks of 2 × 2 cells, float32 (n, blocks, 4 bins), from (n, cells, cells, bins)."""
    places = _block_places(*cells.shape[2:])
    blocks = cells.reshape(len(cells), -1).take(places, axis=1)
    energy = np.einsum("nbe,nbe->nb", blocks, blocks)
    energy += np.float32(settings.floor**2)
    blocks /= np.sqrt(energy, out=energy)[..., None]
    np.minimum(blocks, np.float32(settings.clip), out=blocks)
    energy = np.einsum("nbe,nbe->nb", blocks, blocks)
    energy += np.float32(1e-6)
    blocks /= np.sqrt(energy, out=energy)[..., None]
    return blocks


@lru_cache(maxsize=8)
def _block_places(cells: int, bins: int) -> NDArray[np.intp]:
    """Where in the histograms of (cells, cells, bins) the entries of each block are, intp (blocks, 4 bins)."""
    numbers = np.arange(cells * cells * bins).reshape(cells, cells, bins)
    windows = np.lib.stride_tricks.sliding_window_view(numbers, (2, 2), axis=(0, 1))
    return np.ascontiguousarray(windows.transpose(0, 1, 3, 4, 2)).reshape((cells - 1) ** 2, 4 * bins)
