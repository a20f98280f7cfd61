"""The small frozen types that pass between the stages of finding hands."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
"""uint8 (height, width, 3), BGR."""

Box = tuple[int, int, int, int]
"""x, y, width, height in pixels of the source frame."""

Side = Literal["left", "right"]
"""The diver's own side: a diver faces the camera, so "right" is usually image-left."""


@dataclass(frozen=True, slots=True, eq=False)
class HandRegion:
    """A connected region that may be a hand.

    box: outline of the region without the forearm, source pixels.
    contour: int32 (n, 2), closed outline in source pixels.
    mask: bool (box height, box width), True on the region's own pixels.
    side: the diver's own side, or None before the sides are decided.
    confidence: 0 to 1, how sure the selector is that this is a hand.
    """

    box: Box
    contour: NDArray[np.int32]
    mask: NDArray[np.bool_]
    side: Side | None
    confidence: float


@dataclass(frozen=True, slots=True)
class Track:
    """One hand followed through the frames.

    number: grows by one at each birth, never used twice in a stream.
    side: the diver's own side, kept for the life of the track.
    box: filtered position and size, source pixels.
    confidence: the selector's confidence in the region that last updated the track, 0 to 1.
    age: frames since birth. missed: frames since the last matching region, 0 when seen now.
    """

    number: int
    side: Side
    box: Box
    confidence: float
    age: int
    missed: int
