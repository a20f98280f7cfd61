"""The paper's own region selection, kept as a row of every table to measure progress against.

Islam, Ho and Sattar, "Dynamic Reconfiguration of Mission Parameters in Underwater Human-Robot Collaboration"
(ICRA 2018) select the two hands in four steps: blur and one fixed skin threshold in HSV, contours of the
regions, rejection of outliers by the scale and location of the hands in the previous frame, and the choice
of the contours nearest to a bank of hand contours by Hu moments. The paper does not print its
constants. Used here:

- skin: hue 0 to 50 degrees, saturation 0.23 to 0.68, any value (Sobottka and Pitas, Signal Processing:
  Image Communication 12, 1998), in OpenCV's units;
- blur 5 x 5 and a 5 x 5 elliptic opening and closing: the usual clean-up of such a mask;
- Hu distance: `cv2.CONTOURS_MATCH_I1`, OpenCV's first measure;
- least area and gates: chosen generously, so that no labelled hand is lost to them.

None of them was tuned on the pictures that are scored.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.paper.bank import Contour, HandBank
from lightgesture.features.types import Box

SIDES_BY_PLACE = ("right", "left")
"""The diver's side of the image-left and of the image-right hand."""


BLUR: Final = 5
"""Side of the Gaussian kernel, odd pixels."""

SKIN_LOW, SKIN_HIGH = np.array((0, 59, 0)), np.array((25, 173, 255))
"""Skin in HSV, OpenCV's units (hue 0 to 179)."""

KERNEL: Final = 5
"""Side of the opening and closing, pixels."""

LEAST_AREA: Final = 0.001
"""Of a region, as a share of the frame."""

GATE_SIDES: Final = 1.0
"""Farthest move between frames, in sides (square root of the last box's area)."""

GATE_SCALE: Final = 2.0
"""Largest change of area between frames, as a factor."""

PATIENCE: Final = 5
"""Frames after which a hand that is not seen is forgotten and searched everywhere."""


@dataclass(frozen=True, slots=True, eq=False)
class PaperHand:
    """A chosen region: its box, the diver's side, the class of the nearest bank contour and its distance."""

    box: Box
    side: str
    token: str
    distance: float


@dataclass(frozen=True, slots=True)
class _Memory:
    box: Box
    missed: int


class PaperChain:
    """The chain over the frames of one source; a fresh object has no memory.

    `process` on a fresh object reads a single picture.
    """

    def __init__(self, bank: HandBank) -> None:
        self._bank = bank
        self._memory: dict[str, _Memory] = {}

    def process(self, image: NDArray[np.uint8]) -> list[PaperHand]:
        """Choose at most two hands of a BGR frame, at most one a side."""
        contours = skin_contours(image)
        chosen = self._follow(contours)
        if len(chosen) < 2:
            chosen = self._search(contours, chosen, image.shape[1])
        self._remember(chosen)
        return list(chosen.values())

    def _follow(self, contours: list[Contour]) -> dict[str, PaperHand]:
        """The nearest contour to the bank within the gate of each remembered hand."""
        chosen: dict[str, PaperHand] = {}
        for side, memory in self._memory.items():
            taken = {hand.box for hand in chosen.values()}
            hands = [
                self._read(contour, side)
                for contour in contours
                if bounding_box(contour) not in taken and within_gate(bounding_box(contour), memory.box)
            ]
            accepted = [hand for hand in hands if hand.distance <= self._bank.accepted_distance]
            if accepted:
                chosen[side] = min(accepted, key=lambda hand: hand.distance)
        return chosen

    def _search(
        self, contours: list[Contour], chosen: dict[str, PaperHand], width: int
    ) -> dict[str, PaperHand]:
        """Fill the sides without memory with the contours nearest to the bank."""
        taken = {hand.box for hand in chosen.values()}
        free = [side for side in SIDES_BY_PLACE if side not in chosen and side not in self._memory]
        ranked = sorted(
            (self._bank.nearest(contour)[1], index)
            for index, contour in enumerate(contours)
            if bounding_box(contour) not in taken
        )
        nearest = [contours[index] for distance, index in ranked if distance <= self._bank.accepted_distance]
        placed = sorted(nearest[: len(free)], key=middle)
        if len(placed) == 1 and len(free) == 2:
            free = ["right" if middle(placed[0]) < width / 2 else "left"]
        found = {side: self._read(contour, side) for side, contour in zip(free, placed, strict=False)}
        return {**chosen, **found}

    def _read(self, contour: Contour, side: str) -> PaperHand:
        token, distance = self._bank.nearest(contour, mirrored=side == "right")
        return PaperHand(bounding_box(contour), side, token, distance)

    def _remember(self, chosen: dict[str, PaperHand]) -> None:
        missed = {side: memory.missed + 1 for side, memory in self._memory.items() if side not in chosen}
        kept = {
            side: _Memory(self._memory[side].box, count) for side, count in missed.items() if count < PATIENCE
        }
        self._memory = {**kept, **{side: _Memory(hand.box, 0) for side, hand in chosen.items()}}


def skin_mask(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """One fixed threshold in HSV; uint8 (height, width), 255 on skin."""
    blurred = cv2.GaussianBlur(image, (BLUR, BLUR), 0)
    hsv = cv2.cvtColor(blurred, cv2.COLOR_BGR2HSV)
    mask = cv2.inRange(hsv, SKIN_LOW, SKIN_HIGH)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (KERNEL, KERNEL))
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, kernel)
    return np.asarray(cv2.morphologyEx(opened, cv2.MORPH_CLOSE, kernel), dtype=np.uint8)


def skin_contours(image: NDArray[np.uint8]) -> list[Contour]:
    """Outer contours, int32 (n, 2), of the skin regions that are large enough."""
    contours, _ = cv2.findContours(skin_mask(image), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    least = LEAST_AREA * image.shape[0] * image.shape[1]
    large = [contour for contour in contours if cv2.contourArea(contour) >= least]
    return [np.asarray(contour, dtype=np.int32).reshape(-1, 2) for contour in large]


def bounding_box(contour: Contour) -> Box:
    """Upright bounding box of a contour."""
    x, y, width, height = cv2.boundingRect(contour)
    return int(x), int(y), int(width), int(height)


def middle(contour: Contour) -> float:
    """Horizontal middle of a contour's bounding box, pixels."""
    x, _, width, _ = bounding_box(contour)
    return x + width / 2


def within_gate(box: Box, last: Box) -> bool:
    """Whether a box is near enough to the last one in place and size."""
    area, last_area = box[2] * box[3], last[2] * last[3]
    move_x = box[0] + box[2] / 2 - last[0] - last[2] / 2
    move_y = box[1] + box[3] / 2 - last[1] - last[3] / 2
    is_near = move_x**2 + move_y**2 <= GATE_SIDES**2 * last_area
    return is_near and last_area / GATE_SCALE <= area <= last_area * GATE_SCALE
