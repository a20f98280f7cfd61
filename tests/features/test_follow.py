"""Looking at the hands alone: the same boxes as a search gives, on frames of any size, colour and width."""

import cv2
import numpy as np
import pytest

from lightgesture.actions.decode import SAMPLE
from lightgesture.features.colour import ColourStage
from lightgesture.features.find.locator import detailed
from lightgesture.features.find.refiner import Refiner
from lightgesture.features.find.selector import load_selector
from lightgesture.features.find.selector_file import load_learned
from lightgesture.features.geometry import box_iou
from lightgesture.features.types import Candidates
from lightgesture.sources import open_source


@pytest.fixture(name="picture", scope="module")
def _picture():
    with open_source(SAMPLE) as source:
        return next(frame.image for frame in source if frame.index == 60)


@pytest.fixture(name="finder", scope="module")
def _finder():
    return load_selector()


@pytest.mark.parametrize("size", [(320, 240), (640, 480), (1280, 720), (1920, 1080)])
def test_a_look_at_what_a_search_found_finds_it_again(finder, picture, size):
    frame = np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), np.uint8)
    searched = finder.process(ColourStage().process(frame)).regions[:2]
    followed = finder.follow(frame, [region.box for region in searched])
    assert followed.source_size == size
    assert len(followed.regions) == 2
    for region in searched:
        assert max(box_iou(region.box, other.box) for other in followed.regions) > 0.75
    assert followed.pairs[0, 1] == followed.pairs[1, 0] == pytest.approx(followed.regions[1].confidence)


def test_the_quick_look_sees_what_the_slow_one_does(picture):
    """The reference looks through the working picture, with tables made of its histogram."""
    refiner, colour = Refiner(load_learned().refiner), ColourStage().process(picture)
    box = load_selector().process(colour).regions[0].box
    ((x, y, width, height),), (hand,) = refiner.look(picture, [box])
    working = np.array([box], np.float32) / np.tile(np.array(colour.scale, np.float32), 2)
    slow = refiner.process(colour, working, refiner.table(colour.picture))
    expected = slow.boxes[0] * np.tile(colour.scale, 2)
    assert (x, y, width, height) == pytest.approx(expected, abs=0.12 * box[2])
    assert hand == pytest.approx(slow.hand[0], abs=1.5)


def test_two_looks_at_one_hand_are_one_hand_and_nothing_is_none(finder, picture):
    hand = finder.process(ColourStage().process(picture)).regions[0].box
    beside = hand[0] + 2, hand[1] + 2, hand[2], hand[3]
    assert len(finder.follow(picture, [hand, beside]).regions) == 1
    empty = finder.follow(np.full((480, 640, 3), 90, np.uint8), [(10, 10, 60, 60)])
    assert isinstance(empty, Candidates)
    assert all(region.confidence < 0.3 for region in empty.regions)


@pytest.mark.parametrize("box", [(-50, -40, 60, 60), (630, 470, 40, 40), (0, 0, 1, 1), (0, 0, 640, 480)])
def test_boxes_at_the_edge_and_of_any_size_are_looked_at(finder, picture, box):
    for region in finder.follow(picture, [box]).regions:
        x, y, width, height = region.box
        assert x >= 0
        assert y >= 0
        assert x + width <= picture.shape[1]
        assert y + height <= picture.shape[0]


@pytest.mark.parametrize("size", [(1, 1), (80, 60), (160, 120), (240, 180), (640, 480), (1920, 1080)])
def test_the_locator_sees_twice_the_working_picture_whatever_the_frame(size):
    width, height = size
    colour = ColourStage().process(np.full((height, width, 3), 90, np.uint8))
    rows, columns = colour.picture.shape[:2]
    assert detailed(colour).shape == (2 * rows, 2 * columns, 3)
    if width >= 640:
        assert detailed(colour) is colour.detail


def test_a_small_picture_shows_the_same_hands(finder, picture):
    large, small = (
        finder.process(
            ColourStage().process(np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA)))
        )
        for size in ((640, 480), (160, 120))
    )
    for one in large.regions[:2]:
        x, y, width, height = (value / 4 for value in one.box)
        assert max(box_iou((x, y, width, height), other.box) for other in small.regions) > 0.6
