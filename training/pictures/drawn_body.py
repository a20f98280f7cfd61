"""The simple body of composed pictures: a suit, a head and arms of plain shapes."""

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box

Float = NDArray[np.float32]


def draw_body(
    canvas: Float,
    axis: float,
    shoulder: float,
    unit: float,
    wrists: Sequence[tuple[float, float]],
    skin: Float,
    bare_arms: float,
    rng: np.random.Generator,
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
    cv2.ellipse(canvas, head, axes, 0, 0, 360, flesh, cv2.FILLED, cv2.LINE_AA)
    if rng.random() < 0.75:  # hair or hood, then often a mask
        top = rng.uniform(0.0, 0.3, 3).tolist()
        cv2.ellipse(canvas, head, axes, 0, 180, 360, top, cv2.FILLED, cv2.LINE_AA)
        if rng.random() < 0.6:
            corner = head[0] - axes[0] * 3 // 4, head[1] - axes[1] // 3
            other = head[0] + axes[0] * 3 // 4, head[1] + axes[1] // 5
            cv2.rectangle(canvas, corner, other, rng.uniform(0.0, 0.8, 3).tolist(), cv2.FILLED)
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
