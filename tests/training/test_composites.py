"""Cut-outs and composed pictures on drawn hands: boxes tell the truth, seeds repeat."""

import cv2
import numpy as np
import pytest

from lightgesture.training.pictures.composites import Background, Composer
from lightgesture.training.pictures.cutouts import cut_out, draw_hand
from lightgesture.training.pictures.light import attenuate


def _landmarks():
    """A flat hand of 21 landmarks, wrist at the bottom, fingers up."""
    points = [(56, 95)]
    for x, length in ((36, 30), (44, 55), (54, 60), (64, 55), (73, 45)):
        points += [(x, 75 - length * step / 4) for step in (0.5, 2, 3, 4)]
    return np.array(points, np.float32)


@pytest.fixture(name="cutout")
def _cutout():
    image = np.full((112, 112, 3), (150, 120, 40), np.uint8)
    image[draw_hand(image.shape, _landmarks(), 0.3) > 0] = (110, 140, 200)
    noise = np.random.default_rng(0).normal(0, 3, image.shape)
    found = cut_out(np.clip(image + noise, 0, 255).astype(np.uint8), _landmarks(), "left", "drawn")
    assert found is not None
    return found


def _backgrounds(count, value, source):
    rng = np.random.default_rng(value)
    return [Background(rng.integers(0, value, (240, 320, 3), np.uint8), source) for _ in range(count)]


def test_a_cutout_holds_the_hand_and_nothing_else(cutout):
    truth = draw_hand((112, 112), _landmarks(), 0.3) > 0
    kept = cutout.alpha > 0.5
    assert (kept & truth).sum() / (kept | truth).sum() > 0.85


def test_mirroring_swaps_left_and_right_and_keeps_the_box_on_the_hand(cutout):
    mirrored = cutout.mirrored()
    assert mirrored.token == "right"
    assert cv2.boundingRect((mirrored.alpha > 0.5).astype(np.uint8))[0] == pytest.approx(
        mirrored.box[0], abs=2
    )
    twice = mirrored.mirrored()
    assert (twice.token, twice.box) == ("left", cutout.box)
    np.testing.assert_array_equal(twice.image, cutout.image)


def test_the_same_seed_composes_the_same_pixels(cutout):
    composer = Composer([cutout], _backgrounds(2, 90, "sea"), _backgrounds(2, 200, "room"))
    first, second = (composer.compose(np.random.default_rng(4)) for _ in range(2))
    np.testing.assert_array_equal(first.image, second.image)
    assert first.boxes == second.boxes


def test_composed_pictures_box_their_hands(cutout):
    composer = Composer([cutout], [], _backgrounds(2, 60, "room"))
    rng = np.random.default_rng(9)
    composites = [composer.compose(rng) for _ in range(16)]
    for composite in composites:
        assert composite.image.shape == (240, 320, 3)
        for (x, y, width, height), token in zip(composite.boxes, composite.tokens, strict=True):
            assert 0 <= x < x + width <= 320
            assert 0 <= y < y + height <= 240
            assert token in ("left", "right")
    counts = [len(composite.boxes) for composite in composites]
    assert set(counts) == {0, 1, 2}
    assert np.mean(counts) > 1.1


def test_water_takes_red_most():
    grey = np.full((8, 8, 3), 0.6, np.float32)
    results = [attenuate(grey, np.random.default_rng(seed))[0, 0] for seed in range(20)]
    assert np.mean([result[2] for result in results]) < np.mean([result[1] for result in results])
