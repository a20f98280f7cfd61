"""The camera's picture as a mirror shows it, with the words the right way round."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import cv2

from lightgesture.features.types import Image
from lightgesture.records import FrameRecord, Hand, Record
from lightgesture.results.overlay import Overlay


def mirror_drawing() -> Callable[[Image, Sequence[Record]], Image]:
    """Draws as `Overlay` does, on the mirrored picture: the person's left hand is on the left."""
    overlay = Overlay()

    def draw(image: Image, records: Sequence[Record]) -> Image:
        flipped: Image = cv2.flip(image, 1)  # type: ignore[assignment]
        return overlay.draw(flipped, mirrored(records, image.shape[1]))

    return draw


def mirrored(records: Iterable[Record], width: int) -> list[Record]:
    """The records with their boxes where they are in the mirrored picture; width: of the picture, pixels."""
    return [
        replace(record, hands=tuple(_mirrored(hand, width) for hand in record.hands))
        if isinstance(record, FrameRecord)
        else record
        for record in records
    ]


def _mirrored(hand: Hand, width: int) -> Hand:
    x, y, wide, tall = hand.box
    return replace(hand, box=(width - x - wide, y, wide, tall))
