"""Pictures of what each stage made of a frame, for `--debug-dir`."""

from collections.abc import Sequence
from typing import Protocol

import cv2
import numpy as np

from lightgesture.features.colour import ColourMap
from lightgesture.features.track.state import Track
from lightgesture.features.types import Candidates, Image
from lightgesture.records import Hand

_GREEN, _YELLOW, _RED, _WHITE = (60, 220, 60), (0, 220, 255), (60, 60, 255), (255, 255, 255)


class PictureSink(Protocol):
    """Takes the picture of a stage, uint8 (h, w, 3) BGR, for the frame with this index.

    is_selected: whether the pictures of the frame at hand will be kept; the others need not be drawn.
    """

    @property
    def is_selected(self) -> bool: ...

    def write(self, stage: str, index: int, image_bgr: Image) -> None: ...


def draw_label(image: Image, text: str, corner: tuple[int, int], colour: tuple[int, int, int]) -> None:
    """Write on the picture itself, dark edge under light letters, kept inside the picture."""
    place = corner[0], max(corner[1], 14)
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, (0, 0, 0), 3, cv2.LINE_AA)
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, colour, 1, cv2.LINE_AA)


def draw_colour(colour: ColourMap) -> Image:
    """The working picture beside its skin map."""
    skin = cv2.cvtColor(colour.skin, cv2.COLOR_GRAY2BGR)
    return np.asarray(np.hstack([colour.picture, skin]), np.uint8)


def draw_regions(image: Image, candidates: Candidates) -> Image:
    """The outlines of the candidates, or their boxes where none was drawn, with their scores, the best green."""
    picture = image.copy()
    for rank, region in enumerate(candidates.regions):
        colour = _GREEN if rank < 2 else _YELLOW
        if len(region.contour):
            cv2.polylines(picture, [region.contour.reshape(-1, 1, 2)], True, colour, 1, cv2.LINE_AA)
        else:
            x, y, width, height = region.box
            cv2.rectangle(picture, (x, y), (x + width, y + height), colour, 1)
        draw_label(picture, f"{region.confidence:.2f}", region.box[:2], colour)
    return picture


def draw_tracks(image: Image, tracks: Sequence[Track]) -> Image:
    """The boxes of the tracks, red where the box is a prediction."""
    picture = image.copy()
    for track in tracks:
        x, y, width, height = track.box
        colour = _RED if track.missed else _GREEN
        cv2.rectangle(picture, (x, y), (x + width, y + height), colour, 2)
        draw_label(picture, f"{track.number} {track.side}", (x, y - 4), colour)
    return picture


def with_text(image: Image, text: str) -> Image:
    """The picture with a line of text at the bottom."""
    picture = image.copy()
    draw_label(picture, text, (8, picture.shape[0] - 10), _WHITE)
    return picture


def draw_hands(image: Image, hands: Sequence[Hand]) -> Image:
    """Boxes with tokens, red where refused."""
    picture = image.copy()
    for hand in hands:
        x, y, width, height = hand.box
        colour = _GREEN if hand.token is not None else _RED
        cv2.rectangle(picture, (x, y), (x + width, y + height), colour, 2)
        label = hand.token if hand.token is not None else str(hand.reason)
        draw_label(picture, f"{hand.side}: {label} {hand.confidence:.2f}", (x, y - 4), colour)
    return picture
