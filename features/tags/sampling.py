"""The cells of a tag in a grey picture: means of places between pixels, blur taken back."""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Float

SHARPENING: Final = 0.25
"""How much of the difference between a cell and each of its four neighbours is added to it, as AprilTag 3 has it."""

PLACES: Final = (0.3, 0.5, 0.7)
"""Where a cell is looked at, both ways, as a share of its side."""

OUTLINE_PX: Final = 0.5
"""How far an outline of whole pixels lies inside the black square whose pixels it passes through."""


def grown(outlines: Float, pixels: float) -> Float:
    """Outlines (k, 4, 2) about their middle, so many pixels larger on every side."""
    middle = outlines.mean(axis=1, keepdims=True)
    diagonals = outlines[:, 2] - outlines[:, 0], outlines[:, 3] - outlines[:, 1]
    area = 0.5 * np.abs(diagonals[0][:, 0] * diagonals[1][:, 1] - diagonals[0][:, 1] * diagonals[1][:, 0])
    larger = 1.0 + 2.0 * pixels / np.sqrt(np.maximum(area, 1.0))
    return np.asarray(middle + (outlines - middle) * larger[:, None, None], np.float32)


def cell_values(grey: NDArray[np.uint8], outlines: Float, count: int, places: tuple[float, ...]) -> Float:
    """Grey levels of the cells of tags, float32 (k, count + 2, count + 2), with the ring of cells around each.

    grey: (h, w). outlines: (k, 4, 2), from the upper left corner on. places: in a cell, 0 to 1, both ways.
    """
    steps = (np.arange(-1, count + 1)[:, None] + np.array(places)).ravel() / count
    u, v = (part.ravel().astype(np.float32) for part in np.meshgrid(steps, steps))
    x, y = _mapped(np.asarray(outlines, np.float32), u, v)
    # A map may have no more than 32,767 columns; a row is a tag.
    seen = cv2.remap(grey, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    side, fine = count + 2, len(places)
    return np.asarray(
        seen.reshape(-1, side, fine, side, fine).astype(np.float32).mean(axis=(2, 4)), np.float32
    )


def _mapped(outlines: Float, u: Float, v: Float) -> tuple[Float, Float]:
    """Where the places (u, v) (n,) of the unit square are in each outline, two (k, n): the projective mapping of
    a square to four corners in closed form (Heckbert, "Fundamentals of texture mapping", 1989, 2.2.3)."""
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = (outlines[:, corner].T for corner in range(4))
    sum_x, sum_y = x0 - x1 + x2 - x3, y0 - y1 + y2 - y3
    dx1, dy1, dx2, dy2 = x1 - x2, y1 - y2, x3 - x2, y3 - y2
    whole = dx1 * dy2 - dx2 * dy1
    whole = np.where(np.abs(whole) < 1e-6, np.float32(1e-6), whole)
    g, h = (sum_x * dy2 - dx2 * sum_y) / whole, (dx1 * sum_y - sum_x * dy1) / whole
    below = g[:, None] * u + h[:, None] * v + 1.0
    below = np.where(np.abs(below) < 1e-3, np.float32(1e-3), below)
    x = ((x1 - x0 + g * x1)[:, None] * u + (x3 - x0 + h * x3)[:, None] * v + x0[:, None]) / below
    y = ((y1 - y0 + g * y1)[:, None] * u + (y3 - y0 + h * y3)[:, None] * v + y0[:, None]) / below
    return np.asarray(x, np.float32), np.asarray(y, np.float32)


def sharpened(values: Float) -> Float:
    """Cells (k, n, n), without the ring around them (k, n + 2, n + 2), blur taken back."""
    inner = values[:, 1:-1, 1:-1]
    beside = values[:, :-2, 1:-1] + values[:, 2:, 1:-1] + values[:, 1:-1, :-2] + values[:, 1:-1, 2:]
    return np.asarray(inner + SHARPENING * (4.0 * inner - beside), np.float32)
