"""Hidden hands: as much of the box is lost as is asked for, and nothing else changes."""

import numpy as np
import pytest

from lightgesture.training.pictures import hidden_hands
from lightgesture.training.pictures.hidden_hands import hide

BOX = (30, 20, 40, 60)


def picture():
    return np.random.default_rng(5).integers(90, 160, (100, 100, 3)).astype(np.uint8)


@pytest.fixture(name="hidden")
def _hidden(monkeypatch):
    """Hides half of the box, with other constants than the module's where they are named."""

    def hidden(seed, **constants):
        for name, value in {"LOST": (0.5, 0.5), **constants}.items():
            monkeypatch.setattr(hidden_hands, name, value)
        others = [np.full((50, 50, 3), 255, np.uint8)]
        return hide(picture(), BOX, others, np.random.default_rng(seed))

    return hidden


@pytest.mark.parametrize("seed", range(12))
def test_the_edge_of_a_cut_picture_runs_through_the_hand(hidden, seed):
    image, (x, y, width, height) = hidden(seed, CUT_SHARE=1.0)
    rows, columns = image.shape[:2]
    assert x >= 0
    assert y >= 0
    assert x + width <= columns
    assert y + height <= rows
    assert (width, height) in {(20, 60), (40, 30)}
    assert x == 0 or y == 0 or x + width == columns or y + height == rows


@pytest.mark.parametrize("skin", [0.0, 1.0])
@pytest.mark.parametrize("seed", range(6))
def test_a_cover_hides_about_the_share_of_the_box_that_is_asked_for(hidden, seed, skin):
    image, box = hidden(seed, CUT_SHARE=0.0, SKIN_SHARE=skin, COVER_RADIUS=(3.0, 3.0))
    assert box == BOX
    x, y, width, height = box
    changed = (image != picture()).any(axis=2)
    assert 0.25 < changed[y : y + height, x : x + width].mean() < 0.75
    # The disc comes in from one side: some of the picture is as it was.
    assert not changed.all()


def test_hands_smaller_than_a_cell_are_hidden_without_an_error():
    for seed in range(20):
        image, box = hide(picture()[:6, :6], (1, 1, 2, 3), [picture()], np.random.default_rng(seed))
        assert min(image.shape[:2]) >= 2
        assert min(box[2:]) >= 2
