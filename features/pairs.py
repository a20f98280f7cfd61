"""Numbers of a pair of regions: do they look like the two hands of one person?

Two hands that sign are about as large and as high as each other, stand apart, and have one skin.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.proposals import Proposals
from lightgesture.features.wrist import fill_contour

Float = NDArray[np.float32]

COLUMNS = 15
"""Numbers of one pair."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A scored proposal. box: x, y, width, height, working pixels. score: predicted IoU with a hand.
    level: 0 to 31. colour: float32 (4,), mean blue, green, red and skin inside the outline, 0 to 1."""

    box: NDArray[np.float32]
    score: float
    level: float
    colour: Float


def candidate(colour: ColourMap, proposals: Proposals, index: int, score: float) -> Candidate:
    """The numbers of one proposal that its pairs need."""
    x, y, width, height = (int(value) for value in proposals.boxes[index])
    mask = fill_contour(proposals.contours[index], (x, y, width, height))
    window = slice(y, y + height), slice(x, x + width)
    means = cv2.mean(colour.picture[window], mask)[:3] + cv2.mean(colour.skin[window], mask)[:1]
    return Candidate(
        box=proposals.boxes[index].astype(np.float32),
        score=score,
        level=float(proposals.levels[index]),
        colour=np.array(means, np.float32) / np.float32(255.0),
    )


def describe_pair(first: Candidate, second: Candidate, size: tuple[int, int]) -> Float:
    """float32 (15,), the same whichever of the two comes first; `size` (width, height), working pixels."""
    a, b = sorted((first, second), key=lambda item: float(item.box[0] + item.box[2] / 2))
    centre_a, centre_b = a.box[:2] + a.box[2:] / 2, b.box[:2] + b.box[2:] / 2
    side_a, side_b = np.sqrt(a.box[2:].prod()), np.sqrt(b.box[2:].prod())
    unit = np.sqrt(side_a * side_b)
    apart = (centre_b - centre_a) / unit
    gap = (b.box[0] - a.box[0] - a.box[2]) / unit
    middle = (centre_a + centre_b) / 2
    contrast = np.log((a.colour + 0.02) / (b.colour + 0.02))
    return np.array(
        [
            min(a.score, b.score),
            max(a.score, b.score),
            abs(np.log(side_a / side_b)),
            abs(np.log(a.box[2] / b.box[2])),
            abs(np.log(a.box[3] / b.box[3])),
            apart[0],
            abs(apart[1]),
            gap,
            abs((a.box[1] + a.box[3]) - (b.box[1] + b.box[3])) / unit,
            middle[0] / size[0],
            middle[1] / size[1],
            np.log(unit / min(size)),
            abs(contrast[:3].mean()),
            abs(contrast[2] - contrast[1]),
            abs(a.level - b.level),
        ],
        np.float32,
    )
