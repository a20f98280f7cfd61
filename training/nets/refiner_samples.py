"""Samples for the refiner: windows round hands, round what the locator took for hands, and elsewhere."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.refiner import SIZE, cut_windows, windows_round
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.patch import Square
from lightgesture.features.standardise import channel_tables, luma_tables
from lightgesture.features.types import Image
from lightgesture.training.pictures.photometric import PhotometricSettings, photometric
from lightgesture.training.regions.trees import BoxedPicture

Float = NDArray[np.float32]
Random = np.random.Generator


@dataclass(frozen=True, slots=True)
class RefinerSampling:
    """What is drawn.

    windows: of one picture. real, empty: shares of whole frames and of water; the rest is composed.
    hand, hard, beside, face: up to which draw a window lies on a hand, on a false peak, beside a hand, on a face;
        beyond, anywhere. jitter: standard deviation of the place over the side; resize: of the logarithm of the size.
    turned, turn_rad: share of turned windows and the standard deviation.
    hand_iou: overlap from which a window is one of a hand; none_iou: below which it is none; between, it counts not.
    """

    windows: int = 8
    real: float = 0.42
    empty: float = 0.1
    hand: float = 0.55
    hard: float = 0.85
    beside: float = 0.93
    face: float = 0.97
    jitter: float = 0.1
    resize: float = 0.13
    turned: float = 0.4
    turn_rad: float = 0.12
    hand_iou: float = 0.35
    none_iou: float = 0.2
    light: PhotometricSettings = field(default_factory=PhotometricSettings)


def cut_turned(image: Image, window: Square, size: int, turn: float, flip: bool) -> Image:
    """A window of the picture turned about the window's middle and mirrored.

    The board never turns a window; training does, because people lean their hands more ways than the pictures
    show, and because a mirrored left hand is a right one. Only the window's own pixels are turned.
    """
    left, top, side = window
    if turn:
        middle = left + side / 2 - 0.5, top + side / 2 - 0.5
        matrix = cv2.getRotationMatrix2D(middle, float(-np.rad2deg(turn)), 1.0)
        matrix[:, 2] -= left, top
        turned = cv2.warpAffine(image, matrix, (side, side), borderMode=cv2.BORDER_REPLICATE)
        image, window = np.asarray(turned, np.uint8), (0, 0, side)
    cut = cut_windows(image, [window], size)[0]
    return np.ascontiguousarray(cut[:, ::-1]) if flip else cut


def standardised(cut: Image, tables: Float) -> Float:
    """float32 (size, size, 4): colours by the tables of the picture, luma by the window's own."""
    luma, table = luma_tables(cut[None])
    return np.dstack([cv2.LUT(cut, tables), cv2.LUT(luma[0], table)]).astype(np.float32)


def target_edges(box: NDArray[np.floating], window: Square, turn: float, flip: bool) -> Float:
    """Left, upper, right and lower edge of a hand from the window's middle in window sides, after turn and mirror."""
    left, top, side = window
    mirror = -1.0 if flip else 1.0
    cosine, sine = np.cos(turn), np.sin(turn)
    linear = np.array([[mirror * cosine, -mirror * sine], [sine, cosine]])
    half = np.asarray(box[2:], np.float64) / 2 / side
    middle = linear @ ((box[:2] + box[2:] / 2 - (left + side / 2, top + side / 2)) / side)
    reach = np.sqrt(linear**2 @ half**2)
    return np.concatenate([middle - reach, middle + reach]).astype(np.float32)


class RefinerSamples:
    """Draws windows without end. Each kind is a list of (picture, float (n, 4) boxes of false peaks), at least one."""

    def __init__(
        self,
        frames: Sequence[tuple[BoxedPicture, Float]],
        empty: Sequence[tuple[BoxedPicture, Float]],
        composed: Sequence[tuple[BoxedPicture, Float]],
        settings: RefinerSampling | None = None,
    ) -> None:
        self._frames, self._empty, self._composed = frames, empty, composed
        self._settings = settings or RefinerSampling()

    def draw(self, rng: Random) -> tuple[Float, Float]:
        """Windows, float32 (n, 32, 32, 4), and targets (n, 6): hand or not, four edges, weight."""
        settings, kind = self._settings, rng.random()
        pictures = self._composed
        if kind < settings.real + settings.empty:
            pictures = self._frames if kind < settings.real else self._empty
        picture, hard = pictures[int(rng.integers(len(pictures)))]
        image = photometric(picture.image, rng, kind < settings.real, settings.light)
        tables = channel_tables(image)
        hands = np.array(picture.boxes, np.float64).reshape(-1, 4)
        faces = np.array(picture.faces, np.float64).reshape(-1, 4)
        windows, targets = [], []
        for _ in range(settings.windows):
            box = self._box(rng, hands, np.asarray(hard, np.float64), faces, image.shape[:2])
            window = windows_round(box[None], image)[0]
            turn = rng.normal(0, settings.turn_rad) if rng.random() < settings.turned else 0.0
            flip = bool(rng.random() < 0.5)
            cut = cut_turned(image, window, SIZE, turn, flip)
            windows.append(standardised(cut, tables))
            targets.append(self._target(box, hands, window, turn, flip))
        return np.stack(windows), np.stack(targets)

    def _target(
        self, box: NDArray[np.float64], hands: NDArray[np.float64], window: Square, turn: float, flip: bool
    ) -> Float:
        overlaps = pairwise_iou(box[None], hands)[0] if len(hands) else np.zeros(0)
        target = np.zeros(6, np.float32)
        best = float(overlaps.max()) if len(overlaps) else 0.0
        target[5] = 1.0
        if best >= self._settings.hand_iou:
            target[0] = 1.0
            target[1:5] = target_edges(hands[overlaps.argmax()], window, turn, flip)
        elif best >= self._settings.none_iou:
            target[5] = 0.0
        return target

    def _box(
        self,
        rng: Random,
        hands: NDArray[np.float64],
        hard: NDArray[np.float64],
        faces: NDArray[np.float64],
        shape: tuple[int, ...],
    ) -> NDArray[np.float64]:
        settings, kind = self._settings, rng.random()
        if len(hands) and kind < settings.hand:
            # Most as wrong as a locator, some as wrong as the prediction of a track.
            wrong = 1.0 if rng.random() < 0.7 else 2.0
            return _jittered(
                _any(hands, rng), rng, settings.jitter * wrong, settings.resize * wrong, 0.1 * wrong
            )
        if len(hard) and kind < settings.hard:
            return _jittered(_any(hard, rng), rng, 0.05, 0.1, 0.0)
        if len(hands) and kind < settings.beside:
            x, y, width, height = _any(hands, rng)
            x, y = x + rng.normal(0, 0.5) * width, y + rng.uniform(-0.3, 1.3) * height
            return np.array([x, y, *(np.array([width, height]) * np.exp(rng.normal(0, 0.25, 2)))])
        if len(faces) and kind < settings.face:
            return _jittered(_any(faces, rng), rng, 0.2, 0.3, 0.2)
        side = float(np.exp(rng.uniform(np.log(0.06), np.log(0.45)))) * shape[0]
        x, y = rng.uniform(0, shape[1]), rng.uniform(0, shape[0])
        return np.array([x - side / 2, y - side / 2, side * rng.uniform(0.7, 1.1), side])


def _any(boxes: NDArray[np.float64], rng: Random) -> NDArray[np.float64]:
    return np.asarray(boxes[int(rng.integers(len(boxes)))])


def _jittered(
    box: NDArray[np.float64], rng: Random, shift: float, resize: float, stretch: float
) -> NDArray[np.float64]:
    middle = box[:2] + box[2:] / 2 + rng.normal(0, shift, 2) * box[2:]
    aspect = np.exp(rng.normal(0, stretch))
    size = box[2:] * np.exp(rng.normal(0, resize)) * (aspect, 1 / aspect)
    return np.concatenate([middle - size / 2, size])
