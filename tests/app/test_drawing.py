"""Labels on pictures: inside the picture, none over another."""

import numpy as np
import pytest

from lightgesture.drawing import GREEN, Pen


def inked(before, after):
    return np.argwhere((before != after).any(axis=2))


def test_labels_of_boxes_at_one_place_do_not_cover_each_other():
    picture = np.full((240, 320, 3), 200, np.uint8)
    pen = Pen(picture)
    areas = []
    for number in range(5):
        before = picture.copy()
        pen.label(f"0.9{number}", (100, 100, 40, 40), GREEN)
        places = inked(before, picture)
        if len(places):
            areas.append((places.min(axis=0), places.max(axis=0)))
    assert len(areas) == 5
    for place, (low, high) in enumerate(areas):
        for other_low, other_high in areas[:place]:
            assert (high < other_low).any() or (other_high < low).any()


@pytest.mark.parametrize(
    "box", [(-50, -50, 20, 20), (310, 230, 40, 40), (0, 0, 320, 240), (150, -300, 10, 10)]
)
def test_a_label_stays_in_the_picture(box):
    picture = np.full((240, 320, 3), 200, np.uint8)
    Pen(picture).label("right: no sign of the language 0.98", box, GREEN)
    assert len(inked(np.full_like(picture, 200), picture)) > 500


def test_long_texts_are_broken_between_words():
    pen = Pen(np.zeros((100, 400, 3), np.uint8))
    lines = pen.wrap("a sign after STOP HOVER was not read; sign the sentence again", 80, 3)
    assert len(lines) == 3
    assert all(pen.measure(line) <= 80 for line in lines)
    assert lines[-1].endswith("...")
    assert pen.wrap("", 150, 3) == []
