"""A page as PNG, drawn by OpenCV, which is always there and brings its own letters."""

import unicodedata
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Image
from lightgesture.signs.drawings import SIDE, load_drawing
from lightgesture.signs.sheet import CAPITAL, Box, HandPicture, Page, Text, text_width

DOTS_PER_MM: Final = 8.0
"""Pixels a millimetre: 203 to the inch, an A5 page of 1184 by 1680."""

_SHIFT: Final = 4
"""Bits of a fraction of a pixel, which OpenCV takes for smooth edges."""

_FONT: Final = cv2.FONT_HERSHEY_DUPLEX


def to_png(page: Page) -> bytes:
    """The page as a PNG file."""
    picture = draw_page(page)
    return bytes(cv2.imencode(".png", picture, [cv2.IMWRITE_PNG_COMPRESSION, 6])[1])


def draw_page(page: Page, dots_per_mm: float = DOTS_PER_MM) -> Image:
    """The page as uint8 (height, width, 3), BGR."""
    size = (round(page.height * dots_per_mm), round(page.width * dots_per_mm), 3)
    picture = np.full(size, 255, np.uint8)
    for item in page.items:
        match item:
            case Box():
                _draw_box(picture, item, dots_per_mm)
            case Text():
                _draw_text(picture, item, dots_per_mm)
            case HandPicture():
                draw_hand(picture, item, dots_per_mm)
    return picture


def _bgr(colour: str) -> tuple[int, int, int]:
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)


def _fixed(points: NDArray[np.float64]) -> NDArray[np.int32]:
    """Points in pixels as whole numbers of 1 / 2 ** _SHIFT."""
    return np.asarray(np.round(points * (1 << _SHIFT)), np.int32)


def _corners(box: Box, dots_per_mm: float) -> NDArray[np.float64]:
    """The outline of a box, round corners included, (n, 2) pixels."""
    radius = min(box.radius, box.width / 2, box.height / 2)
    angles = np.radians(np.linspace(0.0, 90.0, 9 if radius else 1))
    arc = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    inner = np.array([box.width - 2 * radius, box.height - 2 * radius])
    middles = np.array([[1, 1], [0, 1], [0, 0], [1, 0]]) * inner + radius + np.array([box.x, box.y])
    turned = [arc, arc[:, ::-1] * [-1, 1], -arc, arc[:, ::-1] * [1, -1]]
    return np.vstack([middle + part for middle, part in zip(middles, turned, strict=True)]) * dots_per_mm


def _draw_box(picture: Image, box: Box, dots_per_mm: float) -> None:
    points = _fixed(_corners(box, dots_per_mm))
    if box.fill is not None:
        cv2.fillPoly(picture, [points], _bgr(box.fill), cv2.LINE_AA, _SHIFT)
    if box.stroke is not None:
        line = max(1, round(box.line * dots_per_mm))
        cv2.polylines(picture, [points], True, _bgr(box.stroke), line, cv2.LINE_AA, _SHIFT)


def _draw_text(picture: Image, text: Text, dots_per_mm: float) -> None:
    """A line of text, made narrower where OpenCV's letters are wider than others."""
    plain = unicodedata.normalize("NFKD", text.text).replace("·", "-").encode("ascii", "replace").decode()
    letter = text.size * CAPITAL * dots_per_mm
    stroke = max(1, round(letter * (0.14 if text.bold else 0.09)))
    scale = letter / cv2.getTextSize("X", _FONT, 1.0, 1)[0][1]
    wide = cv2.getTextSize(plain, _FONT, scale, stroke)[0][0]
    room = text_width(text.text, text.size, text.bold) * dots_per_mm
    if wide > room:
        scale *= room / wide
        wide = round(room)
    x = text.x * dots_per_mm - {"left": 0.0, "middle": wide / 2, "right": wide}[text.align]
    place = (round(x), round(text.y * dots_per_mm))
    cv2.putText(picture, plain, place, _FONT, scale, _bgr(text.colour), stroke, cv2.LINE_AA)


def draw_hand(picture: Image, hand: HandPicture, dots_per_mm: float) -> None:
    """Draw a hand on a picture in place; one without a drawing is left out."""
    drawing = load_drawing(hand.token, hand.side, hand.kind)
    if drawing is None:
        return
    scale = hand.size * dots_per_mm / SIDE
    shift = np.array([hand.x, hand.y]) * dots_per_mm
    for layer in drawing.layers:
        polygons = [_fixed(np.array(one, np.float64) * scale + shift) for one in layer.polygons]
        if polygons:
            cv2.fillPoly(picture, polygons, _bgr(layer.colour), cv2.LINE_AA, _SHIFT)
