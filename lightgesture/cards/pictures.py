"""Pictures of the cards of a frame, for `--debug-dir`."""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.features.types import Image
from lightgesture.hands.pictures import draw_label
from lightgesture.records import CardSign

_GREEN, _AMBER = (60, 220, 60), (0, 190, 255)


def draw_cards(image: Image, cards: Sequence[CardSign]) -> Image:
    """Tags with their ids and words, a dot at the corner that is printed at the upper left; amber without a word."""
    picture = image.copy()
    for card in cards:
        colour = _GREEN if card.word is not None else _AMBER
        outline = np.rint(np.array(card.corners)).astype(np.int32)
        cv2.polylines(picture, [outline.reshape(-1, 1, 2)], True, colour, 2, cv2.LINE_AA)
        cv2.circle(picture, outline[0].tolist(), 4, colour, -1, cv2.LINE_AA)
        x, y = outline.min(axis=0)
        draw_label(
            picture, f"{card.id}: {card.word or 'no word'} {card.margin:.0f}", (int(x), int(y) - 4), colour
        )
    return picture
