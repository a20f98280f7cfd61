"""The last reading of each hand, and whether it still stands: a hand that is held still is not read in every frame.

In every frame the place in which a hand was read is looked at. A sign that changes moves edges of the hand there, which
changes a cell of a coarse picture by as much as hand and background differ; noise, and a hand that trembles, change it
far less. So the reading of an unchanged place stands for a moment, and a hand that moved or changed is read at once.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.geometry import box_iou
from lightgesture.features.patch import Square, cut_squares, shrink_square, squares_round
from lightgesture.features.types import Box, Image

STANDS_S: Final = 0.09
"""Seconds after which a hand is read again however still it is: two frames of three are spared at 30 a second, none at
10."""
SURE: Final = 0.9
"""Probability of the likeliest class from which a reading may stand, 0 to 1; in doubt every frame is read."""
CHANGED: Final = 0.45
"""By how much a cell may change, over the deviation of the cells. Of neighbouring frames of signing hands, rendered and
real, seven in ten change less, and 6 in 1,000 of these read otherwise."""
SAME_IOU: Final = 0.7
"""Overlap of the box with the one in which the hand was read, below which it is another place."""
CONTEXT: Final = 1.2
"""Side of the place that is looked at over the longer side of the box."""
SAMPLED: Final = 32
CELLS: Final = 8
"""Pixels to which a place is sampled, and cells of which each is the mean of some, along each side."""


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """row: probabilities (classes,) as read at `time_s` seconds. extent: number of the extent that read most clearly.
    others: (extents - 1, classes), those of the hand's other extents, as read at `others_s`. cells: uint8 (CELLS,
    CELLS, 3), what the place `square` showed; most: by how much a cell of it may change."""

    row: NDArray[np.float32]
    extent: int
    others: NDArray[np.float32]
    others_s: float
    box: Box
    square: Square
    cells: Image
    most: float
    time_s: float


def says_the_same(row: NDArray[np.float32], look: Look) -> bool:
    """Whether a hand's box is read surely, as what all its extents said: then reading the others would tell nothing."""
    likeliest = int(row.argmax())
    return bool(row[likeliest] >= SURE and likeliest == look.row.argmax())


class LastLooks:
    """Of one stream, the last reading of each hand, by the number of its track."""

    def __init__(self) -> None:
        self._looks: dict[int, Look] = {}

    def keep_only(self, tracks: Collection[int | None]) -> None:
        """Forget the hands that are not among these."""
        for number in self._looks.keys() - set(tracks):
            del self._looks[number]

    def standing(self, image: Image, track: int | None, box: Box, time_s: float) -> Look | None:
        """The last reading of a hand that is in this box now, if it still stands."""
        look = None if track is None else self._looks.get(track)
        if look is None or not 0.0 <= time_s - look.time_s < STANDS_S or box_iou(box, look.box) < SAME_IOU:
            return None
        change = cv2.norm(_cells(image, look.square), look.cells, cv2.NORM_INF)
        return look if change <= look.most else None

    def recent(self, track: int | None, box: Box, time_s: float) -> Look | None:
        """The last reading of a hand that is about in this box, where its other extents were read a moment ago."""
        look = None if track is None else self._looks.get(track)
        if look is None or not 0.0 <= time_s - look.others_s < STANDS_S or box_iou(box, look.box) < SAME_IOU:
            return None
        return look

    def keep(
        self,
        image: Image,
        track: int | None,
        box: Box,
        read: tuple[NDArray[np.float32], int, NDArray[np.float32], float],
        time_s: float,
    ) -> None:
        """Keep what was just read of a hand, where it may stand; read: the first four fields of `Look`."""
        if track is None:
            return
        if read[0].max() < SURE:
            self._looks.pop(track, None)
            return
        (square,) = squares_round([box], CONTEXT)
        cells = _cells(image, square)
        most = CHANGED * float(cv2.meanStdDev(cells)[1].max())
        self._looks[track] = Look(*read, box, square, cells, most, time_s)


def _cells(image: Image, square: Square) -> Image:
    sampled = np.empty((SAMPLED, SAMPLED, 3), np.uint8)
    shrink_square(cut_squares(image, [square])[0], sampled)
    return np.asarray(cv2.resize(sampled, (CELLS, CELLS), interpolation=cv2.INTER_AREA), np.uint8)
