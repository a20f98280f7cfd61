"""Letters, panels and labels on pictures, readable on any ground and at any size."""

from functools import lru_cache
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image

Colour = tuple[int, int, int]
"""BGR."""

GREEN, AMBER, RED = (80, 200, 60), (0, 190, 255), (120, 120, 255)
WHITE, GREY, DARK = (255, 255, 255), (190, 190, 190), (28, 24, 20)

LETTER_SHARE: Final = 0.032
"""Height of a capital letter as a share of the picture's shorter side; larger hides more."""

LEAST_LETTER: Final = 9
"""Smallest height of a capital letter, pixels; below 8 it cannot be read."""

PANEL_OPACITY: Final = 0.7
"""How much of the picture the panels hide, 0 (nothing) to 1."""

_FONT = cv2.FONT_HERSHEY_SIMPLEX
_MORE = "..."


def letter_for(image: Image) -> int:
    """Height of a capital letter that suits a picture, pixels."""
    return max(LEAST_LETTER, round(int(min(image.shape[:2])) * LETTER_SHARE))


class Pen:
    """Draws texts and panels at one size of letters on one picture.

    picture: uint8 (height, width, 3), BGR, drawn on in place. letter: height of a capital, pixels; None for what suits
    the picture. A row is as high as a line of text with its margins.
    """

    def __init__(self, picture: Image, letter: int | None = None) -> None:
        self.picture = picture
        self.height, self.width = picture.shape[:2]
        self.letter = letter_for(picture) if letter is None else letter
        self.margin = max(2, self.letter // 2)
        self.row = self.letter + 2 * self.margin
        self._stroke = max(1, round(self.letter / 9))
        unit = cv2.getTextSize("X", _FONT, 1.0, 1)[0][1]
        self._scale = self.letter / unit
        self._labels: list[Box] = []

    def measure(self, text: str) -> int:
        """Width of a text, pixels."""
        return int(cv2.getTextSize(text, _FONT, self._scale, self._stroke)[0][0])

    def fit(self, text: str, width: int, keep_end: bool = False) -> str:
        """As much of the text as `width` pixels hold, with dots where something is left out."""
        if self.measure(text) <= width:
            return text
        for count in range(len(text) - 1, 0, -1):
            short = _MORE + text[-count:] if keep_end else text[:count] + _MORE
            if self.measure(short) <= width:
                return short
        return ""

    def wrap(self, text: str, width: int, most: int) -> list[str]:
        """The text in at most so many lines of `width` pixels, broken between words; the last with dots if need be."""
        lines: list[str] = []
        words = text.split()
        while words and len(lines) < most - 1:
            count = len(words)
            while count > 1 and self.measure(" ".join(words[:count])) > width:
                count -= 1
            lines.append(self.fit(" ".join(words[:count]), width))
            del words[:count]
        return [*lines, self.fit(" ".join(words), width)] if words else lines

    def write(self, text: str, x: int, top: int, colour: Colour) -> None:
        """A text in the row that begins at `top`."""
        baseline = top + self.margin + self.letter
        cv2.putText(self.picture, text, (x, baseline), _FONT, self._scale, colour, self._stroke, cv2.LINE_AA)

    def panel(self, x: int, y: int, width: int, height: int, colour: Colour = DARK) -> None:
        """A rectangle through which the picture is dimly seen, cut at the picture's edges."""
        part = self.picture[max(y, 0) : max(y + height, 0), max(x, 0) : max(x + width, 0)]
        if part.size:
            # What a pixel becomes depends on its own value alone, and a plain picture to blend with is slow to make.
            part[...] = cv2.LUT(part, _dimmed(colour))

    def frame(self, box: Box, colour: Colour) -> None:
        """The outline of a box."""
        x, y, width, height = box
        thickness = max(1, round(self.letter / 6))
        cv2.rectangle(self.picture, (x, y), (x + width, y + height), colour, thickness)

    def label(self, text: str, box: Box, colour: Colour) -> None:
        """A text on a panel at a box: above it, or where that is no place or taken by another label below it, inside,
        or further up or down; never out of the picture. Where no place is free it is left out."""
        text = self.fit(text, self.width - 2 * self.margin)
        wide = self.measure(text) + 2 * self.margin
        x, y, _, height = box
        left = max(0, min(x, self.width - wide))
        tops = [y - self.row, y, y + height, y + height - self.row]
        tops += [y + step * self.row for turn in range(2, 6) for step in (-turn, turn - 1)]
        for top in tops:
            place = (left, top, wide, self.row)
            if 0 <= top <= max(0, self.height - self.row) and not any(
                _overlaps(place, other) for other in self._labels
            ):
                break
        else:
            if self._labels:
                return
            place = (left, max(0, min(y, self.height - self.row)), wide, self.row)
        self._labels.append(place)
        self.panel(*place)
        self.write(text, left + self.margin, place[1], colour)


@lru_cache(maxsize=16)
def _dimmed(colour: Colour) -> NDArray[np.uint8]:
    """uint8 (1, 256, 3): what a panel makes of each value of each channel."""
    values = np.repeat(np.arange(256, dtype=np.uint8)[None, :, None], 3, axis=2)
    plain = np.full_like(values, colour)
    return np.asarray(cv2.addWeighted(values, 1.0 - PANEL_OPACITY, plain, PANEL_OPACITY, 0.0), np.uint8)


def _overlaps(one: Box, other: Box) -> bool:
    return (
        one[0] < other[0] + other[2]
        and other[0] < one[0] + one[2]
        and one[1] < other[1] + other[3]
        and other[1] < one[1] + one[3]
    )
