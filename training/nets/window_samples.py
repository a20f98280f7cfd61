"""Samples for refiner and verifier: windows round hands, round what the locator took for hands, and elsewhere."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourStage
from lightgesture.features.find import refiner, verifier
from lightgesture.features.find.locator import Locator, find_peaks
from lightgesture.features.find.windows import WindowSettings, cut_windows, windows_round
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.patch import Square
from lightgesture.features.standardise import channel_tables, luma_tables
from lightgesture.features.types import Float, Image
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.light import photometric
from lightgesture.training.pictures.real_divers import RealDivers

Random = np.random.Generator


WINDOWS: Final = 8
"""Of one picture."""
EMPTY_SHARE: Final = 0.08
"""Of samples, those of water without a hand."""
HAND, HARD, BESIDE, FACE = 0.55, 0.85, 0.93, 0.97
"""Up to which draw a window lies on a hand, on a false peak, beside a hand, on a face; beyond, anywhere."""
JITTER: Final = 0.1
"""Standard deviation of the place over the side."""
RESIZE: Final = 0.13
"""Standard deviation of the logarithm of the size."""
TURNED_SHARE: Final = 0.4
"""Of windows, those that are turned."""
TURN_RAD: Final = 0.12
"""Their standard deviation."""
MOST_PEAKS: Final = 12
LEAST_HEAT: Final = 0.03
"""More and weaker peaks than are looked at on the board."""
FALSE_IOU: Final = 0.3
"""A peak whose box overlaps every hand less is false."""
MOST_FALSE: Final = 8
"""False peaks kept of one picture."""


@dataclass(frozen=True, slots=True)
class SampleSettings:
    """What a net that looks at windows learns from."""

    window: WindowSettings
    real_share: float
    """Of samples, those of whole frames in rooms, 0 to 1."""
    diver_share: float
    """Those of real divers, 0 to 1; where there are none, composed ones. The rest is of water without a hand
    (`EMPTY_SHARE`) and composed."""
    none_iou: float
    """Overlap below which a window is none of a hand; between this and `hand_iou` it does not count."""
    hand_iou: float
    """Overlap from which a window is one of a hand."""
    sees: Callable[[Image, Float], Float]
    """What the net sees of a window, uint8 (size, size, 3), of a picture with these `channel_tables`: float32 (size,
    size, channels)."""


def in_its_picture(cut: Image, tables: Float) -> Float:
    """Colours by the tables of the picture, luma by the window's own: float32 (size, size, 4)."""
    luma, table = luma_tables(cut[None])
    return np.dstack([cv2.LUT(cut, tables), cv2.LUT(luma[0], table)]).astype(np.float32)


def by_itself(cut: Image, _: Float) -> Float:
    """Colours by the window's own tables: float32 (size, size, 3)."""
    return np.asarray(cv2.LUT(cut, channel_tables(cut)), np.float32)


REFINER: Final = SampleSettings(
    refiner.WINDOW, real_share=0.26, diver_share=0.33, none_iou=0.2, hand_iou=0.35, sees=in_its_picture
)
VERIFIER: Final = SampleSettings(
    verifier.WINDOW, real_share=0.18, diver_share=0.45, none_iou=0.3, hand_iou=0.45, sees=by_itself
)
"""What is verified is a refined box, which is a hand's or is not; more real divers, whose water it is there for."""


def hard_regions(
    pictures: Iterable[BoxedPicture], locator: IntegerNetwork
) -> list[tuple[BoxedPicture, Float]]:
    """Each picture with what the locator takes for hands in it, the refiner's hardest examples.

    That is the boxes of its false peaks, (n, 4), pixels of the picture, hottest first.
    """
    net, stage, found = Locator(locator), ColourStage(), []
    for picture in pictures:
        colour = stage.process(picture.image)
        maps = net.process(colour, net.table(colour.picture))
        boxes = find_peaks(maps, MOST_PEAKS, LEAST_HEAT).boxes * np.tile(
            np.array(colour.scale, np.float32), 2
        )
        if picture.boxes and len(boxes):
            overlap = pairwise_iou(boxes, np.array(picture.boxes, np.float64)).max(axis=1)
            boxes = boxes[overlap < FALSE_IOU]
        found.append((picture, np.asarray(boxes[:MOST_FALSE], np.float32)))
    return found


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


class WindowSamples:
    """Draws windows without end. Each kind is a list of (picture, float (n, 4) boxes of false peaks), at least one."""

    def __init__(
        self,
        frames: Sequence[tuple[BoxedPicture, Float]],
        empty: Sequence[tuple[BoxedPicture, Float]],
        composed: Sequence[tuple[BoxedPicture, Float]],
        divers: RealDivers | None,
        mistaken: Sequence[Float],
        settings: SampleSettings,
    ) -> None:
        """mistaken: boxes of false peaks of each of the divers' pictures."""
        self.settings = settings
        self._frames, self._empty, self._composed = frames, empty, composed
        self._divers, self._mistaken = divers, mistaken

    def draw(self, rng: Random) -> tuple[Float, Float]:
        """Windows, float32 (n, size, size, channels), and targets (n, 6): hand or not, four edges, weight."""
        own, kind = self.settings, rng.random()
        pictures = self._composed
        if kind < own.real_share + EMPTY_SHARE:
            pictures = self._frames if kind < own.real_share else self._empty
        picture, hard = pictures[int(rng.integers(len(pictures)))]
        if self._divers is not None and kind > 1.0 - own.diver_share:
            place, picture = self._divers.draw(rng)
            hard = self._mistaken[place]
        image = photometric(picture.image, rng, kind < own.real_share)
        tables = channel_tables(image)
        hands = np.array(picture.boxes, np.float64).reshape(-1, 4)
        faces = np.array(picture.faces, np.float64).reshape(-1, 4)
        ignored = np.array(picture.ignored, np.float64).reshape(-1, 4)
        windows, targets = [], []
        for _ in range(WINDOWS):
            box = self._box(rng, hands, np.asarray(hard, np.float64), faces, image.shape[:2])
            window = windows_round(box[None], image, own.window)[0]
            turn = rng.normal(0, TURN_RAD) if rng.random() < TURNED_SHARE else 0.0
            flip = bool(rng.random() < 0.5)
            cut = cut_turned(image, window, own.window.size, turn, flip)
            windows.append(own.sees(cut, tables))
            target = self._target(box, hands, window, turn, flip)
            if target[0] == 0.0 and len(ignored) and pairwise_iou(box[None], ignored).max() >= own.none_iou:
                target[5] = 0.0
            targets.append(target)
        return np.stack(windows), np.stack(targets)

    def _target(
        self, box: NDArray[np.float64], hands: NDArray[np.float64], window: Square, turn: float, flip: bool
    ) -> Float:
        overlaps = pairwise_iou(box[None], hands)[0] if len(hands) else np.zeros(0)
        target = np.zeros(6, np.float32)
        best = float(overlaps.max()) if len(overlaps) else 0.0
        target[5] = 1.0
        if best >= self.settings.hand_iou:
            target[0] = 1.0
            target[1:5] = target_edges(hands[overlaps.argmax()], window, turn, flip)
        elif best >= self.settings.none_iou:
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
        kind = rng.random()
        if len(hands) and kind < HAND:
            # Most as wrong as a locator, some as wrong as the prediction of a track.
            wrong = 1.0 if rng.random() < 0.7 else 2.0
            return _jittered(_any(hands, rng), rng, JITTER * wrong, RESIZE * wrong, 0.1 * wrong)
        if len(hard) and kind < HARD:
            return _jittered(_any(hard, rng), rng, 0.05, 0.1, 0.0)
        if len(hands) and kind < BESIDE:
            x, y, width, height = _any(hands, rng)
            x, y = x + rng.normal(0, 0.5) * width, y + rng.uniform(-0.3, 1.3) * height
            return np.array([x, y, *(np.array([width, height]) * np.exp(rng.normal(0, 0.25, 2)))])
        if len(faces) and kind < FACE:
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
