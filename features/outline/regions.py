"""The outline of a hand whose box is known: the level of the skin map at which a region fills the box best."""

from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourMap
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.types import Box

LEVELS: Final = 16
"""Thresholds that are tried between the dimmest and the brightest of the box."""
MARGIN: Final = 0.1
"""Of the searched window round the box, a share of its sides."""
LEAST_IOU: Final = 0.5
"""With the box, below which the outline is that of an ellipse in the box, because skin does not stand out there."""


def outline_in(colour: ColourMap, box: Box) -> NDArray[np.int32]:
    """int32 (n, 2), source pixels: the outline of the region that agrees best with a box in source pixels."""
    scale = np.array(colour.scale)
    x, y = np.array(box[:2]) / scale
    width, height = np.array(box[2:]) / scale
    rows, columns = colour.skin.shape
    left, top = max(int(x - MARGIN * width), 0), max(int(y - MARGIN * height), 0)
    right = min(int(x + (1.0 + MARGIN) * width) + 2, columns)
    bottom = min(int(y + (1.0 + MARGIN) * height) + 2, rows)
    window = colour.skin[top:bottom, left:right]
    wanted = np.array([[x - left, y - top, width, height]])
    best, best_iou = None, LEAST_IOU
    for level in np.linspace(window.min(), window.max(), LEVELS + 1)[1:]:
        mask = cv2.threshold(window, float(level) - 1.0, 255, cv2.THRESH_BINARY)[1]
        for contour in cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]:
            iou = float(pairwise_iou(np.array([cv2.boundingRect(contour)]), wanted)[0, 0])
            if iou > best_iou:
                best, best_iou = contour.reshape(-1, 2), iou
    if best is None:
        return _ellipse(box)
    return np.asarray(np.rint((best + np.array([left, top]) + 0.5) * scale), np.int32)


def _ellipse(box: Box) -> NDArray[np.int32]:
    centre = round(box[0] + box[2] / 2), round(box[1] + box[3] / 2)
    axes = max(box[2] // 2, 1), max(box[3] // 2, 1)
    return np.asarray(cv2.ellipse2Poly(centre, axes, 0, 0, 360, 10), np.int32).reshape(-1, 2)
