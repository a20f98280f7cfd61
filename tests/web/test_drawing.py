"""The hands on the pictures of the page."""

import numpy as np
import pytest

from lightgesture.records import FrameRecord, Hand
from lightgesture.web.drawing import HandDrawer


def frame(box, token="ok"):
    reason = None if token else "low_confidence"
    hand = Hand(side="left", token=token, confidence=0.5, box=box, track=1, reason=reason)
    return FrameRecord(source="a", frame=0, time_s=0.0, hands=(hand,))


@pytest.mark.parametrize(
    "box", [(40, 60, 50, 50), (0, 0, 30, 30), (150, 0, 9, 9), (100, 90, 90, 90), (-20, -20, 15, 15)]
)
@pytest.mark.parametrize("size", [(160, 120), (20, 12), (1, 1)])
def test_a_hand_anywhere_is_drawn_on_a_copy(box, size):
    image = np.full((size[1], size[0], 3), 10, np.uint8)
    drawn = HandDrawer()(image, [frame(box)])
    assert drawn.shape == image.shape
    assert (image == 10).all()
    assert (drawn != 10).any() or min(size) < 100


def test_the_label_stands_above_the_box_and_inside_it_at_the_top():
    image = np.full((120, 160, 3), 10, np.uint8)
    assert (HandDrawer()(image, [frame((40, 60, 50, 50))])[50:57, 42:70] != 10).any(axis=2).mean() > 0.9
    assert (HandDrawer()(image, [frame((40, 4, 50, 80))])[7:14, 44:70] != 10).any(axis=2).mean() > 0.9


def test_hands_stay_until_the_next_frame_record():
    draw, image = HandDrawer(), np.full((120, 160, 3), 10, np.uint8)
    first = draw(image, [frame((40, 60, 50, 50))])
    np.testing.assert_array_equal(draw(image, []), first)
    none = FrameRecord(source="a", frame=1, time_s=0.1, hands=())
    np.testing.assert_array_equal(draw(image, [frame((1, 1, 9, 9)), none]), image)


def test_a_hand_that_is_not_read_has_another_colour():
    image = np.full((120, 160, 3), 10, np.uint8)
    box = (40, 60, 50, 50)
    read, unread = (HandDrawer()(image, [frame(box, token)]) for token in ("ok", None))
    assert (read[60, 60] != unread[60, 60]).any()
