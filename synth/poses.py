"""The ten tokens, shapes outside the language and the way from one shape to another, as joint angles.

Thumb angles of the closed shapes were found by searching for the pose that puts the thumb's pad where people rest
it without passing through the fingers; the rest follows the anatomy of `skeleton`. Each token has several
variants, because people sign differently: between them poses are mixed, spread and loosened at random.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lightgesture.synth.skeleton import FloatArray, HandPose

SIDE_THUMB_TOKENS = ("left", "right")
FREE_THUMB = frozenset({"5", "left", "right", "pic", "shaka", "love", "relaxed", "claw"})
"""Shapes whose thumb touches nothing and varies freely."""

# Curled fingers, and extended ones with their usual spread (MCP flexion, abduction, PIP, DIP), index to little.
# The MCP flexion is that at which photographed fists show their PIP joints; the abductions are those of spread hands.
CURLED = np.array([[62, 2, 107, 62], [66, 0, 108, 62], [71, -3, 106, 62], [78, -8, 104, 61]], np.float64)
EXTENDED = np.array([[2, 8, 5, 2], [0, -4, 5, 3], [2, -8, 5, 3], [4, -17, 6, 3]], np.float64)

TOKEN_YAW_DEG = {"ok": 16.0, "pinch": 22.0, "grip": 25.0}
"""How far people turn a right hand about its long axis to show the shape (a left hand: the other way)."""
TOKEN_LEAN_DEG = {"left": 13.0, "right": 13.0}
"""How far they lean it to the thumb's side, which brings a stretched thumb level."""
SPREAD_DEG = {"2": 10.0, "4": 6.0, "5": 9.0, "ok": 12.0}
USUAL_SPREAD_DEG = 6.0
SPREAD_SHARE = np.array([1.0, -0.3, -0.7, -1.2])
"""Standard deviation of the spread (index abduction), and how the fingers share in it."""

OWN_WAY_PER_LOOSENESS = 2.0
"""Below half of natural looseness, signs approach the textbook's (first) variant."""


def _shape(
    thumb: tuple[float, ...], *up: int, abduction: tuple[float, float, float, float] | None = None
) -> FloatArray:
    """Angles (5, 4) with the given thumb, the fingers `up` (1 index .. 4 little) extended, the others curled."""
    angles = np.vstack([np.array(thumb), CURLED])
    for finger in up:
        angles[finger] = EXTENDED[finger - 1]
        if abduction is not None:
            angles[finger, 1] = abduction[finger - 1]
    return angles


def _loose(*rows: tuple[int, int, int, int]) -> FloatArray:
    """Angles (5, 4) given row by row."""
    return np.array(rows, np.float64)


def _ring(thumb: tuple[float, ...], index: tuple[float, ...], fan: float = 1.0) -> FloatArray:
    """An ok ring; the other three fingers fan out by `fan` times their usual spread (0: side by side)."""
    angles = _shape(thumb, 2, 3, 4)
    angles[1] = index
    angles[2:, 1] *= fan
    return angles


THUMB_OUT = (43.0, 8.0, 4.0, 4.0)
THUMB_STRETCHED = (49.0, 2.0, -1.0, -4.0)
THUMB_BESIDE_INDEX = (26.0, 8.0, 22.0, 40.0)
THUMBS_FIST = ((4.0, 40.0, 4.0, 31.0), (-6.0, 40.0, 6.0, 34.0), THUMB_BESIDE_INDEX)
THUMBS_OVER_MIDDLE = ((27.0, 45.0, 11.0, 31.0), (25.0, 44.0, 30.0, 49.0), (7.0, 48.0, 36.0, 43.0))
THUMBS_OVER_RING = ((25.0, 44.0, 42.0, 33.0), (9.0, 49.0, 41.0, 33.0), (-18.0, 50.0, 25.0, 39.0))
THUMBS_OVER_LITTLE = ((8.0, 57.0, 36.0, 41.0), (-1.0, 59.0, 45.0, 36.0), (-23.0, 52.0, 36.0, 36.0))
THUMBS_FOLDED = ((33.0, 34.0, 56.0, 23.0), (19.0, 39.0, 50.0, 52.0), (7.0, 37.0, 65.0, 47.0))
POINTING = (-4.0, 0.0, 0.0, 0.0)
V_SIGN = (9.0, -8.0, 0.0, 0.0)
THREE = (12.0, -4.0, -14.0, 0.0)
TOGETHER = (-6.0, -6.0, -6.0, -7.0)
TOGETHER_SPREAD_DEG = 1.5
STRETCHED_DEG = 60.0
"""A finger whose middle joint is bent less is stretched."""

BENT_DEG = 50.0
"""A finger of a token whose middle joint is bent more is a bent one."""
LEAST_BENT_DEG, MOST_STRETCHED_DEG = 40.0, 80.0
"""MCP and PIP flexion together of a measured finger that the sign bends, at least, and of a stretched one, at most."""
HIDDEN_PART = (0.5, 0.9)
"""How far hidden joints are moved from what was measured to what the sign asks for."""

TOKEN_SHAPES: dict[str, tuple[FloatArray, ...]] = {
    "0": tuple(_shape(thumb) for thumb in THUMBS_FIST),
    "1": tuple(_shape(thumb, 1, abduction=POINTING) for thumb in THUMBS_OVER_MIDDLE),
    "2": tuple(_shape(thumb, 1, 2, abduction=V_SIGN) for thumb in THUMBS_OVER_RING),
    "3": tuple(_shape(thumb, 1, 2, 3, abduction=THREE) for thumb in THUMBS_OVER_LITTLE),
    "4": tuple(_shape(thumb, 1, 2, 3, 4, abduction=TOGETHER) for thumb in THUMBS_FOLDED),
    "5": (_shape(THUMB_OUT, 1, 2, 3, 4),),
    "left": (_shape(THUMB_STRETCHED),),
    "right": (_shape(THUMB_STRETCHED),),
    "pic": (_shape(THUMB_STRETCHED, 1, abduction=POINTING),),
    "ok": (
        _ring((28.0, 36.0, 20.0, 30.0), (48.0, 2.0, 68.0, 32.0)),
        _ring((22.0, 40.0, 12.0, 18.0), (54.0, 0.0, 55.0, 25.0)),
        _ring((18.0, 34.0, 18.0, 2.0), (48.0, -6.0, 65.0, 22.0), fan=0.4),
        _ring((16.0, 40.0, 24.0, 24.0), (60.0, -2.0, 60.0, 26.0), fan=0.2),
    ),
}
TOKENS = tuple(TOKEN_SHAPES)
OTHER_SHAPES: dict[str, FloatArray] = {
    "shaka": _shape(THUMB_STRETCHED, 4),
    "horns": _shape(THUMBS_OVER_RING[0], 1, 4),
    "love": _shape(THUMB_OUT, 1, 4),
    "little": _shape(THUMBS_OVER_RING[0], 4),
    "middle": _shape(THUMB_BESIDE_INDEX, 2),
    "thumb_index_middle": _shape(THUMB_OUT, 1, 2),
    "thumb_index_middle_ring": _shape(THUMB_OUT, 1, 2, 3),
    "middle_ring": _shape(THUMB_BESIDE_INDEX, 2, 3),
    "relaxed": _loose((38, 18, 18, 16), (28, 4, 36, 16), (32, 0, 40, 18), (36, -4, 42, 20), (40, -9, 40, 20)),
    "claw": _loose((48, 18, 25, 40), (4, 10, 72, 48), (4, 2, 75, 48), (6, -7, 75, 48), (8, -16, 72, 48)),
    "grip": _loose((40, 45, 14, 22), (42, 3, 44, 22), (44, 0, 46, 24), (46, -3, 48, 24), (50, -7, 46, 22)),
    "pinch": _loose((24, 42, 20, 18), (56, 2, 42, 20), (58, 0, 44, 22), (60, -4, 44, 22), (62, -9, 42, 22)),
}  # fmt: skip


def token_pose(
    token: str, rng: np.random.Generator, looseness: float = 1.0, *, together: bool = False
) -> HandPose:
    """One person's way of making `token` (or a name of OTHER_SHAPES), with natural variation.

    looseness scales every deviation: 0 is the first variant exactly, 1 natural, 2 careless. together: stretched
    fingers lie side by side.
    """
    variants = (OTHER_SHAPES[token],) if token in OTHER_SHAPES else TOKEN_SHAPES[token]
    if looseness <= 0.0:
        return HandPose(variants[0].copy(), np.zeros(2)).clipped()
    first, second = (variants[int(rng.integers(len(variants)))] for _ in range(2))
    own = first + (second - first) * rng.uniform(0.0, 1.0)
    angles = variants[0] + (own - variants[0]) * min(OWN_WAY_PER_LOOSENESS * looseness, 1.0)
    angles = _loosened(angles, token, rng, looseness)
    if together:
        angles = bring_together(angles, rng)
    wrist = rng.normal([-4.0, -2.0], [12.0, 7.0]) * looseness
    return HandPose(angles, wrist).clipped()


def bring_together(angles: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Angles (5, 4) with the stretched fingers side by side."""
    together = angles.copy()
    beside = TOGETHER + rng.normal(0.0, TOGETHER_SPREAD_DEG, 4)
    together[1:, 1] = np.where(angles[1:, 2] < STRETCHED_DEG, beside, angles[1:, 1])
    return together


def agrees(angles: FloatArray, token: str) -> bool:
    """Whether measured angles (5, 4) stretch and bend the fingers that the sign does; always for what is no token."""
    if token not in TOKEN_SHAPES:
        return True
    bent = _bent(TOKEN_SHAPES[token][0])
    towards_palm = angles[1:, 0] + angles[1:, 2]
    return bool(np.where(bent, towards_palm >= LEAST_BENT_DEG, towards_palm <= MOST_STRETCHED_DEG).all())


def with_hidden_bends(angles: FloatArray, token: str, rng: np.random.Generator) -> FloatArray:
    """Measured angles (5, 4) with what the sign bends moved on towards one of its variants.

    Of fingertips that hide in the palm, and of the thumb on them, detectors guess too small a bend.
    """
    if token not in TOKEN_SHAPES:
        return angles
    variants = TOKEN_SHAPES[token]
    shape = variants[int(rng.integers(len(variants)))]
    moved = np.concatenate([[token not in FREE_THUMB], _bent(shape)])
    part = rng.uniform(*HIDDEN_PART)
    return np.asarray(angles + np.where(moved[:, None], part * (shape - angles), 0.0))


def _bent(shape: FloatArray) -> NDArray[np.bool_]:
    """Which of the four fingers a sign bends."""
    return np.asarray(shape[1:, 2] >= BENT_DEG)


def _loosened(angles: FloatArray, token: str, rng: np.random.Generator, looseness: float) -> FloatArray:
    angles = angles.copy()
    extended = angles[1:, 2] < 30.0
    spread = rng.normal(0.0, SPREAD_DEG.get(token, USUAL_SPREAD_DEG)) * looseness
    angles[1:, 1] += np.where(extended, spread, 0.2 * spread) * SPREAD_SHARE
    bend = np.abs(rng.normal(0.0, 7.0)) * looseness  # people rarely stretch all the way
    each = np.abs(rng.normal(0.0, 4.0, 4)) * looseness
    angles[1:, 2] += np.where(extended, bend + each, rng.normal(-2.0, 6.0, 4) * looseness)
    angles[1:, 3] += np.where(extended, 0.4 * (bend + each), rng.normal(0.0, 7.0, 4) * looseness)
    fist = rng.normal(2.0, 9.0) + rng.normal(0.0, 4.0, 4)
    angles[1:, 0] += np.where(extended, rng.normal(0.0, 6.0) + rng.normal(0.0, 3.0, 4), fist) * looseness
    angles[1:, 1] += rng.normal(0.0, 1.8, 4) * looseness
    free_thumb = np.array([6.0, 5.0, 5.0, 7.0]) if token in FREE_THUMB else np.full(4, 3.0)
    angles[0] += rng.normal(0.0, 1.0, 4) * free_thumb * looseness
    return angles


STAGGER = 0.18
"""By which part of a change of shape the last finger starts later than the first."""


def blend_poses(before: HandPose, after: HandPose, part: float) -> HandPose:
    """The hand on its way from one shape to the next, `part` 0..1.

    Fingers do not move together: each starts a little later (`STAGGER` of the whole way from the first to the
    last), eases in and out, and opens slightly in passing, as hands relax between signs.
    """
    delays = STAGGER * np.array([0.5, 0.0, 0.35, 0.7, 1.0])
    own = np.clip((part - delays) / (1.0 - STAGGER), 0.0, 1.0)
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
