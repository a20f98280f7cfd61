"""Tags are read whichever way up, by both libraries alike, and a mirrored one never."""

import gc

import cv2
import numpy as np
import pytest

from lightgesture.features.tags.detector import ArucoTags, busyness, make_detector
from lightgesture.features.tags.settings import TagSettings
from lightgesture.features.tags.tag import DICTIONARIES, cells_of, dictionary, examine
from lightgesture.fsm import load_grammar
from lightgesture.fsm.language.cards import FAMILIES

NAMES = ("aruco", "apriltag")


def sheet(*numbers, side=64, family="36h11", columns=8):
    """Tags beside each other on white, uint8."""
    tags = []
    for number in numbers:
        tag = cv2.aruco.generateImageMarker(dictionary(family), number, side)
        tags.append(cv2.copyMakeBorder(tag, *[side // 4] * 4, cv2.BORDER_CONSTANT, value=255))
    tags += [np.full_like(tags[0], 255)] * (-len(tags) % columns)
    rows = [np.hstack(tags[first : first + columns]) for first in range(0, len(tags), columns)]
    return np.ascontiguousarray(np.vstack(rows))


def detect(picture, name="aruco", family="36h11", **settings):
    return make_detector(name, family, TagSettings(**settings)).process(picture, 0.0)


def test_families_are_those_of_the_language():
    assert {name: len(dictionary(name).bytesList) for name in DICTIONARIES} == FAMILIES


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("turns", range(4))
def test_a_tag_is_read_whichever_way_up(name, turns):
    picture = np.ascontiguousarray(np.rot90(sheet(7, columns=1), turns))
    (tag,) = detect(picture, name)
    assert (tag.id, tag.agreement) == (7, 1.0)
    assert tag.margin > 120
    # 16 to 80 in the upright picture, then turned: the first corner is the one that is printed at the upper left.
    expected = np.array([[16, 16], [16, 79], [79, 79], [79, 16]], float)[turns]
    assert np.abs(tag.corners[0] - expected).max() < 2


def test_detectors_that_go_take_nothing_with_them():
    picture = sheet(7, columns=1)
    assert {detect(picture, "apriltag")[0].id for _ in range(60)} == {7}
    one, other = (make_detector("apriltag", "36h11") for _ in range(2))
    del one
    gc.collect()
    assert [tag.id for tag in other.process(picture, 0.0)] == [7]


@pytest.mark.parametrize("name", NAMES)
def test_a_mirrored_tag_has_no_id(name):
    grammar = load_grammar()
    numbers = [*grammar.tags.words, grammar.motions.left, grammar.motions.right]
    picture = sheet(*numbers)
    assert sorted(tag.id for tag in detect(picture, name)) == sorted(numbers)
    assert detect(np.ascontiguousarray(picture[:, ::-1]), name) == ()
    assert detect(np.ascontiguousarray(picture[::-1]), name) == ()  # as the surface mirrors it


@pytest.mark.slow
def test_no_tag_of_the_family_is_read_in_a_mirror():
    pictures = [sheet(*range(first, min(first + 64, 587))) for first in range(0, 587, 64)]
    assert sum(len(detect(picture)) for picture in pictures) == 587
    assert all(detect(np.ascontiguousarray(picture[:, ::-1])) == () for picture in pictures)


@pytest.mark.parametrize("place", [0, 2, 5, 10, 16])
def test_a_card_at_the_edge_of_the_picture_is_read(place):
    picture = np.full((200, 200), 128, np.uint8)
    card = cv2.copyMakeBorder(
        cv2.aruco.generateImageMarker(dictionary("36h11"), 0, 64), *[10] * 4, cv2.BORDER_CONSTANT, value=255
    )
    picture[place : place + 84, place : place + 84] = card
    assert [tag.id for tag in detect(picture)] == [0]


def test_what_its_cells_do_not_bear_out_is_no_tag():
    picture = sheet(3, columns=1)
    (tag,) = detect(picture)
    margin, agreement = examine(picture, tag.corners, cells_of("36h11", 4))
    assert agreement < 0.9
    assert margin < tag.margin
    assert detect(picture, least_margin=127.6) == ()


def test_a_tag_that_is_lost_is_looked_for_where_it_was():
    clear = np.full((480, 640), 110, np.uint8)
    clear[100:196, 200:296] = sheet(5, columns=1)
    murky = (clear * 0.035 + 100).astype(np.uint8)  # 9 grey levels between black and white
    detector = ArucoTags("36h11", TagSettings())
    assert detector.process(murky, 0.0) == ()
    assert [tag.id for tag in detector.process(clear, 0.1)] == [5]
    assert [tag.id for tag in detector.process(murky, 0.2)] == [5]
    assert detector.process(murky, 9.0) == ()


def test_in_a_busy_picture_one_window_a_frame_finds_what_all_find():
    rng = np.random.default_rng(0)
    reef = cv2.GaussianBlur(rng.uniform(0, 255, (480, 640)).astype(np.float32), (0, 0), 1.2)
    picture = np.clip((reef - 128) * 3 + 110, 0, 255).astype(np.uint8)
    assert busyness(np.full((480, 640), 110, np.uint8), 5) == 0.0
    assert busyness(picture, 5) > 10 * TagSettings().busy
    picture[100:196, 200:296] = sheet(5, columns=1)
    detector = ArucoTags("36h11", TagSettings(follow_s=0.0))
    assert [[tag.id for tag in detector.process(picture, float(frame))] for frame in range(5)] == [[5]] * 5


def test_a_tag_that_was_lost_in_a_busy_picture_is_looked_for_with_all_windows():
    rng = np.random.default_rng(0)
    picture = rng.integers(0, 255, (480, 640), np.uint8)
    detector = ArucoTags("36h11", TagSettings(follow_s=0.5))
    shown = picture.copy()
    shown[100:196, 200:296] = sheet(5, columns=1)
    # Dim and blurred, so that neither of the first two windows finds it alone, and out of reach of a look nearby.
    dim = cv2.GaussianBlur(110 + (sheet(5, columns=1).astype(np.float32) - 127) * 0.08, (0, 0), 2.5)
    moved = picture.copy()
    moved[300:396, 450:546] = dim.astype(np.uint8)
    assert [len(detector.process(one, at_s)) for one, at_s in ((shown, 0.0), (picture, 0.1))] == [1, 0]
    assert [tag.id for tag in detector.process(moved, 0.2)] == [5]


@pytest.mark.parametrize(
    ("name", "family", "message"),
    [
        ("aruco", "16h5", "'16h5' is no family of tags that is read; use one of 25h9, 36h10, 36h11"),
        ("apriltag", "36h10", "'36h10' is no family that apriltag reads; use one of 25h9, 36h11, or aruco"),
    ],
)
def test_a_family_that_is_not_read(name, family, message):
    with pytest.raises(ValueError, match="^" + message):
        make_detector(name, family)
