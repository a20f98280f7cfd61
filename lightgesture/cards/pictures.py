"""Pictures of the cards of a frame, for `--debug-dir`."""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.drawing import Pen
from lightgesture.features.motion.shapes import Curve
from lightgesture.features.types import Image
from lightgesture.records import CardSign

_LINES = {"left": (255, 180, 60), "right": (60, 140, 255)}
"""Hand -> colour of what it drew."""

_GREEN, _AMBER = (60, 220, 60), (0, 190, 255)


def draw_cards(image: Image, cards: Sequence[CardSign]) -> Image:
    """Tags with their ids and words, a dot at the corner that is printed at the upper left; amber without a word."""
    picture = image.copy()
    pen = Pen(picture)
    for card in cards:
        colour = _GREEN if card.word is not None else _AMBER
        outline = np.rint(np.array(card.corners)).astype(np.int32)
        cv2.polylines(picture, [outline.reshape(-1, 1, 2)], True, colour, 2, cv2.LINE_AA)
        cv2.circle(picture, outline[0].tolist(), 4, colour, -1, cv2.LINE_AA)
        left, top, wide, tall = cv2.boundingRect(outline)
        pen.label(f"{card.id}: {card.word or 'no word'} {card.margin:.0f}", (left, top, wide, tall), colour)
    return picture


def draw_way(image: Image, left: Curve | None, right: Curve | None) -> Image:
    """What each hand drew, as the camera sees it, over the dimmed picture; nothing of a hand that was still."""
    picture = np.asarray(image // 3, np.uint8)
    height, width = picture.shape[:2]
    pen = Pen(picture)
    scale = min(height, width) / 8
    for side, curve, column in (("left", left, 0.75), ("right", right, 0.25)):
        text = f"{side} hand{': still' if curve is None else ''}"
        pen.write(text, int(width * column) - 60, 0, _LINES[side])
        if curve is not None:
            # With the diver's eyes x runs to the other side than in the picture, y up.
            points = np.array([width * column, height / 2]) - curve * scale
            line = np.rint(points).astype(np.int32).reshape(-1, 1, 2)
            cv2.polylines(picture, [line], False, _LINES[side], 2, cv2.LINE_AA)
            cv2.circle(picture, line[0, 0].tolist(), 5, _LINES[side], -1, cv2.LINE_AA)
    return picture
