"""Contact sheets of failures: every tile a picture with the labels in green and the readings in red."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.scorer import Reading
from lightgesture.features.types import Box
from lightgesture.results.atomic import replacing
from lightgesture.training.datasets import Label

Image = NDArray[np.uint8]

TILE_WIDTH = 320
"""Pixels: wide enough to tell a thumb from a finger in a frame of 640."""

TILE_HEIGHT = 240
"""Pixels, for the 4:3 of most frames; other shapes are fitted in and centred."""

COLUMNS = 5
"""Tiles side by side: 1600 pixels."""

MAX_TILES = 60
"""Tiles of one sheet; of more failures, evenly spaced ones are shown."""

GREEN = (60, 220, 60)
RED = (60, 60, 255)
WHITE = (255, 255, 255)
FONT_SCALE = 0.45
"""About 10 pixels high."""

CAPTION = 40
"""Characters of a caption that fit into a tile; its end tells more than its beginning."""


def draw_tile(image: Image, labels: Sequence[Label], readings: Sequence[Reading], caption: str) -> Image:
    """Fit a picture into a tile and draw labels and readings; uint8 (240, 320, 3)."""
    height, width = image.shape[:2]
    scale = min(TILE_WIDTH / width, TILE_HEIGHT / height)
    size = max(1, round(width * scale)), max(1, round(height * scale))
    fitted = cv2.resize(image, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    tile = np.zeros((TILE_HEIGHT, TILE_WIDTH, 3), np.uint8)
    left, top = (TILE_WIDTH - size[0]) // 2, (TILE_HEIGHT - size[1]) // 2
    tile[top : top + size[1], left : left + size[0]] = fitted
    for label in labels:
        _draw_box(tile, label.box, scale, (left, top), GREEN, label.token or "?", at_top=True)
    for reading in readings:
        text = f"{(reading.side or '?')[0]}:{reading.token or '-'}"
        _draw_box(tile, reading.box, scale, (left, top), RED, text, at_top=False)
    write(tile, caption[-CAPTION:], (4, 12), WHITE)
    return tile


def write(image: Image, text: str, place: tuple[int, int], colour: tuple[int, int, int]) -> None:
    """Write into the picture itself; place is the lower left corner."""
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, FONT_SCALE, colour, 1, cv2.LINE_AA)


def _draw_box(
    tile: Image,
    box: Box,
    scale: float,
    offset: tuple[int, int],
    colour: tuple[int, int, int],
    text: str,
    at_top: bool,
) -> None:
    x, y = round(box[0] * scale) + offset[0], round(box[1] * scale) + offset[1]
    right, bottom = x + round(box[2] * scale), y + round(box[3] * scale)
    cv2.rectangle(tile, (x, y), (right, bottom), colour, 1)
    place = (x, max(24, y - 4)) if at_top else (x, min(TILE_HEIGHT - 3, bottom + 13))
    write(tile, text, place, colour)


def choose_evenly(count: int, limit: int = MAX_TILES) -> list[int]:
    """At most `limit` indices below `count`, evenly spaced."""
    if count <= limit:
        return list(range(count))
    return [index * count // limit for index in range(limit)]


def save_sheet(path: Path, tiles: Sequence[Image]) -> None:
    """Write tiles as one picture of the kind of the path's suffix, whole or not at all; without tiles, nothing."""
    if tiles:
        save_picture(path, arranged(tiles))


def arranged(tiles: Sequence[Image], columns: int = COLUMNS) -> Image:
    """At least one tile, all of one size, as rows of a picture; black where the last row has none."""
    missing = -len(tiles) % columns
    cells = [*tiles, *[np.zeros_like(tiles[0])] * missing]
    return np.vstack([np.hstack(cells[start : start + columns]) for start in range(0, len(cells), columns)])


def save_picture(path: Path, picture: Image) -> None:
    """Write a picture of the kind of the path's suffix, whole or not at all."""
    coded, content = cv2.imencode(path.suffix, picture)
    if not coded:
        raise ValueError(f"{path}: OpenCV could not encode the picture")
    with replacing(path) as temporary:
        temporary.write_bytes(content.tobytes())
