"""The drawings of the signs that come with the package, as polygons; `synth/drawings.py` makes them."""

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final, Literal

from lightgesture.models.classes import CLASSES

FOLDER: Final = Path(__file__).resolve().parents[1] / "data" / "hands"
SIDE: Final = 400
"""Width and height of a drawing in its own units."""

Kind = Literal["bare", "gloved"]
KINDS: Final[tuple[Kind, ...]] = ("bare", "gloved")

_PATH = re.compile(r'<path fill="(#[0-9a-f]{6})" fill-rule="evenodd" d="([^"]*)"/>')

Polygon = tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class Layer:
    """Polygons of one colour (`#rrggbb`), filled by the even-odd rule."""

    colour: str
    polygons: tuple[Polygon, ...]


@dataclass(frozen=True, slots=True)
class Drawing:
    """A left hand as a mirror shows it, layers from back to front."""

    layers: tuple[Layer, ...]

    def mirrored(self) -> "Drawing":
        """The right hand."""
        return Drawing(
            tuple(
                Layer(layer.colour, tuple(tuple((SIDE - x, y) for x, y in one) for one in layer.polygons))
                for layer in self.layers
            )
        )


def drawing_file(token: str, kind: Kind = "bare") -> Path | None:
    """The file of a token's drawing; None for a token of somebody's own, which has none."""
    return FOLDER / f"{token}-{kind}.svg" if token in CLASSES else None


@cache
def load_drawing(token: str, side: str, kind: Kind = "bare") -> Drawing | None:
    """The drawing of a token, side "left" or "right"; None where there is none."""
    file = drawing_file(token, kind)
    if file is None or not file.is_file():
        return None
    layers = tuple(
        Layer(colour, tuple(_polygon(part) for part in path.split("M")[1:]))
        for colour, path in _PATH.findall(file.read_text(encoding="utf-8"))
    )
    drawing = Drawing(layers)
    return drawing if side == "left" else drawing.mirrored()


def _polygon(part: str) -> Polygon:
    points = (point.split() for point in part.removesuffix("Z").split("L"))
    return tuple((int(x), int(y)) for x, y in points)
