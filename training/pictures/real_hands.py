"""Real hands on the synthetic diver: cut out of their pictures, relit, turned into line with the forearm, under water.

The synthetic diver gives body, arms, face, mask and the way it all moves; photographs give the hands. All
arithmetic is in linear light. For training and benchmarks on the user's own machine; no picture is shipped.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Float
from lightgesture.synth.body import SHOULDER, BodyLook, Camera, elbow_position, render_body, to_camera
from lightgesture.synth.diver import ArmState, DiverState, rotation_matrix
from lightgesture.synth.hand import decode
from lightgesture.synth.shading import Light
from lightgesture.synth.water import Water
from lightgesture.training.pictures.cutouts import Cutout

HEIGHT_IN_PALMS = {"0": 1.47, "left": 1.42, "right": 1.34}
"""Height of an upright hand over its palm's length (wrist to middle knuckle): medians of `hands/train`."""
STRETCHED_IN_PALMS = 2.28
"""The same for every shape with a stretched finger."""


PALM_MM: Final = 92.0
"""Length of the palm of a person as large as the synthetic diver."""
WRIST_DEG: Final = 32.0
"""How far a hand leans against its forearm."""
CUFF_MM: Final = -28.0
"""From the wrist to where the body's own arm ends, less the 31 mm of its rounded end: the arm reaches the wrist,
because no forearm comes with the hand."""


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """Hands laid into a picture. radiance: (h, w, 3) linear, premultiplied by alpha (h, w)."""

    radiance: Float
    alpha: Float


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """Which pictures of a hand are seen at once, with weights that sum to one: more than one while they cross-fade."""

    cutouts: Sequence[Cutout]
    weights: Sequence[float]


@dataclass(frozen=True, slots=True, eq=False)
class PastedHand:
    """side: the diver's own. box: outline inside the picture. visible: share of the hand that is inside it and
    not covered by the other one, 0 to 1."""

    side: str
    box: Box
    visible: float


def skin_colour(cutout: Cutout) -> tuple[float, float, float]:
    """Mean linear BGR of a hand."""
    blue, green, red = decode(cutout.image)[cutout.alpha > 0.9].mean(axis=0)
    return float(blue), float(green), float(red)


def light_colour(light: Light) -> Float:
    """What a hand that faces the camera gets of the light (3,): a photograph has its own shading already."""
    key, sky, ground = (np.array(part, np.float32) for part in (light.key, light.sky, light.ground))
    return np.asarray(0.62 * key + 0.5 * (sky + ground), np.float32)


def draw_diver(
    picture: Float,
    state: DiverState,
    look: BodyLook,
    hands: dict[str, Shown],
    camera: Camera,
    light: Light,
    water: Water | None,
) -> tuple[list[PastedHand], Float]:
    """Draw the diver with real hands over a linear picture (in place); `hands` by side, either may be absent.

    Returns the truth of the hands and the coverage (h, w) of the whole diver.
    """
    size = (picture.shape[1], picture.shape[0])
    rotation = rotation_matrix(state.rotation)
    arms = {"left": state.left, "right": state.right}
    worn = replace(look, cuff_mm=CUFF_MM)
    wrists = (state.left.wrist, state.right.wrist)
    radiance, cover = render_body(worn, rotation, state.position, wrists, camera, size, light, water)
    picture *= 1.0 - cover[..., None]
    picture += radiance
    depth = {side: float(to_camera(arms[side].wrist[None], rotation, state.position)[0, 2]) for side in hands}
    laid: list[tuple[str, Float, float]] = []
    for side in sorted(hands, key=lambda name: -depth[name]):
        place = _placement(arms[side], side, state, camera)
        layer, inside = _warp(hands[side], place, size, light_colour(light))
        seen = layer.radiance
        if water is not None:
            seen = water.see_through(seen, layer.alpha, depth[side] / 1000.0)
        picture *= 1.0 - layer.alpha[..., None]
        picture += seen
        np.maximum(cover, layer.alpha, out=cover)
        laid.append((side, layer.alpha, inside))
    return _uncovered(laid), cover


def _uncovered(laid: Sequence[tuple[str, Float, float]]) -> list[PastedHand]:
    """Truth of hands laid one over the other, farthest first: what a nearer one covers is not seen."""
    hands = []
    for order, (side, alpha, inside) in enumerate(laid):
        free = alpha
        for _, nearer, _ in laid[order + 1 :]:
            free = np.asarray(free * (1.0 - nearer), np.float32)
        share = float(free.sum()) / max(float(alpha.sum()), 1e-6)
        hands.append(PastedHand(side, _outline(free), inside * share))
    return hands


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a hand goes: its wrist in the picture, pixels per millimetre, turn clockwise in degrees."""

    wrist: tuple[float, float]
    px_per_mm: float
    turn: float


def _placement(arm: ArmState, side: str, state: DiverState, camera: Camera) -> _Place:
    sign = 1.0 if side == "left" else -1.0
    shoulder = SHOULDER * np.array([sign, 1.0, 1.0])
    elbow = elbow_position(shoulder, arm.wrist, sign)
    rotation = rotation_matrix(state.rotation)
    image, size = camera.project(to_camera(np.stack([arm.wrist, elbow]), rotation, state.position))
    towards = image[0] - image[1]
    forearm = float(np.degrees(np.arctan2(towards[0], -towards[1])))
    # Positive roll leans the fingers to the thumb's side, which is inwards.
    wanted = -sign * float(arm.turn[2])
    lean = (wanted - forearm + 180.0) % 360.0 - 180.0
    turn = forearm + float(np.clip(lean, -WRIST_DEG, WRIST_DEG))
    return _Place((float(image[0, 0]), float(image[0, 1])), float(size[0]), turn)


def _matrix(cutout: Cutout, place: _Place) -> NDArray[np.float64]:
    _, y, width, height = cutout.box
    palm = height / HEIGHT_IN_PALMS.get(cutout.token, STRETCHED_IN_PALMS)
    # A hand that is much wider than high is not upright; its width then tells its size better.
    scale = PALM_MM * place.px_per_mm / max(palm, width / 2.6)
    anchor = (cutout.wrist[0], min(cutout.wrist[1], float(y + height)))
    matrix = np.asarray(cv2.getRotationMatrix2D(anchor, -place.turn, scale), np.float64)
    matrix[:, 2] += np.array(place.wrist) - np.array(anchor)
    return matrix


def _warp(shown: Shown, place: _Place, size: tuple[int, int], light: Float) -> tuple[Layer, float]:
    """The hand as a layer, and the share of it that is inside the picture of `size` (width, height)."""
    radiance = np.zeros((size[1], size[0], 3), np.float32)
    alpha = np.zeros((size[1], size[0]), np.float32)
    whole = inside = 0.0
    for cutout, weight in zip(shown.cutouts, shown.weights, strict=True):
        layers, matrix = _reduced(cutout, _matrix(cutout, place))
        layers *= np.float32(weight)
        area = abs(float(np.linalg.det(matrix[:, :2])))
        whole += float(layers[..., 3].sum()) * area
        window = _window(layers.shape[1::-1], matrix, size)
        if window is None:
            continue
        x, y, width, height = window
        matrix[:, 2] -= (x, y)
        warped = cv2.warpAffine(layers, matrix, (width, height), flags=cv2.INTER_LINEAR)
        inside += float(warped[..., 3].sum())
        radiance[y : y + height, x : x + width] += warped[..., :3]
        alpha[y : y + height, x : x + width] += warped[..., 3]
    radiance *= light
    return Layer(radiance, alpha), min(inside / max(whole, 1e-6), 1.0)


def _reduced(cutout: Cutout, matrix: NDArray[np.float64]) -> tuple[Float, NDArray[np.float64]]:
    """Premultiplied linear BGR and alpha (h, w, 4), with the matrix that places them.

    Averaged over areas first where they are shrunk, because interpolation alone would alias.
    """
    layers = np.dstack([decode(cutout.image) * cutout.alpha[..., None], cutout.alpha])
    scale = float(np.sqrt(abs(np.linalg.det(matrix[:, :2]))))
    if scale > 0.7:
        return np.asarray(layers, np.float32), matrix
    height, width = cutout.alpha.shape
    size = max(2, round(width * scale)), max(2, round(height * scale))
    small = np.asarray(cv2.resize(layers, size, interpolation=cv2.INTER_AREA), np.float32)
    back = np.diag([width / size[0], height / size[1], 1.0])
    # Centres of pixels, not their corners, keep their place.
    back[:2, 2] = 0.5 * (back[0, 0] - 1.0), 0.5 * (back[1, 1] - 1.0)
    return small, np.asarray(matrix @ back)


def _window(
    shape: tuple[int, ...], matrix: NDArray[np.float64], size: tuple[int, int]
) -> tuple[int, int, int, int] | None:
    """What a layer of `shape` (width, height) covers of a picture: x, y, width, height; None for nothing."""
    width, height = shape
    corners = np.array([[0, 0, 1], [width, 0, 1], [0, height, 1], [width, height, 1]], np.float64) @ matrix.T
    low = np.maximum(np.floor(corners.min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 2, size)
    if (high <= low).any():
        return None
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def _outline(alpha: Float) -> Box:
    x, y, width, height = cv2.boundingRect((alpha > 0.5).astype(np.uint8))
    return int(x), int(y), int(width), int(height)
