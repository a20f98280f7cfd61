"""What is drawn into composed pictures: simple bodies, and what stands about and is no hand.

That is pieces of other pictures, poles and boxes, and lit places.
"""

from collections.abc import Callable, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Float

Random = np.random.Generator


def draw_body(
    canvas: Float,
    axis: float,
    shoulder: float,
    unit: float,
    wrists: Sequence[tuple[float, float]],
    skin: Float,
    bare_arms: float,
    rng: Random,
) -> Box:
    """Torso, head and arms with known wrists on a canvas, float32 (h, w, 3), 0 to 1; returns the box of the head.

    axis, shoulder: x of the body's middle and y of its shoulders, pixels. unit: height of a hand, pixels. wrists:
    (x, y), pixels. skin: float32 (3,), its colour, BGR, 0 to 1. bare_arms: share of bodies with bare forearms.
    """
    suit = rng.uniform(0.0, 0.25, 3) if rng.random() < 0.7 else rng.uniform(0.1, 0.9, 3)
    cloth, flesh = suit.tolist(), (skin * rng.uniform(0.75, 1.1)).tolist()
    half = unit * rng.uniform(0.9, 1.3)

    def at(x: float, y: float) -> tuple[int, int]:
        return round(x), round(y)

    torso = [
        at(axis - half, shoulder),
        at(axis + half, shoulder),
        at(axis + 0.8 * half, shoulder + 3.2 * unit),
        at(axis - 0.8 * half, shoulder + 3.2 * unit),
    ]
    cv2.fillConvexPoly(canvas, np.array(torso, np.int32), cloth, cv2.LINE_AA)
    head = at(axis, shoulder - 0.8 * unit)
    axes = max(1, round(0.42 * unit)), max(1, round(0.58 * unit))
    _draw_head(canvas, head, axes, flesh, rng)
    bare = rng.random() < bare_arms
    for wrist in wrists:
        sign = 1.0 if wrist[0] > axis else -1.0
        joint = at(axis + sign * half * 0.9, shoulder + 0.15 * unit)
        elbow = at(
            axis + sign * max(abs(wrist[0] - axis) * rng.uniform(0.7, 1.1), half),
            max(shoulder, wrist[1]) + unit * rng.uniform(0.6, 1.3),
        )
        cv2.line(canvas, joint, elbow, cloth, max(1, round(0.55 * unit)), cv2.LINE_AA)
        colour = flesh if bare else cloth
        cv2.line(canvas, elbow, at(*wrist), colour, max(1, round(0.36 * unit)), cv2.LINE_AA)
    return head[0] - axes[0], head[1] - axes[1], 2 * axes[0], 2 * axes[1]


def _draw_head(
    canvas: Float, middle: tuple[int, int], axes: tuple[int, int], flesh: list[float], rng: Random
) -> None:
    """A face, on most hair or a hood, and on many of those a mask."""
    cv2.ellipse(canvas, middle, axes, 0, 0, 360, flesh, cv2.FILLED, cv2.LINE_AA)
    if rng.random() >= 0.75:
        return
    top = rng.uniform(0.0, 0.3, 3).tolist()
    cv2.ellipse(canvas, middle, axes, 0, 180, 360, top, cv2.FILLED, cv2.LINE_AA)
    if rng.random() < 0.6:
        corner = middle[0] - axes[0] * 3 // 4, middle[1] - axes[1] // 3
        other = middle[0] + axes[0] * 3 // 4, middle[1] + axes[1] // 5
        cv2.rectangle(canvas, corner, other, rng.uniform(0.0, 0.8, 3).tolist(), cv2.FILLED)


def put_decoys(canvas: Float, unit: float, most: int, draw_texture: Callable[[], Float], rng: Random) -> None:
    """Objects about as large as hands: pieces of other pictures with a hard edge and a colour of their own.

    canvas: float32 (h, w, 3), 0 to 1, drawn on. unit: height of a hand in pixels. most: objects in a picture; every
    second has none. draw_texture: another picture of the canvas's shape.
    """
    height, width = canvas.shape[:2]
    count = rng.integers(1, most + 1) if rng.random() < 0.5 else 0
    for _ in range(count):
        texture = draw_texture()
        radius = unit * rng.uniform(0.2, 0.8)
        centre = rng.uniform(0, width), rng.uniform(0, height)
        angles = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 12)))
        reach = radius * rng.uniform(0.5, 1.3, len(angles))
        outline = np.stack([centre[0] + reach * np.cos(angles), centre[1] + reach * np.sin(angles)], axis=1)
        mask = np.zeros((height, width), np.float32)
        cv2.fillPoly(mask, [np.rint(outline).astype(np.int32)], 1.0, cv2.LINE_AA)
        colour = np.array([rng.uniform(0.0, 0.5), rng.uniform(0.1, 0.6), rng.uniform(0.4, 1.0)], np.float32)
        tint = rng.uniform(0.0, 0.9)
        thing = texture * (1.0 - tint) + (0.3 + 0.7 * texture) * colour * tint
        canvas += mask[..., None] * (thing - canvas)


def put_structures(canvas: Float, unit: float, rng: Random) -> None:
    """Poles, gates and boxes in paint colours, as robots find them in test pools; bends look like fists.

    canvas, unit: as in `put_decoys`.
    """
    height, width = canvas.shape[:2]
    thick = max(1, round(unit * rng.uniform(0.1, 0.5)))
    drawn = canvas.copy()
    top, bottom = rng.uniform(-0.1, 0.6) * height, rng.uniform(0.5, 1.2) * height
    feet = np.sort(rng.uniform(0.0, 1.0, rng.integers(1, 4))) * width
    lean = rng.normal(0.0, 0.06) * height
    heads = [(round(x + lean), round(top + rng.normal(0.0, 0.04) * height)) for x in feet]
    for x, head in zip(feet, heads, strict=True):
        cv2.line(drawn, (round(x), round(bottom)), head, _paint(rng), thick, cv2.LINE_AA)
        if rng.random() < 0.6:  # a joint of another colour
            joint = (
                head[0] + round(rng.normal(0.0, 1.0) * thick),
                head[1] + round(rng.uniform(0, 3) * thick),
            )
            cv2.line(drawn, head, joint, _paint(rng), round(1.2 * thick), cv2.LINE_AA)
    if len(heads) > 1 and rng.random() < 0.7:
        cv2.line(drawn, heads[0], heads[-1], _paint(rng), thick, cv2.LINE_AA)
    for _ in range(rng.integers(0, 3)):
        corner = rng.uniform(0.0, 0.9, 2) * (width, height)
        size = unit * rng.uniform(0.4, 2.0, 2)
        _put_machine(drawn, corner, size, rng)
    canvas += rng.uniform(0.4, 1.0) * (drawn - canvas)


def _put_machine(canvas: Float, corner: NDArray[np.float64], size: NDArray[np.float64], rng: Random) -> None:
    """A dark box with stripes and tubes."""
    x, y, wide, tall = (round(float(value)) for value in (*corner, *size))
    body = (rng.uniform(0.02, 0.35) * np.ones(3)).tolist()
    cv2.rectangle(canvas, (x, y), (x + wide, y + tall), body, cv2.FILLED)
    for _ in range(rng.integers(0, 5)):
        ends = rng.uniform(0.0, 1.0, (2, 2)) * size + corner
        start, end = ((round(float(a)), round(float(b))) for a, b in ends)
        cv2.line(canvas, start, end, _paint(rng), max(1, tall // 8), cv2.LINE_AA)


def _paint(rng: Random) -> tuple[float, float, float]:
    """Red, orange, yellow, black, white or grey, BGR, 0 to 1."""
    colours = ((0.1, 0.12, 0.75), (0.1, 0.4, 0.85), (0.1, 0.75, 0.85), (0.05,) * 3, (0.85,) * 3, (0.4,) * 3)
    shade = rng.uniform(0.6, 1.15)
    blue, green, red = (min(value * shade, 1.0) for value in colours[rng.integers(len(colours))])
    return blue, green, red


def lamp_spots(shape: tuple[int, int], rng: Random) -> Float:
    """float32 (h, w), from 1: how much brighter one or two lit places are, tables under lamps and the like."""
    height, width = shape
    gain = np.ones((height, width), np.float32)
    for _ in range(rng.integers(1, 3)):
        centre = round(rng.uniform(0, width)), round(rng.uniform(0.2, 1.0) * height)
        axes = round(width * rng.uniform(0.04, 0.2)), round(height * rng.uniform(0.04, 0.2))
        cv2.ellipse(gain, centre, axes, rng.uniform(-20, 20), 0, 360, rng.uniform(3.0, 15.0), cv2.FILLED)
    return np.asarray(cv2.GaussianBlur(gain, (0, 0), rng.uniform(1.0, 8.0)), np.float32)
