"""The classical trees fitted on a few drawn pictures: both looks, then pairs."""

import cv2
import numpy as np
import pytest

from lightgesture.features.colour import ColourStage
from lightgesture.features.find.classical import ClassicalSelector, Loops
from lightgesture.features.find.selector_file import load_classical
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.regions.trees import fit_pairs, fit_regions, glance

SKIN, WATER = (110, 140, 200), (150, 120, 40)


def _picture(seed):
    """Two hands on arms, and a red box without a partner."""
    rng = np.random.default_rng(seed)
    image = np.full((240, 320, 3), WATER, np.uint8)
    boxes = []
    for x in (80, 220):
        left, top = x + int(rng.integers(-15, 15)), int(rng.integers(60, 110))
        cv2.rectangle(image, (left + 8, top + 20), (left + 22, top + 80), SKIN, cv2.FILLED)
        cv2.ellipse(image, (left + 15, top + 20), (15, 20), 0, 0, 360, SKIN, cv2.FILLED)
        boxes.append((left, top, 31, 41))
    cv2.rectangle(image, (150, 10), (170, 30), (60, 60, 190), cv2.FILLED)
    noise = rng.normal(0, 3, image.shape)
    return BoxedPicture(np.clip(image + noise, 0, 255).astype(np.uint8), tuple(boxes))


@pytest.fixture(name="pictures", scope="module")
def _pictures():
    return [_picture(seed) for seed in range(24)]


def test_a_region_with_its_forearm_counts_as_the_hand_that_it_holds(pictures):
    one = next(iter(glance(pictures, Loops())))
    tall = one.regions.boxes[:, 3] > 30
    assert one.rows.shape[0] == len(one.regions)
    assert one.overlaps()[tall].max() > 0.6


@pytest.mark.slow
def test_fitted_trees_find_the_drawn_hands(pictures):
    bank = load_classical().bank
    first, second = fit_regions(lambda: pictures, bank, Loops(), 0)
    parts = fit_pairs(pictures, first, second, bank, Loops(), 0)
    stage = ClassicalSelector(parts)
    found = stage.process(ColourStage().process(_picture(99).image))
    assert found.regions[0].confidence > 0.3
    assert len(found.regions) == len(found.pairs)
