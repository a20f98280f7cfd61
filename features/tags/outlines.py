"""Tags by the cells of outlines: which id an outline shows, where OpenCV could not say.

OpenCV cuts an outline into whole pixels before it reads it, which small and blurred tags do not survive. Here each cell
is a mean of the grey picture at places between pixels, and blur is taken back as AprilTag 3 does it (Krogius,
Haggenmiller and Olson, IROS 2019): each cell less its neighbours.
"""

from functools import cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.tags.sampling import PLACES, cell_values, sharpened
from lightgesture.features.tags.tag import cells_of, dictionary
from lightgesture.features.types import Float

RING_SHARE: Final = 0.9
"""Least share of the cells of the black ring that are darker than the white edge: an outline with less is no tag."""

ALONG: Final = (0.2, 0.5, 0.8)
"""Where on each side of an outline it is looked at first."""

ROUNDS: Final = 3
"""Rounds in which white and black are told apart (Ridler and Calvard, IEEE Trans. SMC 8(8), 1978)."""


def read_outlines(
    grey: NDArray[np.uint8], outlines: Float, family: str, least_margin: float
) -> list[tuple[int, Float]]:
    """The id that each outline with a black ring shows best, and its corners as `Tag` has them; it may be none.

    grey: (h, w). outlines: float32 (k, 4, 2), clockwise.
    """
    count = dictionary(family).markerSize + 2
    outlines = framed(grey, outlines, count, least_margin) if len(outlines) else outlines
    if not len(outlines):
        return []
    values = sharpened(cell_values(grey, outlines, count, PLACES))
    signs = np.where(_is_white(values), 1.0, -1.0).reshape(len(values), -1).astype(np.float32)
    best = (signs @ _codes(family).T).argmax(axis=1)
    return [
        (int(place // 4), np.roll(outline, int(place % 4), axis=0))
        for place, outline in zip(best, outlines, strict=True)
    ]


def dark_inside(grey: NDArray[np.uint8], outlines: Float, family: str, least_margin: float) -> Float:
    """Those of the outlines (k, 4, 2) that are darker just inside than just outside, by a few places of each side: most
    of a reef's are passed over so before their cells are looked at. grey: (h, w)."""
    if not len(outlines):
        return outlines
    places = np.rint(_beside(family) @ outlines).astype(np.intp)
    rows, columns = grey.shape
    x, y = places[..., 0].clip(0, columns - 1), places[..., 1].clip(0, rows - 1)
    levels = grey[y, x].reshape(len(outlines), 2, -1).mean(axis=2)
    is_darker = levels[:, 1] - levels[:, 0] >= 2.0 * least_margin
    return np.asarray(outlines[is_darker], np.float32)


@cache
def _beside(family: str) -> Float:
    """Places along the four sides, the middle of a cell inside and then as far outside, as weights of the corners,
    (2 × 4 × len(ALONG), 4)."""
    half = 0.5 / (dictionary(family).markerSize + 2)
    along, found = np.array(ALONG), []
    for share in (half, -half):
        low, high = np.full_like(along, share), np.full_like(along, 1.0 - share)
        u, v = np.concatenate([along, along, low, high]), np.concatenate([low, high, along, along])
        found.append(np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=-1))
    return np.concatenate(found).astype(np.float32)


def framed(grey: NDArray[np.uint8], outlines: Float, count: int, least_margin: float) -> Float:
    """Those of the outlines (k, 4, 2) whose ring of cells is black and has white around it, as a tag's."""
    values = cell_values(grey, outlines, count, PLACES[1:2])
    ring, edge = _ring(values[:, 1:-1, 1:-1]), np.median(_ring(values), axis=1)
    middle = 0.5 * (ring.mean(axis=1) + edge)
    is_black = (ring < middle[:, None]).mean(axis=1) >= RING_SHARE
    is_clear = edge - ring.mean(axis=1) >= 2.0 * least_margin
    return np.asarray(outlines[is_black & is_clear], np.float32)


def _ring(cells: Float) -> Float:
    """The outermost cells, (k, n), of (k, side, side)."""
    side = cells.shape[1]
    inside = np.zeros((side, side), bool)
    inside[1:-1, 1:-1] = True
    return np.asarray(cells[:, ~inside])


def _is_white(values: Float) -> NDArray[np.bool_]:
    """Which cells (k, n, n) are white: white and black are told apart halfway between their means."""
    middle = 0.5 * (values.min(axis=(1, 2)) + values.max(axis=(1, 2)))
    for _ in range(ROUNDS):
        is_white = values > middle[:, None, None]
        whites = np.maximum(is_white.sum(axis=(1, 2)), 1)
        blacks = np.maximum((~is_white).sum(axis=(1, 2)), 1)
        white = np.where(is_white, values, 0.0).sum(axis=(1, 2)) / whites
        black = np.where(is_white, 0.0, values).sum(axis=(1, 2)) / blacks
        middle = 0.5 * (white + black)
    return np.asarray(values > middle[:, None, None])


@cache
def _codes(family: str) -> Float:
    """Cells of the family's tags, 1 white and -1 black, (4 × ids, n × n): each as seen turned by no, one, two and
    three quarters anticlockwise."""
    numbers = range(len(dictionary(family).bytesList))
    turned = [np.rot90(cells_of(family, number), quarters) for number in numbers for quarters in range(4)]
    return np.where(np.array(turned), 1.0, -1.0).reshape(len(turned), -1).astype(np.float32)
