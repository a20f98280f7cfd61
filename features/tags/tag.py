"""One tag in a picture, and what its cells say of how well it is seen."""

from dataclasses import dataclass
from functools import cache
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.tags.sampling import PLACES, cell_values, sharpened
from lightgesture.features.tags.settings import TagSettings
from lightgesture.features.types import Float

DICTIONARIES: Final = {
    "25h9": cv2.aruco.DICT_APRILTAG_25H9,
    "36h10": cv2.aruco.DICT_APRILTAG_36H10,
    "36h11": cv2.aruco.DICT_APRILTAG_36H11,
}
"""Families of tags that are read."""


@dataclass(frozen=True, slots=True, eq=False)
class Tag:
    """A tag that was read.

    corners: float32 (4, 2), x and y of the outer corners of its black square, source pixels: upper left, upper right,
    lower right and lower left of the tag as it is printed. margin: half of the difference between its white and its
    black cells, grey levels, 0 to 127. agreement: share of its cells that are as they should be, 0 to 1.
    """

    id: int
    corners: Float
    margin: float
    agreement: float

    @property
    def centre(self) -> tuple[float, float]:
        """Mean of the corners, source pixels."""
        return float(self.corners[:, 0].mean()), float(self.corners[:, 1].mean())

    @property
    def side(self) -> float:
        """Root of the area, pixels."""
        return float(np.sqrt(cv2.contourArea(self.corners)))


def dictionary(family: str) -> cv2.aruco.Dictionary:
    """The codes of a family. ValueError: none of DICTIONARIES."""
    if family not in DICTIONARIES:
        raise ValueError(
            f"'{family}' is no family of tags that is read; use one of {', '.join(DICTIONARIES)}"
        )
    return cv2.aruco.getPredefinedDictionary(DICTIONARIES[family])


@cache
def cells_of(family: str, number: int) -> NDArray[np.bool_]:
    """The cells of a tag with its black ring, bool (n, n), true where white. ValueError: no such tag."""
    codes = dictionary(family)
    if not 0 <= number < len(codes.bytesList):
        raise ValueError(f"tag {number}: {family} has the ids 0 to {len(codes.bytesList) - 1}")
    side = codes.markerSize + 2
    return np.asarray(cv2.aruco.generateImageMarker(codes, number, side, None, 1) > 127, np.bool_)


def examine(grey: NDArray[np.uint8], corners: Float, cells: NDArray[np.bool_]) -> tuple[float, float]:
    """Margin and agreement of a tag, see `Tag`, from its own cells in the grey picture (h, w).

    The middle between the mean of what should be white and the mean of what should be black divides the two, after
    blur was taken back.
    """
    (values,) = outlines = cell_values(grey, corners[None], len(cells), PLACES)
    inner, (clear,) = values[1:-1, 1:-1], sharpened(outlines)
    margin = 0.5 * float(inner[cells].mean() - inner[~cells].mean())
    middle = 0.5 * float(clear[cells].mean() + clear[~cells].mean())
    return margin, float(((clear > middle) == cells).mean())


def checked(
    grey: NDArray[np.uint8], family: str, number: int, corners: Float, settings: TagSettings
) -> Tag | None:
    """The tag with this id and these corners, None where its cells do not bear it out."""
    corners = np.ascontiguousarray(corners, np.float32).reshape(4, 2)
    margin, agreement = examine(grey, corners, cells_of(family, number))
    if margin < settings.least_margin or agreement < settings.least_agreement:
        return None
    return Tag(number, corners, round(margin, 1), round(agreement, 3))
