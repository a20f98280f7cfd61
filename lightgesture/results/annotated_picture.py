"""The annotated copy of a single picture: its hands, and what the pair says."""

import struct
import zlib
from typing import Final

import cv2
import numpy as np

from lightgesture.drawing import DARK, GREY, WHITE, Pen
from lightgesture.features.geometry import turn_box
from lightgesture.features.image import as_bgr8, turned
from lightgesture.features.types import Image
from lightgesture.fsm import Grammar
from lightgesture.records import FrameRecord, Hand
from lightgesture.results.overlay import BESIDE_LETTERS, Place, draw_hand
from lightgesture.results.ownership import SOFTWARE

ROWS: Final = 2
"""Of the bar below or on the picture: the pair, and its word."""

_HEADER_END: Final = 33
"""Bytes of a PNG file's signature and header."""


def pair_of(hands: tuple[Hand, ...]) -> tuple[str, str] | None:
    """Tokens of the diver's left and right hand; None where one was not read or is not there."""
    tokens = {hand.side: hand.token for hand in hands}
    left, right = tokens.get("left"), tokens.get("right")
    return None if left is None or right is None else (left, right)


def meaning(pair: tuple[str, str], grammar: Grammar) -> str:
    """What a pair says: its word, or both where it has another one before a sentence than within it."""
    opens, within = grammar.idle_words.get(pair), grammar.sentence_words.get(pair)
    if opens is None or within is None or opens == within:
        return opens or within or "no word"
    return f"{opens} before a sentence, {within} within one"


def annotate_picture(
    image_bgr: Image, record: FrameRecord, grammar: Grammar, place: Place, rotate: int
) -> Image:
    """A copy of the picture, turned upright, with the hands and the pair's word drawn in.

    place: of the word. rotate: degrees by which the picture is turned clockwise, as of `Pipeline`.
    """
    original = as_bgr8(image_bgr)
    size = original.shape[1], original.shape[0]
    picture = np.array(turned(original, rotate), copy=True)
    pen = Pen(picture)
    for hand in record.hands:
        draw_hand(pen, hand, turn_box(hand.box, size, rotate))
    pair = pair_of(record.hands)
    lines = ("no pair", "") if pair is None else (",".join(pair), meaning(pair, grammar))
    if place == "over":
        top = pen.height - ROWS * pen.row
        pen.panel(0, top, pen.width, ROWS * pen.row)
        _write(pen, lines, top, 1)
        return picture
    is_below = place == "below"
    shape = (ROWS * pen.row, pen.width) if is_below else (pen.height, BESIDE_LETTERS * pen.letter)
    bar = Pen(np.full((*shape, 3), DARK, np.uint8), pen.letter)
    _write(bar, lines, 0, 1 if is_below else 4)
    return np.vstack([picture, bar.picture]) if is_below else np.hstack([picture, bar.picture])


def to_png(picture: Image) -> bytes:
    """The picture as a PNG file that is known for ours."""
    content = cv2.imencode(".png", picture)[1].tobytes()
    data = b"tEXt" + f"Software\0{SOFTWARE}".encode("ascii")
    chunk = struct.pack(">I", len(data) - 4) + data + struct.pack(">I", zlib.crc32(data))
    return content[:_HEADER_END] + chunk + content[_HEADER_END:]


def _write(pen: Pen, lines: tuple[str, str], top: int, most: int) -> None:
    for text, colour in zip(lines, (GREY, WHITE), strict=True):
        for line in pen.wrap(text, pen.width - 2 * pen.margin, most):
            pen.write(line, pen.margin, top, colour)
            top += pen.row
