"""Numbers of what locator and refiner say of a place, for the small trees that decide how far to believe them.

Each net knows something that the other does not: the locator sees the person round the hand, the refiner sees its
fingers. The trees predict the overlap (IoU) of the refined box with a hand, from 0 for none.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.find.pairs import FAR
from lightgesture.features.find.peaks import Peaks
from lightgesture.features.geometry import pairwise_iou

Float = NDArray[np.float32]

COLUMNS = 14
"""Numbers of one place."""


@dataclass(frozen=True, slots=True, eq=False)
class Refined:
    """What the refiner says of n windows.

    boxes: float32 (n, 4), x, y, width, height in working pixels. hand: float32 (n,), logit of being a hand.
    """

    boxes: Float
    hand: Float


def logit(probabilities: Float) -> Float:
    """log(p / (1 - p)), kept finite."""
    p = np.clip(probabilities, 1e-4, 1.0 - 1e-4)
    return np.asarray(np.log(p / (1.0 - p)), np.float32)


def describe_places(peaks: Peaks, refined: Refined, size: tuple[int, int]) -> Float:
    """float32 (n, COLUMNS), one row for each peak; `size` (width, height) of the working picture."""
    count = len(peaks.heat)
    if not count:
        return np.zeros((0, COLUMNS), np.float32)
    boxes = refined.boxes
    own = pairwise_iou(peaks.boxes, boxes).diagonal()
    sides = np.sqrt(boxes[:, 2] * boxes[:, 3])
    centres = boxes[:, :2] + boxes[:, 2:] / 2
    others = pairwise_iou(boxes, boxes) - np.eye(count)
    to_face = np.full((count, 2), FAR)
    if peaks.face is not None:
        to_face = np.abs(centres - np.array(peaks.face)) / sides[:, None]
    inside = np.clip(np.minimum(boxes[:, :2] + boxes[:, 2:], size) - np.maximum(boxes[:, :2], 0), 0, None)
    return np.column_stack(
        [
            logit(peaks.heat),
            refined.hand,
            own,
            np.log(sides / min(size)),
            np.log(boxes[:, 2] / boxes[:, 3]),
            np.log(sides / np.sqrt(peaks.boxes[:, 2] * peaks.boxes[:, 3])),
            centres / np.array(size),
            to_face,
            others.max(axis=1),
            inside.prod(axis=1) / (boxes[:, 2] * boxes[:, 3]),
            np.arange(count),
            np.full(count, count),
        ]
    ).astype(np.float32)
