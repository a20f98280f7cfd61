"""Pictures of what each stage made of a frame, for `--debug-dir`."""

from collections.abc import Sequence
from typing import Protocol

import cv2
import numpy as np

from lightgesture.drawing import AMBER, GREEN, RED, WHITE, Pen
from lightgesture.features.colour import ColourMap
from lightgesture.features.track.state import Track
from lightgesture.features.types import Candidates, Image
from lightgesture.records import Hand


class PictureSink(Protocol):
    """Takes the picture of a stage, uint8 (h, w, 3) BGR, for the frame with this index.

    is_selected: whether the pictures of the frame at hand will be kept; the others need not be drawn.
    """

    @property
    def is_selected(self) -> bool: ...

    def write(self, stage: str, index: int, image_bgr: Image) -> None: ...


def draw_colour(colour: ColourMap) -> Image:
    """The working picture beside its skin map."""
    skin = cv2.cvtColor(colour.skin, cv2.COLOR_GRAY2BGR)
    return np.asarray(np.hstack([colour.picture, skin]), np.uint8)


def draw_regions(image: Image, candidates: Candidates) -> Image:
    """The outlines of the candidates, or their boxes where none was drawn, with their scores, the best green."""
    pen = Pen(image.copy())
    for rank, region in enumerate(candidates.regions):
        colour = GREEN if rank < 2 else AMBER
        if len(region.contour):
            cv2.polylines(pen.picture, [region.contour.reshape(-1, 1, 2)], True, colour, 1, cv2.LINE_AA)
        else:
            pen.frame(region.box, colour)
        pen.label(f"{region.confidence:.2f}", region.box, colour)
    return pen.picture


def draw_tracks(image: Image, tracks: Sequence[Track]) -> Image:
    """The boxes of the tracks, red where the box is a prediction."""
    pen = Pen(image.copy())
    for track in tracks:
        colour = RED if track.missed else GREEN
        pen.frame(track.box, colour)
        pen.label(f"{track.number} {track.side}", track.box, colour)
    return pen.picture


def with_text(image: Image, text: str) -> Image:
    """The picture with a line of text at the bottom."""
    pen = Pen(image.copy())
    top = pen.height - pen.row
    pen.panel(0, top, pen.width, pen.row)
    pen.write(pen.fit(text, pen.width - 2 * pen.margin, keep_end=True), pen.margin, top, WHITE)
    return pen.picture


def draw_hands(image: Image, hands: Sequence[Hand]) -> Image:
    """Boxes with tokens, red where refused."""
    pen = Pen(image.copy())
    for hand in hands:
        colour = GREEN if hand.token is not None else RED
        label = hand.token if hand.token is not None else (hand.reason or "").replace("_", " ")
        pen.frame(hand.box, colour)
        pen.label(f"{hand.side}: {label} {hand.confidence:.2f}", hand.box, colour)
    return pen.picture
