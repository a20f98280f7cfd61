"""What a classifier learns from: the ten tokens, and one labelled hand in a picture."""

from dataclasses import dataclass
from typing import Final

from lightgesture.features.types import Box, Image

NONE: Final = "none"
"""Class of everything that is no token: other shapes of a hand, faces, arms, background."""

CLASSES: Final = ("0", "1", "2", "3", "4", "5", "left", "right", "pic", "ok", NONE)
"""The ten tokens, then `none`. `left` and `right` say where the thumb points in a left hand's patch."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TrainingSample:
    """One hand, or one region that is none.

    image: uint8 (height, width, 3), BGR. box: outline, pixels of `image`. side: the diver's own, "left" or "right".
    token: class name. source: the person, room and camera; a held-out fold holds whole sources.
    original: False for an altered copy; only originals count in scores. weight: how much it counts in training
    beside others of its class and source, 0 or more.
    """

    image: Image
    box: Box
    side: str
    token: str
    source: str
    original: bool = True
    weight: float = 1.0
