"""What `motions` does: shapes are shown, or another is recorded from a clip.

grammar: path of a grammar file, None for the bundled one. UsageError: it, or the file of shapes, cannot be used.
"""

import re
from pathlib import Path

import cv2
import numpy as np

from lightgesture.cards.recording import choose_curve, read_motions
from lightgesture.console import native_messages_muted, print_line
from lightgesture.errors import ExitStatus, UsageError, reason_of
from lightgesture.features.motion.matching import ShapeBase
from lightgesture.features.motion.shapes import (
    NAME_PATTERN,
    SHAPES,
    Curve,
    ShapesError,
    load_shapes,
    save_shape,
)
from lightgesture.features.tags.detector import make_detector
from lightgesture.features.types import Image
from lightgesture.fsm import GrammarError, load_grammar
from lightgesture.fsm.language.grammar import STILL, MotionWords
from lightgesture.results.atomic import replacing
from lightgesture.sources import open_source

TILE_PX = 150
"""Width and height of a shape in the picture."""

TILES_A_ROW = 5


def record_shape(
    clip: str, name: str, file: str, grammar: str | None, side: str | None, mirrored: bool
) -> ExitStatus:
    """Add the shape that a clip shows to a file. InputError: the clip does not show exactly one."""
    if re.fullmatch(NAME_PATTERN, name) is None or name == STILL:
        raise UsageError(
            f"{name}: is no name of a shape; use small letters, digits, - and _, and not '{STILL}'"
        )
    words = _words(grammar)
    path = Path(file)
    try:
        known = load_shapes(path if path.exists() else None)
        detector = make_detector("aruco", words.family)
    except ValueError as error:
        raise UsageError(str(error)) from None
    with native_messages_muted(), open_source(clip) as source:
        curve = choose_curve(read_motions(source, words, detector, mirrored), side, clip)
    try:
        with replacing(path) as temporary:
            count = save_shape(path, name, curve, temporary)
    except ShapesError as error:
        raise UsageError(str(error)) from None
    except OSError as error:
        raise UsageError(f"{file}: cannot be written ({reason_of(error)}); name another place") from None
    print_line(f"{file}: {name} added, {count} recorded; use it in [motions] and give the file with --shapes")
    others = {other: curves for other, curves in known.items() if other != name}
    base = ShapeBase(others)
    match = base.match(curve)
    if match.distance <= base.settings.most_distance:
        print_line(f"{name} is near to {match.name} ({match.distance:.2f}): one may be taken for the other")
    return ExitStatus.OK


def show_shapes(file: str | None, grammar: str | None, out: str | None) -> ExitStatus:
    """Print every shape with its words, and draw them where that is asked for. out: path of a PNG file."""
    try:
        shapes = load_shapes(file)
    except ShapesError as error:
        raise UsageError(str(error)) from None
    words = _words(grammar)
    print_line("Shapes, seen with the diver's eyes; each ends where it begins")
    width = max(map(len, shapes))
    for name, curves in shapes.items():
        origin = "" if name in SHAPES and curves == SHAPES[name] else "  (recorded)"
        print_line(f"  {name:<{width}}  {len(curves)} {'way' if len(curves) == 1 else 'ways'}{origin}")
    print_line("Words (left hand, right hand)")
    for (left, right), word in words.words.items():
        print_line(f"  {word:<10} {left}, {right}")
    if out is not None:
        _draw(shapes, out)
    return ExitStatus.OK


def _draw(shapes: dict[str, tuple[Curve, ...]], out: str) -> None:
    if not out.lower().endswith(".png"):
        raise UsageError(f"--out {out}: is drawn as PNG; name a file that ends in .png")
    tiles = [_tile(name, curves[0]) for name, curves in shapes.items()]
    tiles += [np.full_like(tiles[0], 255)] * (-len(tiles) % TILES_A_ROW)
    rows = [np.hstack(tiles[first : first + TILES_A_ROW]) for first in range(0, len(tiles), TILES_A_ROW)]
    content = cv2.imencode(".png", np.vstack(rows))[1].tobytes()
    try:
        with replacing(Path(out)) as temporary:
            temporary.write_bytes(content)
    except OSError as error:
        raise UsageError(f"{out}: cannot be written ({reason_of(error)}); name another place") from None


def _tile(name: str, curve: Curve) -> Image:
    """A shape with its name, a dot where it begins and a head where it goes first."""
    tile = np.full((TILE_PX, TILE_PX, 3), 255, np.uint8)
    size = 0.6 * TILE_PX / float(np.ptp(curve, axis=0).max())
    middle = 0.5 * (curve.max(axis=0) + curve.min(axis=0))
    points = np.rint((curve - middle) * (size, -size) + (TILE_PX / 2, TILE_PX / 2 + 10)).astype(np.int32)
    cv2.polylines(tile, [points.reshape(-1, 1, 2)], False, (200, 120, 0), 2, cv2.LINE_AA)
    cv2.arrowedLine(
        tile, points[0].tolist(), points[1].tolist(), (200, 120, 0), 2, cv2.LINE_AA, tipLength=0.2
    )
    cv2.circle(tile, points[0].tolist(), 5, (0, 0, 200), -1, cv2.LINE_AA)
    cv2.putText(tile, name, (6, 16), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 1, cv2.LINE_AA)
    return tile


def _words(grammar: str | None) -> MotionWords:
    try:
        language = load_grammar(grammar)
    except GrammarError as error:
        raise UsageError(str(error)) from None
    if language.motions is None:
        raise UsageError(f"{language.file}: has no [motions]; add it, as in the bundled grammar")
    return language.motions
