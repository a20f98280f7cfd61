"""A small drawing for each word of a card, so that it is found and understood without reading."""

from typing import Final

Point = tuple[float, float]
Stroke = tuple[Point, ...]
"""A line through points, x to the right and y down, 0 to 1 each."""


def _ring(x: float, y: float, radius: float, corners: int = 24, turn: float = 0.0) -> Stroke:
    """A closed regular polygon, near enough a circle with many corners. turn: of its first corner, in turns."""
    from math import cos, pi, sin

    angles = [2 * pi * (turn + step / corners) for step in range(corners + 1)]
    return tuple((x + radius * cos(angle), y + radius * sin(angle)) for angle in angles)


def _arrow(start: Point, end: Point, head: float = 0.16) -> tuple[Stroke, ...]:
    """A line with a head at its end."""
    (x0, y0), (x1, y1) = start, end
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    dx, dy = (x1 - x0) / length * head, (y1 - y0) / length * head
    return (start, end), ((x1 - dx - dy, y1 - dy + dx), end, (x1 - dx + dy, y1 - dy - dx))


def _vehicle(x: float, y: float) -> tuple[Stroke, ...]:
    """The robot: a box with a dome."""
    box = ((x - 0.2, y - 0.1), (x + 0.2, y - 0.1), (x + 0.2, y + 0.1), (x - 0.2, y + 0.1), (x - 0.2, y - 0.1))
    return box, _ring(x + 0.1, y, 0.06)


def _person(x: float, y: float) -> tuple[Stroke, ...]:
    """The diver: a head and a body."""
    return (
        _ring(x, y - 0.12, 0.07),
        ((x, y - 0.05), (x, y + 0.16)),
        ((x - 0.1, y + 0.02), (x + 0.1, y + 0.02)),
    )


_CROSS: Final = (((0.2, 0.2), (0.8, 0.8)), ((0.8, 0.2), (0.2, 0.8)))
_WAVES: Final = (
    tuple((0.1 + 0.1 * step, 0.82 + (0.05 if step % 2 else 0.0)) for step in range(9)),
)  # fmt: skip
_PAGE: Final = ((0.3, 0.1), (0.7, 0.1), (0.7, 0.6), (0.3, 0.6), (0.3, 0.1))

DRAWINGS: Final[dict[str, tuple[Stroke, ...]]] = {
    "STOP": (_ring(0.5, 0.5, 0.42, 8, 1 / 16), ((0.25, 0.5), (0.75, 0.5))),
    "CONTD": (_ring(0.3, 0.5, 0.2), *_arrow((0.5, 0.5), (0.92, 0.5))),
    "GO": (((0.28, 0.15), (0.82, 0.5), (0.28, 0.85), (0.28, 0.15)),),
    "AND": (((0.5, 0.15), (0.5, 0.85)), ((0.15, 0.5), (0.85, 0.5))),
    "HOVER": (*_vehicle(0.5, 0.5), *_WAVES, ((0.3, 0.25), (0.7, 0.25))),
    "FOLLOW": (*_person(0.78, 0.5), *_vehicle(0.22, 0.5), *_arrow((0.45, 0.5), (0.65, 0.5), 0.08)),
    "LEFT": _arrow((0.9, 0.5), (0.1, 0.5)),
    "RIGHT": _arrow((0.1, 0.5), (0.9, 0.5)),
    "UP": _arrow((0.5, 0.9), (0.5, 0.1)),
    "DOWN": _arrow((0.5, 0.1), (0.5, 0.9)),
    "EXEC": (_PAGE, ((0.38, 0.25), (0.62, 0.25)), ((0.38, 0.38), (0.62, 0.38)), *_arrow((0.5, 0.6), (0.5, 0.92))),
    "SNAP": (
        ((0.1, 0.3), (0.9, 0.3), (0.9, 0.8), (0.1, 0.8), (0.1, 0.3)),
        _ring(0.5, 0.55, 0.17),
        ((0.3, 0.3), (0.36, 0.2), (0.56, 0.2), (0.62, 0.3)),
    ),
    "INCREASE": (*_arrow((0.3, 0.9), (0.3, 0.1)), ((0.75, 0.3), (0.75, 0.7)), ((0.55, 0.5), (0.95, 0.5))),
    "DECREASE": (*_arrow((0.3, 0.1), (0.3, 0.9)), ((0.55, 0.5), (0.95, 0.5))),
    "DEFAULT": (_ring(0.5, 0.5, 0.38), ((0.5, 0.5), (0.5, 0.12)), _ring(0.5, 0.5, 0.05)),
    "CANCEL": _CROSS,
    "PARAM": (
        ((0.15, 0.3), (0.85, 0.3)), _ring(0.35, 0.3, 0.08), ((0.15, 0.7), (0.85, 0.7)), _ring(0.65, 0.7, 0.08),
    ),
}  # fmt: skip
"""Word -> strokes; of words that carry a number that of the word alone."""


def strokes_of(word: str) -> tuple[Stroke, ...]:
    """The drawing of a word; of a digit so many dots; a ring for a word of somebody's own."""
    if word.isdigit():
        count = int(word)
        places = [(0.2 + 0.3 * (dot % 3), 0.2 + 0.3 * (dot // 3)) for dot in range(count)]
        return tuple(_ring(x, y, 0.1) for x, y in places) or (_ring(0.5, 0.5, 0.38),)
    name = word.partition(" ")[0]
    return DRAWINGS.get(name, (_ring(0.5, 0.5, 0.3),))
