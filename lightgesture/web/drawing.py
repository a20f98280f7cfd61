"""What is drawn on the pictures of the page: the hands' boxes with their tokens."""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.features.types import Image
from lightgesture.records import FrameRecord, Hand, Record

_READ, _UNREAD, _INK = (90, 220, 90), (90, 190, 255), (24, 20, 16)
_FONT = cv2.FONT_HERSHEY_SIMPLEX
LETTER_SHARE = 1 / 700
"""Scale of the letters for one pixel of the picture's height: about a 30th of it."""


class HandDrawer:
    """Draws the hands of the newest frame record; the sentence stands beside the picture, on the page itself."""

    def __init__(self) -> None:
        self._hands: tuple[Hand, ...] = ()

    def __call__(self, image: Image, records: Sequence[Record]) -> Image:
        """A new picture, uint8 (height, width, 3); records: since the one before, oldest first."""
        for record in records:
            if isinstance(record, FrameRecord):
                self._hands = record.hands
        picture = image.copy()
        for hand in self._hands:
            _draw_hand(picture, hand)
        return picture


def _draw_hand(picture: Image, hand: Hand) -> None:
    x, y, width, height = hand.box
    colour = _UNREAD if hand.token is None else _READ
    cv2.rectangle(picture, (x, y), (x + width, y + height), colour, 2)
    text = f"{hand.side}: {hand.token or '?'} {hand.confidence:.2f}"
    scale = max(picture.shape[0] * LETTER_SHARE, 0.4)
    (wide, tall), below = cv2.getTextSize(text, _FONT, scale, 1)
    # Above the box where there is room, and never outside the picture.
    left = int(np.clip(x, 0, max(picture.shape[1] - wide - 6, 0)))
    top, bottom = tall + 3, picture.shape[0] - below - 2
    base = y - below - 2 if y - below - 2 >= top else max(min(y + tall + 4, bottom), top)
    cv2.rectangle(picture, (left, base - tall - 3), (left + wide + 6, base + below), colour, cv2.FILLED)
    cv2.putText(picture, text, (left + 3, base), _FONT, scale, _INK, 1, cv2.LINE_AA)
