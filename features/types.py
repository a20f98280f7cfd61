"""The small frozen types that pass between the stages of finding hands."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.uint8]
"""uint8 (height, width, 3), BGR."""

Float = NDArray[np.float32]
"""Numbers of any shape."""

Contour = NDArray[np.int32]
"""int32 (n, 2), a closed outline, x and y, pixel by pixel."""

Box = tuple[int, int, int, int]
"""x, y, width, height in pixels of the source frame."""

Side = Literal["left", "right"]
"""The diver's own side: a diver faces the camera, so "right" is usually image-left."""


@dataclass(frozen=True, slots=True, eq=False)
class HandRegion:
    """A connected region that may be a hand.

    box: outline of the region without the forearm, source pixels.
    contour: int32 (n, 2), closed outline in source pixels; of length 0 where nobody has asked for it, because the
        learned choice finds boxes without outlines (`selector.outlined` draws them).
    side: the diver's own side, or None before the sides are decided.
    confidence: 0 to 1, how sure the selector is that this is a hand.
    alternatives: other extents of the same region, best first: with or without the forearm, at another level
        of the skin map. Whoever reads the hand may find that one of them fits better.
    certainty: how sure the side is, 0 to 1; a factor on the confidence of what is read.
    """

    box: Box
    contour: NDArray[np.int32]
    side: Side | None
    confidence: float
    alternatives: tuple[Box, ...] = ()
    certainty: float = 1.0

    @property
    def number(self) -> None:
        """A region on its own is of no track."""
        return None


@dataclass(frozen=True, slots=True, eq=False)
class Candidates:
    """The regions of one frame that may be hands, and how well each two of them go together.

    regions: best first, at most a handful, sides not yet decided.
    pairs: float32 (n, n), symmetric, 0 to 1: how sure the selector is that both are the hands of one
        person; 0 on the diagonal and for regions that overlap.
    source_size: (width, height) of the frame, pixels.
    face: centre (x, y) of the diver's face, source pixels, through which the axis of the body goes; None where none is
        seen.
    """

    regions: tuple[HandRegion, ...]
    pairs: NDArray[np.float32]
    source_size: tuple[int, int]
    face: tuple[float, float] | None = None
