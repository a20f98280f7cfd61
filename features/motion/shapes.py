"""The shapes that a moved tag can draw: those that come with the package, and files of one's own.

All are seen with the diver's own eyes: x to the diver's right, y up. Every shape ends where it begins, so that the hand
is where it was for the next one, and what merely goes elsewhere is no shape.
"""

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Curve = NDArray[np.float64]
"""float64 (n, 2): points of a line in the order in which they are passed, from rest to rest."""

ROUND: Final = 48
"""Points of a circle."""

STARTS: Final = 8
"""Places on a circle where it may be begun."""

MOST_BYTES: Final = 1 << 20
"""Largest file of shapes that is read, bytes; a shape has about 2,000."""

MOST_SHAPES, MOST_POINTS = 64, 1000
"""Most shapes of a file, variants counted, and most points of one."""

NAME_PATTERN: Final = "[a-z][a-z0-9_-]{0,31}"
"""What the name of a shape matches."""


class ShapesError(ValueError):
    """A file of shapes that cannot be used, in one line: what is wrong and what to do."""


def _closed(*points: tuple[float, float]) -> Curve:
    return np.array([*points, points[0]], np.float64)


def _begun_at(corners: Sequence[tuple[float, float]]) -> list[Curve]:
    """A polygon, begun at each of its corners and gone round either way."""
    found = []
    for way in (list(corners), list(reversed(corners))):
        found += [_closed(*way[start:], *way[:start]) for start in range(len(way))]
    return found


def _circles(way: float) -> list[Curve]:
    """A circle begun at several places; way: 1 clockwise, -1 the other way round."""
    angles = np.linspace(0.0, 2 * np.pi, ROUND + 1)
    begun = 2 * np.pi * np.arange(STARTS) / STARTS
    return [np.column_stack([np.sin(way * angles + start), np.cos(way * angles + start)]) for start in begun]


def _there_and_back(x: float, y: float) -> list[Curve]:
    return [np.array([(0.0, 0.0), (x, y), (0.0, 0.0)])]


def _mirrored(curve: Curve) -> Curve:
    return np.asarray(curve * np.array([-1.0, 1.0]))


_ZIGZAG: Final = np.array([(0, 0), (0.4, 1), (0.8, 0), (1.2, 1), (1.6, 0), (0, 0)], np.float64)
_WAVE: Final = np.array([(0, 0), (1, 0), (-1, 0), (1, 0), (-1, 0), (0, 0)], np.float64)

SHAPES: Final[Mapping[str, tuple[Curve, ...]]] = {
    "up": tuple(_there_and_back(0.0, 1.0)),
    "down": tuple(_there_and_back(0.0, -1.0)),
    "left": tuple(_there_and_back(-1.0, 0.0)),
    "right": tuple(_there_and_back(1.0, 0.0)),
    "clockwise": tuple(_circles(1.0)),
    "anticlockwise": tuple(_circles(-1.0)),
    "square": tuple(_begun_at([(0, 0), (0, 1), (1, 1), (1, 0)])),
    "triangle": tuple(_begun_at([(0, 0), (0.5, 0.9), (1, 0)])),
    "zigzag": (_ZIGZAG, _mirrored(_ZIGZAG)),
    "wave": (_WAVE, _mirrored(_WAVE)),
}
"""Name -> the ways in which it may be drawn."""


def load_shapes(path: str | os.PathLike[str] | None) -> dict[str, tuple[Curve, ...]]:
    """The shapes of the package, and those of a file of one's own (`save_shape`), which take the place of these of the
    same name. ShapesError: the file cannot be read or has a wrong layout."""
    shapes = dict(SHAPES)
    if path is not None:
        own: dict[str, list[Curve]] = {}
        for entry in _read(Path(path)):
            own.setdefault(entry["name"], []).append(np.array(entry["points"], np.float64))
        shapes.update({name: tuple(curves) for name, curves in own.items()})
    return shapes


def save_shape(path: Path, name: str, curve: Curve, temporary: Path) -> int:
    """Write to `temporary` what is in the file `path`, if it is there, and one more shape; how many it then has.

    A name that is there already gets another way in which it may be drawn. ShapesError: the file is no file of shapes,
    or is full.
    """
    entries = _read(path) if path.exists() else []
    if len(entries) >= MOST_SHAPES:
        raise ShapesError(f"{path}: has {MOST_SHAPES} shapes, which is the most; begin another file")
    entries.append({"name": name, "points": curve.round(4).tolist()})
    lines = ",\n".join(json.dumps(entry) for entry in entries)
    temporary.write_text(f'{{"shapes": [\n{lines}\n]}}\n', encoding="utf-8")
    return len(entries)


def _read(path: Path) -> list[dict[str, Any]]:
    try:
        with open(path, "rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except OSError as error:
        raise ShapesError(f"{path}: cannot be read ({error.strerror}); name a file of shapes") from None
    remedy = "make one with `lightgesture motions record`"
    if len(content) > MOST_BYTES:
        raise ShapesError(f"{path}: is larger than {MOST_BYTES} bytes; {remedy}")
    try:
        entries = json.loads(content)["shapes"]
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ShapesError(f"{path}: is no file of shapes; {remedy}") from None
    if not isinstance(entries, list) or len(entries) > MOST_SHAPES:
        raise ShapesError(f"{path}: 'shapes' is no list of at most {MOST_SHAPES}; {remedy}")
    for number, entry in enumerate(entries):
        reason = _objection(entry)
        if reason is not None:
            raise ShapesError(f"{path}: shapes[{number}]: {reason}; {remedy}")
    return entries


def _objection(entry: object) -> str | None:
    """What is wrong with a shape of a file; None: nothing."""
    import re

    if not isinstance(entry, dict) or {*entry} != {"name", "points"}:
        return "has not exactly 'name' and 'points'"
    if not isinstance(entry["name"], str) or re.fullmatch(NAME_PATTERN, entry["name"]) is None:
        return "its name is not of small letters, digits, - and _"
    try:
        points = np.array(entry["points"], np.float64)
    except (ValueError, TypeError):
        return "its points are no pairs of numbers"
    if points.ndim != 2 or points.shape[1] != 2 or not 3 <= len(points) <= MOST_POINTS:
        return f"its points are not 3 to {MOST_POINTS} pairs of numbers"
    if not np.isfinite(points).all() or np.ptp(points, axis=0).max() <= 0.0:
        return "its points do not move, or are no finite numbers"
    return None
