"""A frame: what a source gives and the pipeline takes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One picture of a stream.

    image: uint8 (height, width, 3), BGR, in the source's own pixels.
    index: position in the source, 0-based.
    time_s: seconds since the start of the source, by the container's time stamp; for a folder of
        frames, index divided by the frame rate that the user names.
    gap: what is missing between the last frame and this one, in words; None: nothing that the source knows of.
    """

    image: NDArray[np.uint8]
    index: int
    time_s: float
    gap: str | None = None
