"""What a classifier learns from: one labelled hand in a picture, and the order of its classes."""

from collections.abc import Iterable
from dataclasses import dataclass

from lightgesture.features.types import Box, Float, Image
from lightgesture.models import CLASSES, NONE


def in_order(names: Iterable[str]) -> tuple[str, ...]:
    """Each of the names once: those of `CLASSES` as they stand there, then the others by name, `none` last."""
    found = set(names)
    own = sorted(found.difference(CLASSES))
    known = [name for name in CLASSES if name in found and name != NONE]
    return (*known, *own, *({NONE} & found))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrainingSample:
    """One hand, or one region that is none.

    image: uint8 (height, width, 3), BGR. box: outline, pixels of `image`. side: the diver's own, "left" or "right".
    token: class name. source: the person, room and camera; a held-out fold holds whole sources.
    hand: number of the hand that this is or is a copy of, -1 where it is of none; with few sources a held-out fold
    holds whole hands. original: False for an altered copy; only originals count in scores. weight: how much it counts
    in training beside others of its class and source, 0 or more.
    landmarks: float32 (21, 2), x and y in pixels of `image`, the middle of its first pixel being (0, 0); wrist, then
    thumb to little finger, each from its base to its tip. None where unknown.
    """

    image: Image
    box: Box
    side: str
    token: str
    source: str
    hand: int = -1
    original: bool = True
    weight: float = 1.0
    landmarks: Float | None = None
