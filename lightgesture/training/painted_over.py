"""Pictures of places from pictures of people: what of them is a hand is painted over."""

from collections.abc import Sequence

import cv2
import numpy as np

from lightgesture.features.types import Box, Image

INPAINT_RADIUS = 5
"""Pixels round a painted one whose colours it takes on."""


def without_hands(image: Image, hands: Sequence[Box]) -> Image:
    """The picture, each labelled hand and a little more painted over from what stands around it (Telea, "An image
    inpainting technique based on the fast marching method", 2004)."""
    if not hands:
        return image
    mask = np.zeros(image.shape[:2], np.uint8)
    for x, y, width, height in hands:
        margin_x, margin_y = width // 6, height // 5
        corner, far = (x - margin_x, y - margin_y), (x + width + margin_x, y + height + margin_y)
        cv2.rectangle(mask, corner, far, 255, cv2.FILLED)
    return np.asarray(cv2.inpaint(image, mask, INPAINT_RADIUS, cv2.INPAINT_TELEA), np.uint8)
