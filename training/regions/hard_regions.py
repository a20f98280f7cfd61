"""What a locator takes for hands in its own training pictures: the refiner's hardest examples."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.colour import ColourStage
from lightgesture.features.find.locator import Locator, find_peaks
from lightgesture.features.geometry import pairwise_iou
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.features.standardise import channel_tables
from lightgesture.training.regions.trees import BoxedPicture

Float = NDArray[np.float32]

MOST_PEAKS, LEAST_HEAT = 12, 0.03
"""More and weaker peaks than are looked at on the board."""
FALSE_IOU = 0.3
"""A peak whose box overlaps every hand less is false."""
MOST = 8
"""False peaks kept of one picture."""


def hard_regions(
    pictures: Iterable[BoxedPicture], locator: IntegerNetwork
) -> list[tuple[BoxedPicture, Float]]:
    """Each picture with the boxes of its false peaks, (n, 4), pixels of the picture, hottest first."""
    net, stage, found = Locator(locator), ColourStage(), []
    for picture in pictures:
        colour = stage.process(picture.image)
        maps = net.process(colour.picture, channel_tables(colour.picture))
        boxes = find_peaks(maps, MOST_PEAKS, LEAST_HEAT).boxes * np.tile(
            np.array(colour.scale, np.float32), 2
        )
        if picture.boxes and len(boxes):
            overlap = pairwise_iou(boxes, np.array(picture.boxes, np.float64)).max(axis=1)
            boxes = boxes[overlap < FALSE_IOU]
        found.append((picture, np.asarray(boxes[:MOST], np.float32)))
    return found
