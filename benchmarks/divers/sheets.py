"""What is shown of an evaluation of divers: every missed sign, every one misread in its box, every stray token."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final, TypeVar

from lightgesture.benchmarks.accuracy import Failure, sheet_name
from lightgesture.benchmarks.contact_sheet import MAX_TILES, TILE_HEIGHT, TILE_WIDTH, Image, draw_tile
from lightgesture.benchmarks.divers.pictures import TOKENS, DiverFrame
from lightgesture.benchmarks.divers.rows import HandRow, by_method
from lightgesture.benchmarks.divers.scoring import Scored
from lightgesture.benchmarks.scorer import Reading
from lightgesture.sources import read_picture
from lightgesture.training.datasets import Label

ZOOM: Final = 2.4
"""Side of what is shown round a hand in its given box, over the box's."""

Tile = TypeVar("Tile")


def failures(scored: Scored, frames: Sequence[DiverFrame]) -> dict[str, list[Failure]]:
    """Whole pictures by sheet: `missed`, of each shown sign that was not read; `stray`, with a token where none is."""
    paths = {frame.file: frame.path for frame in frames}
    sheets: dict[str, list[Failure]] = {}
    labels: dict[tuple[str, str], list[Label]] = {}
    for row in scored.hands:
        labels.setdefault((row.method, row.file), []).append(_label(row))
    for method, hands in by_method(scored.hands).items():
        missed = [
            Failure(paths[row.file], (_label(row),), scored.readings[method, row.file], _caption(row))
            for row in hands
            if row.shape in TOKENS and row.found_token != row.shape
        ]
        sheets |= _parted("missed", method, missed)
    for method, rows in by_method(scored.frames).items():
        stray = [
            Failure(
                paths[row.file],
                tuple(labels.get((method, row.file), ())),
                scored.readings[method, row.file],
                Path(row.file).name,
            )
            for row in rows
            if row.stray
        ]
        sheets |= _parted("stray", method, stray)
    return sheets


def given_tiles(scored: Scored, frames: Sequence[DiverFrame]) -> dict[str, list[Image]]:
    """Hands by sheet, drawn: each shown sign that was not read in its given box, with the likeliest token."""
    paths = {frame.file: frame.path for frame in frames}
    sheets: dict[str, list[Image]] = {}
    for method, hands in by_method(scored.hands).items():
        tiles = [
            _given_tile(read_picture(paths[row.file]), row)
            for row in hands
            if row.shape in TOKENS and row.given_token != row.shape
        ]
        sheets |= _parted("given", method, tiles)
    return sheets


def _given_tile(image: Image, row: HandRow) -> Image:
    """The hand and what is around it, in the shape of a tile."""
    width = ZOOM * max(row.w, row.h * TILE_WIDTH / TILE_HEIGHT)
    height = width * TILE_HEIGHT / TILE_WIDTH
    left = max(0, round(row.x + row.w / 2 - width / 2))
    top = max(0, round(row.y + row.h / 2 - height / 2))
    part = image[top : top + max(1, round(height)), left : left + max(1, round(width))]
    box = (row.x - left, row.y - top, row.w, row.h)
    reading = Reading(box, row.side, f"{row.named} {row.p_named:.2f}")
    return draw_tile(part, (Label(box, None, row.shape),), (reading,), _caption(row))


def _parted(kind: str, method: str, tiles: Sequence[Tile]) -> dict[str, list[Tile]]:
    """As many sheets as it takes to show all."""
    starts = range(0, len(tiles), MAX_TILES)
    return {
        sheet_name("divers", kind, method, str(number)): list(tiles[start : start + MAX_TILES])
        for number, start in enumerate(starts, 1)
    }


def _label(row: HandRow) -> Label:
    return Label((row.x, row.y, row.w, row.h), None, row.shape)


def _caption(row: HandRow) -> str:
    return f"{row.glove} {row.view} {Path(row.file).stem}"
