"""The ten tokens, shapes outside the language and the way from one shape to another, as joint angles.

Thumb angles of the closed shapes were found by searching for the pose that puts the thumb's pad where people rest
it without passing through the fingers; the rest follows the anatomy of `skeleton`. Each token has several
variants, because people sign differently: between them poses are mixed, spread and loosened at random.
"""

from __future__ import annotations

import numpy as np

from lightgesture.synth.skeleton import FloatArray, HandPose

TOKENS = ("0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok")
SIDE_THUMB_TOKENS = ("left", "right")

# Curled fingers, and extended ones with their usual spread (MCP flexion, abduction, PIP, DIP), index to little.
CURLED = np.array([[86, 4, 102, 60], [88, 0, 104, 62], [88, -3, 104, 62], [86, -8, 102, 60]], np.float64)
EXTENDED = np.array([[2, 10, 5, 2], [0, 2, 5, 3], [2, -7, 5, 3], [4, -16, 6, 3]], np.float64)

THUMB_OUT = (52.0, 6.0, 4.0, 4.0)
THUMB_STRETCHED = (58.0, 4.0, -6.0, -14.0)
THUMB_OVER_MIDDLE = (28.0, 41.0, 42.0, 44.0)
THUMB_OVER_RING = (8.0, 47.0, 38.0, 46.0)
THUMB_OVER_LITTLE = (-6.0, 49.0, 58.0, 12.0)
THUMB_BESIDE_INDEX = (40.0, 6.0, 55.0, 18.0)
THUMB_ACROSS_PALM = (2.0, 36.0, 62.0, 52.0)
THUMB_ACROSS_ROOTS = (12.0, 24.0, 60.0, 30.0)

TOKEN_YAW_DEG = {"ok": 28.0, "pinch": 24.0, "grip": 25.0}
"""How far people turn a right hand about its long axis to show the shape (a left hand: the other way)."""


def _shape(thumb: tuple[float, ...], *up: int) -> FloatArray:
    """Angles (5, 4) with the given thumb, the fingers `up` (1 index .. 4 little) extended, the others curled."""
    angles = np.vstack([np.array(thumb), CURLED])
    for finger in up:
        angles[finger] = EXTENDED[finger - 1]
    return angles


def _loose(*rows: tuple[int, int, int, int]) -> FloatArray:
    """Angles (5, 4) given row by row."""
    return np.array(rows, np.float64)


def _ring(thumb: tuple[float, ...], index: tuple[float, ...], spread: float) -> FloatArray:
    """An ok ring; the other three fingers fan out by `spread` times their usual spread."""
    angles = _shape(thumb, 2, 3, 4)
    angles[1] = index
    angles[2:, 1] *= spread
    return angles


TOKEN_SHAPES: dict[str, tuple[FloatArray, ...]] = {
    "0": (_shape(THUMB_OVER_MIDDLE), _shape(THUMB_OVER_RING), _shape(THUMB_BESIDE_INDEX)),
    "1": (_shape(THUMB_OVER_MIDDLE, 1), _shape(THUMB_OVER_RING, 1)),
    "2": (_shape(THUMB_OVER_RING, 1, 2), _shape(THUMB_OVER_LITTLE, 1, 2)),
    "3": (_shape(THUMB_OVER_LITTLE, 1, 2, 3),),
    "4": (_shape(THUMB_ACROSS_PALM, 1, 2, 3, 4), _shape(THUMB_ACROSS_ROOTS, 1, 2, 3, 4)),
    "5": (_shape(THUMB_OUT, 1, 2, 3, 4),),
    "left": (_shape(THUMB_STRETCHED),),
    "right": (_shape(THUMB_STRETCHED),),
    "pic": (_shape(THUMB_OUT, 1), _shape(THUMB_STRETCHED, 1)),
    "ok": (
        _ring((28.0, 36.0, 20.0, 30.0), (44.0, 4.0, 68.0, 32.0), 1.4),
        _ring((22.0, 40.0, 12.0, 18.0), (52.0, 0.0, 55.0, 25.0), 1.6),
        _ring((22.0, 40.0, 12.0, 18.0), (52.0, 0.0, 55.0, 25.0), 1.0),
    ),
}
OTHER_SHAPES: dict[str, FloatArray] = {
    "shaka": _shape(THUMB_STRETCHED, 4),
    "horns": _shape(THUMB_OVER_RING, 1, 4),
    "love": _shape(THUMB_OUT, 1, 4),
    "little": _shape(THUMB_OVER_RING, 4),
    "middle": _shape(THUMB_BESIDE_INDEX, 2),
    "thumb_index_middle": _shape(THUMB_OUT, 1, 2),
    "thumb_index_middle_ring": _shape(THUMB_OUT, 1, 2, 3),
    "middle_ring": _shape(THUMB_BESIDE_INDEX, 2, 3),
    "relaxed": _loose((38, 18, 18, 16), (28, 4, 36, 16), (32, 0, 40, 18), (36, -4, 42, 20), (40, -9, 40, 20)),
    "claw": _loose((48, 18, 25, 40), (4, 10, 72, 48), (4, 2, 75, 48), (6, -7, 75, 48), (8, -16, 72, 48)),
    "grip": _loose((40, 45, 14, 22), (42, 3, 44, 22), (44, 0, 46, 24), (46, -3, 48, 24), (50, -7, 46, 22)),
    "pinch": _loose((24, 42, 20, 18), (56, 2, 42, 20), (58, 0, 44, 22), (60, -4, 44, 22), (62, -9, 42, 22)),
}  # fmt: skip


def token_pose(token: str, rng: np.random.Generator, looseness: float = 1.0) -> HandPose:
    """One person's way of making `token` (or a name of OTHER_SHAPES), with natural variation.

    looseness scales every deviation: 0 is the first variant exactly, 1 natural, 2 careless.
    """
    if token in OTHER_SHAPES:
        variants: tuple[FloatArray, ...] = (OTHER_SHAPES[token],)
    else:
        variants = TOKEN_SHAPES[token]
    if looseness <= 0.0:
        return HandPose(variants[0].copy(), np.zeros(2)).clipped()
    first, second = (variants[int(rng.integers(len(variants)))] for _ in range(2))
    angles = first + (second - first) * rng.uniform(0.0, 1.0) * (rng.uniform() < 0.5)
    angles = _loosened(angles, token, rng, looseness)
    wrist = rng.normal([-4.0, -2.0], [12.0, 7.0]) * looseness
    return HandPose(angles, wrist).clipped()


def _loosened(angles: FloatArray, token: str, rng: np.random.Generator, looseness: float) -> FloatArray:
    angles = angles.copy()
    extended = angles[1:, 2] < 30.0
    spread = np.clip(rng.normal(1.0, 0.55), 0.05, 1.9) if looseness > 0.0 else 1.0
    angles[1:, 1] *= 1.0 + (spread - 1.0) * min(looseness, 1.0)
    bend = np.abs(rng.normal(0.0, 7.0)) * looseness  # people rarely stretch all the way
    each = np.abs(rng.normal(0.0, 4.0, 4)) * looseness
    angles[1:, 2] += np.where(extended, bend + each, rng.normal(-4.0, 5.0, 4) * looseness)
    angles[1:, 3] += np.where(extended, 0.4 * (bend + each), rng.normal(0.0, 7.0, 4) * looseness)
    angles[1:, 0] += (
        np.where(extended, rng.normal(0.0, 6.0) + rng.normal(0.0, 3.0, 4), rng.normal(-4.0, 5.0, 4))
        * looseness
    )
    angles[1:, 1] += rng.normal(0.0, 1.8, 4) * looseness
    spread_thumb = (
        np.array([6.0, 5.0, 5.0, 7.0]) if token not in ("ok", "0", "1", "2", "3", "4") else np.full(4, 3.0)
    )
    angles[0] += rng.normal(0.0, 1.0, 4) * spread_thumb * looseness
    return angles


def blend_poses(before: HandPose, after: HandPose, part: float, stagger: float = 0.18) -> HandPose:
    """The hand on its way from one shape to the next, `part` 0..1.

    Fingers do not move together: each starts a little later (`stagger` of the whole way from the first to the
    last), eases in and out, and opens slightly in passing, as hands relax between signs.
    """
    delays = stagger * np.array([0.5, 0.0, 0.35, 0.7, 1.0])
    own = np.clip((part - delays) / (1.0 - stagger), 0.0, 1.0)
    eased = (own * own * (3.0 - 2.0 * own))[:, None]
    angles = before.angles + (after.angles - before.angles) * eased
    relaxed = OTHER_SHAPES["relaxed"]
    passing = 0.35 * 4.0 * eased * (1.0 - eased)
    angles = angles + passing * (relaxed - angles)
    whole = part * part * (3.0 - 2.0 * part)
    return HandPose(angles, before.wrist + (after.wrist - before.wrist) * whole).clipped()


def shows_palm(token: str, left_hand: bool, thumb_image_left: bool) -> bool:
    """Which face a side-thumb token turns to the camera when its thumb points to the given side of the picture.

    An upright left hand with its palm to the camera has the thumb on image left, a right hand on image right.
    """
    if token not in SIDE_THUMB_TOKENS:
        raise ValueError(f"{token} has no thumb direction; only {' and '.join(SIDE_THUMB_TOKENS)} have")
    return left_hand == thumb_image_left
