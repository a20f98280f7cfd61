"""Drawings of the ten signs, bare and gloved, as plain polygons: made once, and shipped in `lightgesture/data/hands`.

Run `python -m lightgesture.synth.drawings DIR`; the same version gives the same files. A drawing shows the diver's left
hand as a mirror shows it to the diver, so that the left hand stands left of the right one, which is its mirror image.
It is flat: an outline, lines where one finger lies before another, and three tones of one colour, so that it can be
printed, made larger and read under water.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.results.atomic import replacing
from lightgesture.synth.atlas import paint_atlas
from lightgesture.synth.poses import (
    SIDE_THUMB_TOKENS,
    TOKEN_LEAN_DEG,
    TOKENS,
    shows_palm,
    token_pose,
)
from lightgesture.synth.raster import Canvas, Float32
from lightgesture.synth.shading import Light, shade
from lightgesture.synth.skeleton import MEAN_PROPORTIONS, rotation_y, rotation_z
from lightgesture.synth.skin import skin_tone
from lightgesture.synth.surface import FOREARM, HAND, Forearm, HandView, hand_cones

Mask = NDArray[np.bool_]
Polygon = NDArray[np.int32]

PX_PER_MM: Final = 4.0
"""Resolution at which a hand is rendered before it is traced."""

DISTANCE_MM: Final = 900.0
"""From the eye to the wrist: near enough for a thumb before the palm to look nearer."""

FOREARM_MM: Final = 34.0
"""What is drawn below the wrist."""

CUFF_MM: Final = 12.0
"""Where the cuff of a glove begins, from the wrist."""

SIDE: Final = 200
"""Width and height of a drawing, its own units."""

FILLED: Final = 184.0
"""Longer side of what is drawn, units."""

LARGEST: Final = 1.15
"""Most units a millimetre, so that a fist stays smaller than an open hand."""

STEP_MM: Final = 4.5
"""How much nearer than what is beside it a part must be for a line between them."""

LINE_MM: Final = 1.5
"""Half the width of the outline and of the lines."""

BLUR_MM: Final = 2.2
"""Smoothing of the light, without which the tones would have ragged edges."""

EPSILON_PX: Final = 1.0
"""Farthest that a polygon may lie from what it traces, rendered pixels."""

LEAST_AREA_MM2: Final = 14.0
"""Smaller spots of a tone are left out."""

GLOVE_THICKNESS: Final = 1.13
"""Of a hand in neoprene, against a bare one."""

LIGHT: Final = Light(
    direction=(0.45, -0.6, 0.75),
    key=(0.8, 0.8, 0.8),
    sky=(0.35, 0.35, 0.35),
    ground=(0.16, 0.16, 0.16),
    shadow=0.5,
)
"""White, from the upper right: the thumb's side of a left hand before the mirror."""


@dataclass(frozen=True, slots=True)
class Ink:
    """Colours of a drawing, from the outline to the lightest tone, and of the cuff, as `#rrggbb`."""

    line: str
    tones: tuple[str, str, str]
    cuff: str | None = None


YAW_DEG: Final = {"ok": 38.0}
"""Turn about the long axis: a ring is seen open."""

INKS: Final = {
    "bare": Ink("#3a2419", ("#b97f5f", "#dda883", "#f1cbab")),
    "gloved": Ink("#0d1f2b", ("#1f4c66", "#34759a", "#5d9fc4"), "#f2b632"),
}
"""Kind of hand to its colours."""

TONE_SHARES: Final = (0.30, 0.86)
"""Share of the hand that is darker than the middle tone, and that is not of the lightest."""


def draw_sign(token: str, kind: str) -> str:
    """The drawing of a token, "bare" or "gloved", as SVG with a path a colour, from back to front.

    Every path is of straight lines between whole numbers and filled by the even-odd rule.
    """
    canvas, radiance = _render(token, kind == "gloved")
    ink = INKS[kind]
    hand, cuff = canvas.material > 0, canvas.material == FOREARM
    line = _lines(canvas, hand, None if ink.cuff is None else cuff)
    layers = [(ink.line, hand | line), *zip(ink.tones, _tones(radiance, hand), strict=True)]
    if ink.cuff is not None:
        layers.append((ink.cuff, cuff))
    paths = [(colour, _trace(mask & ~line if order else mask)) for order, (colour, mask) in enumerate(layers)]
    return _to_svg(f"{token}, {kind}", _fitted(paths))


def _render(token: str, is_gloved: bool) -> tuple[Canvas, Float32]:
    """A left hand before the mirror: what is seen and the light that it sends, (h, w, 3)."""
    palm = token not in SIDE_THUMB_TOKENS or shows_palm(token, True, token == SIDE_THUMB_TOKENS[0])
    pose = token_pose(token, np.random.default_rng(0), looseness=0.0)
    yaw = YAW_DEG.get(token, 0.0) + (0.0 if palm else 180.0)
    lean = TOKEN_LEAN_DEG.get(token, 0.0) * (-1.0 if palm else 1.0)
    turn = rotation_z(-lean) @ rotation_y(-yaw)
    view = HandView(turn, (0.0, 0.0), PX_PER_MM, DISTANCE_MM, left=True)
    build = replace(MEAN_PROPORTIONS, thickness=GLOVE_THICKNESS) if is_gloved else MEAN_PROPORTIONS
    cones, _ = hand_cones(pose, build, view, Forearm(FOREARM_MM))
    spheres = np.array([[*cone.start, *cone.end] for cone in cones]).reshape(-1, 4)
    low = np.floor((spheres[:, :2] - spheres[:, 3:]).min(axis=0)).astype(int) - 20
    high = np.ceil((spheres[:, :2] + spheres[:, 3:]).max(axis=0)).astype(int) + 20
    canvas = Canvas(int(high[0] - low[0]), int(high[1] - low[1]), (int(low[0]), int(low[1])))
    for cone in cones:
        canvas.draw(cone)
    _cut_straight(canvas, FOREARM_MM * PX_PER_MM)
    if is_gloved:
        _widen_to_hand(canvas, CUFF_MM * PX_PER_MM)
    tone = skin_tone(3.5)
    plain = np.full_like(paint_atlas(np.random.default_rng(0)), 128)
    radiance = shade(canvas, plain, tone, np.zeros(3, np.float32), LIGHT, PX_PER_MM)
    return canvas, radiance


def _cut_straight(canvas: Canvas, below_px: float) -> None:
    """Take away what lies further below the wrist than `below_px`, so that the forearm ends in a straight line."""
    row = int(below_px) - canvas.corner[1]
    canvas.material[row:] = 0


def _widen_to_hand(canvas: Canvas, from_px: float) -> None:
    """The forearm above the cuff belongs to the glove like the hand."""
    row = int(from_px) - canvas.corner[1]
    above = canvas.material[:row]
    above[above == FOREARM] = HAND


def _lines(canvas: Canvas, hand: Mask, cuff: Mask | None) -> Mask:
    """The outlines of hand and cuff, and where the surface steps back by more than STEP_MM within a few pixels."""
    height = np.where(hand, canvas.height, canvas.height[hand].min()).astype(np.float32)
    near = np.asarray(cv2.dilate(height, np.ones((5, 5), np.uint8)))
    step = (near - height > STEP_MM * PX_PER_MM) & hand
    edges = step | _border(hand)
    if cuff is not None:
        edges |= _border(cuff)
    size = 2 * round(LINE_MM * PX_PER_MM / 2) + 1
    brush = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size))
    return np.asarray(cv2.dilate(edges.astype(np.uint8), brush), np.bool_)


def _border(mask: Mask) -> Mask:
    inner = np.asarray(cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)), np.bool_)
    return mask & ~inner


def _tones(radiance: Float32, hand: Mask) -> list[Mask]:
    """All of the hand, without its dark part, and its light part alone."""
    weight = hand.astype(np.float32)
    sigma = BLUR_MM * PX_PER_MM
    light = np.asarray(cv2.GaussianBlur(radiance.mean(axis=2) * weight, (0, 0), sigma))
    light = light / np.maximum(cv2.GaussianBlur(weight, (0, 0), sigma), 1e-3)
    dark, bright = np.quantile(light[hand], TONE_SHARES)
    return [hand, hand & (light > dark), hand & (light > bright)]


def _trace(mask: Mask) -> list[Polygon]:
    """Outlines of a mask and of its holes, (n, 2) pixels, mirrored in x."""
    mirrored = np.ascontiguousarray(mask[:, ::-1].astype(np.uint8))
    contours, _ = cv2.findContours(mirrored, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    least = LEAST_AREA_MM2 * PX_PER_MM**2
    kept = [contour for contour in contours if cv2.contourArea(contour) >= least]
    return [np.asarray(cv2.approxPolyDP(contour, EPSILON_PX, True)[:, 0], np.int32) for contour in kept]


def _fitted(paths: list[tuple[str, list[Polygon]]]) -> list[tuple[str, list[Polygon]]]:
    """The polygons in the drawing's own units, in its middle."""
    every = np.vstack([polygon for _, polygons in paths for polygon in polygons])
    low, high = every.min(axis=0), every.max(axis=0)
    scale = min(FILLED / float((high - low).max()), LARGEST / PX_PER_MM)
    shift = SIDE / 2 - scale * (low + high) / 2
    return [
        (colour, [np.round(polygon * scale * 2 + shift * 2).astype(np.int32) for polygon in polygons])
        for colour, polygons in paths
    ]


def _to_svg(title: str, paths: list[tuple[str, list[Polygon]]]) -> str:
    """As SVG; half a unit is one of the picture's own."""
    side = SIDE * 2
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {side} {side}" role="img">',
        f"<title>{title}</title>",
    ]
    for colour, polygons in paths:
        shapes = "".join(
            "M" + "L".join(f"{x} {y}" for x, y in polygon.tolist()) + "Z"
            for polygon in polygons
            if len(polygon) > 2
        )
        lines.append(f'<path fill="{colour}" fill-rule="evenodd" d="{shapes}"/>')
    return "\n".join([*lines, "</svg>", ""])


def main(words: list[str]) -> None:
    """Write the drawings of all signs to the folder that is named."""
    if len(words) != 1:
        sys.exit("name the folder to write the drawings to")
    for kind in INKS:
        for token in TOKENS:
            path = Path(words[0]) / f"{token}-{kind}.svg"
            with replacing(path) as temporary:
                temporary.write_text(draw_sign(token, kind), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
