"""Things that are drawn into places: the box lies on what was drawn, and nothing but chance decides."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.training.drawn_things import ThingSettings, drawn_things
from lightgesture.training.painted_over import without_hands

PLACE = np.full((120, 160, 3), 100, np.uint8)
OTHERS = [np.full((60, 50, 3), 220, np.uint8)]
KINDS = {
    "structures": {"structures": 1.0},
    "blobs": {"structures": 0.0, "blobs": 1.0},
    "corners": {"structures": 0.0, "blobs": 0.0},
}


def drawn(kind, seed, **changes):
    settings = replace(ThingSettings(), count=6, **KINDS[kind], **changes)
    return list(drawn_things(PLACE, OTHERS, settings, np.random.default_rng(seed)))


@pytest.mark.parametrize("kind", KINDS)
def test_a_box_lies_on_what_was_drawn(kind):
    pairs = [pair for seed in range(8) for pair in drawn(kind, seed)]
    assert len(pairs) > 30
    for image, (x, y, width, height) in pairs:
        assert image.shape == (96, 96, 3)
        assert image.dtype == np.uint8
        assert min(width, height) >= 2
        inside = image[max(y, 0) : y + height, max(x, 0) : x + width]
        assert (inside != 100).any()


@pytest.mark.parametrize("kind", ["blobs", "corners"])
def test_a_whole_box_goes_round_the_thing(kind):
    for image, (x, y, width, height) in drawn(kind, 1, whole=1.0):
        outside = np.abs(image.astype(int) - 100).max(axis=2) > 6
        outside[y : y + height, x : x + width] = False
        assert not outside.any()


def test_the_place_is_left_as_it_is_and_chance_alone_decides():
    first, again, other = (drawn("blobs", seed) for seed in (2, 2, 3))
    assert (PLACE == 100).all()
    for (image, box), (same, same_box) in zip(first, again, strict=True):
        np.testing.assert_array_equal(image, same)
        assert box == same_box
    assert any((one != two).any() for (one, _), (two, _) in zip(first, other, strict=False))


def test_hands_are_painted_over_and_a_place_without_stays_as_it_is():
    image = PLACE.copy()
    image[40:80, 60:90] = 255
    assert without_hands(image, [(60, 40, 30, 40)]).max() < 140
    assert without_hands(image, ()) is image
