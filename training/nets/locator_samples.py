"""Samples for the locator: whole pictures, moved and in another light, with the maps that the net is to give."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.locator import DETAIL, STRIDE
from lightgesture.features.standardise import channel_tables
from lightgesture.features.types import Box, Float, Image
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.light import photometric
from lightgesture.training.pictures.real_divers import RealDivers

Random = np.random.Generator
WIDTH, HEIGHT = 160, 120
"""Working picture, pixels."""
FILLED = 128
"""Its height filled up to a multiple of 16."""


REAL_SHARE: Final = 0.22
EMPTY_SHARE: Final = 0.10
DIVER_SHARE: Final = 0.36
"""Of samples, those of whole frames, of water without a hand and of real divers; the rest is composed, and all that
would be of divers where there are none. With 0.45 to 0.6 of divers half as many signs again are found on dives that
were left out as with 0.22; the shipped net learnt at 0.45 first, and then at this, with more composed hands again."""
REAL_SCALE: Final = (0.6, 1.5)
EMPTY_SCALE: Final = (0.7, 2.2)
DIVER_SCALE: Final = (0.75, 2.4)
COMPOSED_SCALE: Final = (0.75, 1.5)
"""Range of the size of each kind; 1 fills the working picture."""
TURNED_SHARE: Final = 0.4
"""Of samples, those that are turned."""
TURN_DEG: Final = 8.0
"""Their standard deviation."""
STRETCH: Final = 0.06
"""Standard deviation of the logarithm of the aspect."""
LEAST_VISIBLE: Final = 0.55
"""Share of a hand that must be inside to be learnt."""
LEAST_SIDE: Final = 5.0
"""Side of a hand that is learnt, working pixels."""
SPREAD: Final = 0.18
"""Standard deviation of a heat spot over the box's side."""
NEAR: Final = 0.45
"""Heat above which a cell learns the box."""


@dataclass(frozen=True, slots=True, eq=False)
class Targets:
    """On cells of 4 pixels. heat, weight: (2, h, w) of hands and faces. box: (4, h, w), distances to left, upper, right
    and lower edge, pixels. box_weight: (h, w)."""

    heat: Float
    weight: Float
    box: Float
    box_weight: Float


def warp(
    picture: BoxedPicture, rng: Random, scales: tuple[float, float]
) -> tuple[Image, Float, Float, Float]:
    """What the net sees of it, and the corners (x0, y0, x1, y1), working pixels, of hands, faces and what is ignored,
    (n, 4) each."""
    image = picture.image
    height, width = image.shape[:2]
    scale = min(WIDTH / width, HEIGHT / height) * float(np.exp(rng.uniform(*np.log(scales))))
    turn = np.deg2rad(rng.normal(0, TURN_DEG)) if rng.random() < TURNED_SHARE else 0.0
    stretch = float(np.exp(rng.normal(0, STRETCH)))
    flip = -1.0 if rng.random() < 0.5 else 1.0
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    linear = rotation @ np.diag([scale * stretch * flip, scale / stretch])
    free = (
        np.maximum(np.abs([width * scale - WIDTH, height * scale - HEIGHT]), (0.12 * WIDTH, 0.12 * HEIGHT))
        / 2
    )
    middle = np.array([WIDTH, HEIGHT]) / 2 + rng.uniform(-free, free)
    shift = middle - linear @ (np.array([width, height]) / 2)
    fill = cv2.BORDER_REPLICATE if rng.random() < 0.5 else cv2.BORDER_CONSTANT
    out = _transformed(image, linear, shift, scale, fill)
    hands, faces, ignored = (
        moved(boxes, linear, shift) for boxes in (picture.boxes, picture.faces, picture.ignored)
    )
    return out, hands, faces, ignored


def _transformed(
    image: Image, linear: NDArray[np.float64], shift: NDArray[np.float64], scale: float, fill: int
) -> Image:
    mean = cv2.mean(image)
    own = np.ones(2)
    if DETAIL * scale < 0.6:  # interpolation alone would alias
        share = max(DETAIL * scale, 0.5)
        small = np.asarray(
            cv2.resize(image, None, fx=share, fy=share, interpolation=cv2.INTER_AREA), np.uint8
        )
        own = np.array([image.shape[1] / small.shape[1], image.shape[0] / small.shape[0]])
        image = small
    # Boxes count from corners of pixels, warpAffine from their centres.
    matrix = np.column_stack([DETAIL * linear * own, DETAIL * (shift + linear @ (0.5 * own)) - 0.5])
    size = DETAIL * WIDTH, DETAIL * HEIGHT
    return np.asarray(cv2.warpAffine(image, matrix, size, borderMode=fill, borderValue=mean), np.uint8)


def moved(boxes: Sequence[Box], linear: NDArray[np.float64], shift: NDArray[np.float64]) -> Float:
    """Corners round the ellipses inscribed in the boxes, which a turn does not inflate: float32 (n, 4)."""
    values = np.array(boxes, np.float64).reshape(-1, 4)
    half = values[:, 2:] / 2
    centres = (values[:, :2] + half) @ linear.T + shift
    reach = np.sqrt((half**2) @ (linear**2).T)
    return np.concatenate([centres - reach, centres + reach], axis=1).astype(np.float32)


def make_targets(hands: Float, faces: Float, all_faces: bool, ignored: Float | None = None) -> Targets:
    """Maps for corners (n, 4). Where not all faces are known, only cells round the known ones and on hands count; on
    what is ignored, no hand counts."""
    rows, columns = FILLED // STRIDE, WIDTH // STRIDE
    maps = Targets(
        np.zeros((2, rows, columns), np.float32),
        np.ones((2, rows, columns), np.float32),
        np.zeros((4, rows, columns), np.float32),
        np.zeros((rows, columns), np.float32),
    )
    maps.weight[1] = float(all_faces)
    best = np.zeros((rows, columns), np.float32)
    y, x = ((np.mgrid[0:rows, 0:columns] + 0.5) * STRIDE).astype(np.float32)
    limits = np.array([WIDTH, HEIGHT, WIDTH, HEIGHT], np.float32)
    for corners in () if ignored is None else ignored:
        _unlearn(maps, np.clip(corners, 0, limits))
    for corners in hands:
        seen = np.clip(corners, 0, limits)
        area, whole = _area(seen), _area(corners)
        if area <= 0:
            continue
        if area < LEAST_VISIBLE * whole or area < LEAST_SIDE**2:
            _unlearn(maps, seen)
            continue
        spot = _spot(maps.heat[0], seen, x, y)
        near = (spot > best) & (spot > NEAR)
        np.maximum(best, spot, out=best)
        distances = np.stack([x - seen[0], y - seen[1], seen[2] - x, seen[3] - y])
        maps.box[:, near] = distances[:, near]
        maps.box_weight[near] = spot[near]
        maps.weight[1][spot > 0.2] = 1  # a hand is no face
    for corners in faces:
        seen = np.clip(corners, 0, limits)
        if _area(seen) >= 0.5 * _area(corners) > 0:
            spot = _spot(maps.heat[1], seen, x, y)
            maps.weight[1][spot > 0.01] = 1
    maps.box_weight[maps.box.min(axis=0) <= 0] = 0
    return maps


def _unlearn(maps: Targets, corners: Float) -> None:
    left, top, right, bottom = (corners / STRIDE).astype(int)
    maps.weight[0, top : bottom + 1, left : right + 1] = 0


def _area(corners: Float) -> float:
    return float(max(corners[2] - corners[0], 0) * max(corners[3] - corners[1], 0))


def _spot(heat: Float, corners: Float, x: Float, y: Float) -> Float:
    """Draw a Gaussian of height 1 at the middle of a box into `heat`; the Gaussian alone."""
    middle = (corners[:2] + corners[2:]) / 2
    wide, tall = np.maximum(SPREAD * (corners[2:] - corners[:2]), 0.45 * STRIDE)
    spot = np.exp(-((x - middle[0]) ** 2 / (2 * wide**2) + (y - middle[1]) ** 2 / (2 * tall**2)))
    column, row = (middle / STRIDE).astype(int)
    spot[min(row, heat.shape[0] - 1), min(column, heat.shape[1] - 1)] = 1
    np.maximum(heat, spot, out=heat)
    return np.asarray(spot, np.float32)


class LocatorSamples:
    """Draws samples without end."""

    def __init__(
        self,
        frames: Sequence[BoxedPicture],
        empty: Sequence[BoxedPicture],
        composed: Sequence[BoxedPicture],
        divers: RealDivers | None = None,
    ) -> None:
        """Each holds at least one picture."""
        self._frames, self._empty, self._composed, self._divers = frames, empty, composed, divers

    def draw(self, rng: Random) -> tuple[Float, Targets]:
        """Standardised picture, float32 (256, 320, 3), and its targets."""
        kind = rng.random()
        pictures, scales = self._composed, COMPOSED_SCALE
        in_air = kind < REAL_SHARE
        if in_air:
            pictures, scales = self._frames, REAL_SCALE
        elif kind < REAL_SHARE + EMPTY_SHARE:
            pictures, scales = self._empty, EMPTY_SCALE
        picture = pictures[int(rng.integers(len(pictures)))]
        if self._divers is not None and kind > 1.0 - DIVER_SHARE:
            picture, scales = self._divers.draw(rng)[1], DIVER_SCALE
        image, hands, faces, ignored = warp(picture, rng, scales)
        image = photometric(image, rng, in_air)
        seen = np.zeros((DETAIL * FILLED, DETAIL * WIDTH, 3), np.float32)
        seen[: DETAIL * HEIGHT] = cv2.LUT(image, channel_tables(image))
        return seen, make_targets(hands, faces, picture.all_faces, ignored)
