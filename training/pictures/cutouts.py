"""Cut real hands out of their pictures along their landmarks.

Cut-outs serve training and benchmarks on the user's own machine; no picture of a person is shipped.
"""

from dataclasses import dataclass
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.types import Box, Image

FINGERS = ((0, 1, 2, 3, 4), (5, 6, 7, 8), (9, 10, 11, 12), (13, 14, 15, 16), (17, 18, 19, 20))
"""Landmark numbers along each finger, thumb first; 0 is the wrist, which leads into the thumb."""

PALM = (0, 1, 5, 9, 13, 17)
"""Landmarks round the palm."""


# Thickness of the drawn fingers over the palm's length (wrist to middle knuckle).
SURE_WIDTH: Final = 0.12
"""Of the core that is hand beyond doubt."""
FINGER_WIDTH: Final = 0.28
"""Of what is most likely hand."""
LIMIT_WIDTH: Final = 0.46
"""Of the zone beyond which nothing is hand."""
ITERATIONS: Final = 3
"""Of GrabCut."""
FEATHER: Final = 3
"""Pixels of soft edge."""


@dataclass(frozen=True, slots=True, eq=False)
class Cutout:
    """A hand without what stands around it.

    image: uint8 (h, w, 3), BGR. alpha: float32 (h, w), 0 to 1. box: outline of the hand in `image`.
    wrist: (x, y) of the wrist in `image`. token, source: as in the manifest.
    """

    image: Image
    alpha: NDArray[np.float32]
    box: Box
    wrist: tuple[float, float]
    token: str
    source: str

    def mirrored(self) -> "Cutout":
        """The other hand: flipped, with left and right exchanged."""
        width = self.image.shape[1]
        x, y, w, h = self.box
        token = {"left": "right", "right": "left"}.get(self.token, self.token)
        return Cutout(
            np.ascontiguousarray(self.image[:, ::-1]),
            np.ascontiguousarray(self.alpha[:, ::-1]),
            (width - x - w, y, w, h),
            (width - 1 - self.wrist[0], self.wrist[1]),
            token,
            self.source,
        )


def draw_hand(shape: tuple[int, ...], landmarks: NDArray[np.float32], width: float) -> Image:
    """The hand as thick strokes along its landmarks and a filled palm: uint8 (h, w), 0 or 255.

    landmarks: (21, 2) pixels. width: stroke over the distance from wrist to middle knuckle.
    """
    palm_length = float(np.linalg.norm(landmarks[0] - landmarks[9]))
    palm_width = float(np.linalg.norm(landmarks[5] - landmarks[17]))
    thickness = max(1, round(width * max(palm_length, palm_width)))
    mask = np.zeros(shape[:2], np.uint8)
    points = np.rint(landmarks).astype(np.int32)
    for finger in FINGERS:
        cv2.polylines(mask, [points[list(finger)].reshape(-1, 1, 2)], False, 255, thickness, cv2.LINE_8)
    cv2.fillPoly(mask, [points[list(PALM)].reshape(-1, 1, 2)], 255)
    cv2.polylines(mask, [points[list(PALM)].reshape(-1, 1, 2)], True, 255, thickness, cv2.LINE_8)
    return mask


def cut_out(image: Image, landmarks: NDArray[np.float32], token: str, source: str) -> Cutout | None:
    """The hand of a crop, or None where GrabCut (Rother, Kolmogorov and Blake, 2004) keeps too little.

    image: uint8 (h, w, 3) BGR. landmarks: float32 (21, 2) in its pixels.
    """
    limit = draw_hand(image.shape, landmarks, LIMIT_WIDTH)
    likely = draw_hand(image.shape, landmarks, FINGER_WIDTH)
    sure = draw_hand(image.shape, landmarks, SURE_WIDTH)
    labels = np.full(image.shape[:2], cv2.GC_BGD, np.uint8)
    labels[limit > 0] = cv2.GC_PR_BGD
    labels[likely > 0] = cv2.GC_PR_FGD
    labels[sure > 0] = cv2.GC_FGD
    if (labels == cv2.GC_BGD).sum() < 50 or (labels == cv2.GC_FGD).sum() < 50:
        return None
    background, foreground = np.zeros((1, 65)), np.zeros((1, 65))
    cv2.grabCut(image, labels, None, background, foreground, ITERATIONS, cv2.GC_INIT_WITH_MASK)  # type: ignore[call-overload]
    hand = np.where((labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD), 255, 0).astype(np.uint8)
    if hand.mean() < 0.5 * likely.mean():
        return None
    size = 2 * FEATHER - 1
    alpha = cv2.GaussianBlur(hand, (size, size), 0).astype(np.float32) / 255.0
    x, y, width, height = cv2.boundingRect(hand)
    wrist = (float(landmarks[0, 0]), float(landmarks[0, 1]))
    return Cutout(image, alpha, (x, y, width, height), wrist, token, source)
