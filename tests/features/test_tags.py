"""Tags are read whichever way up, by both libraries alike, and a mirrored one never."""

import gc

import cv2
import numpy as np
import pytest

from lightgesture.features.tags.detector import ArucoTags, busyness, make_detector
from lightgesture.features.tags.outlines import dark_inside, read_outlines
from lightgesture.features.tags.sampling import cell_values
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


def small(number, side=18, blur=0.9, smear=1):
    """A card whose tag is so small, between pixels, blurred, smeared to the side and noisy, uint8 (128, 128)."""
    card = cv2.copyMakeBorder(
        cv2.aruco.generateImageMarker(dictionary("36h11"), number, 160),
        *[40] * 4,
        cv2.BORDER_CONSTANT,
        value=255,
    )
    finer, scale, shift = 4, side / 160, number / 24
    way = finer * np.array([[scale, 0, 40 + shift], [0, scale, 40 + shift / 2]])
    large = cv2.warpAffine(card, way, (128 * finer,) * 2, flags=cv2.INTER_AREA, borderValue=128)
    grey = cv2.resize(large, (128, 128), interpolation=cv2.INTER_AREA).astype(np.float32)
    grey = cv2.blur(cv2.GaussianBlur(grey, (0, 0), blur), (smear, 1))
    noise = np.random.default_rng(number).normal(0.0, 2.0, grey.shape)
    return np.clip(30 + 0.8 * grey + noise, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("side", "blur", "smear"), [(16, 0.8, 1), (20, 1.0, 1), (28, 1.5, 3), (28, 1.0, 5)])
def test_small_blurred_and_moving_tags_are_read_by_their_cells(side, blur, smear):
    alone = cv2.aruco.ArucoDetector(dictionary("36h11"))
    pictures = {number: small(number, side, blur, smear) for number in range(24)}
    named = [ids is not None for _, ids, _ in map(alone.detectMarkers, pictures.values())]
    assert sum(named) < 22
    assert [[tag.id for tag in detect(picture)] for picture in pictures.values()] == [
        [number] for number in pictures
    ]
    assert all(detect(np.ascontiguousarray(picture[:, ::-1])) == () for picture in pictures.values())


def test_a_tag_that_only_its_cells_tell_is_all_but_flawless_or_where_it_was():
    clear = sheet(7, columns=1)
    dirty = clear.copy()
    for row, column in ((2, 2), (3, 4), (5, 3), (4, 5)):  # one more than OpenCV puts right
        cell = dirty[16 + 8 * row :, 16 + 8 * column :][:8, :8]
        cell[:] = 255 - cell
    assert detect(dirty) == ()
    (tag,) = detect(dirty, alone_agreement=0.9)
    assert (tag.id, tag.agreement) == (7, 0.938)
    detector = ArucoTags("36h11", TagSettings())
    assert [len(detector.process(one, at_s)) for one, at_s in ((clear, 0.0), (dirty, 0.1), (dirty, 3.0))] == [
        1,
        1,
        0,
    ]


def test_the_same_tag_is_told_once_and_two_of_one_id_twice():
    picture = sheet(3, 3, columns=2)
    assert [tag.id for tag in detect(picture)] == [3, 3]
    assert [tag.id for tag in detect(small(3, 20))] == [3]


def test_cells_are_looked_at_where_a_projective_mapping_has_them():
    rng = np.random.default_rng(1)
    ramp = (np.arange(200)[None, :] * 0.8 + np.arange(200)[:, None] * 0.4).astype(np.uint8)
    outline = np.array([[60, 50], [140, 62], [150, 148], [52, 130]], np.float32) + rng.normal(0, 1, (4, 2))
    values = cell_values(ramp, outline[None], 8, (0.5,))[0, 1:-1, 1:-1]
    centres = (np.stack(np.meshgrid(*[np.arange(8) + 0.5] * 2), axis=-1) / 8).reshape(-1, 1, 2)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    places = cv2.perspectiveTransform(
        centres.astype(np.float32), cv2.getPerspectiveTransform(square, outline.astype(np.float32))
    ).reshape(8, 8, 2)
    assert np.abs(values - (places[..., 0] * 0.8 + places[..., 1] * 0.4)).max() < 1.5


def test_outlines_that_are_no_darker_inside_are_passed_over():
    picture, none = sheet(3, side=32, columns=1), np.empty((0, 4, 2), np.float32)
    tag = np.array([[8, 8], [39, 8], [39, 39], [8, 39]], np.float32)
    assert dark_inside(picture, np.stack([tag, tag + 200]), "36h11", 3.0).tolist() == [tag.tolist()]
    assert dark_inside(255 - picture, tag[None], "36h11", 3.0).size == 0
    assert dark_inside(picture, none, "36h11", 3.0).size == 0
    ((number, corners),) = read_outlines(picture, np.roll(tag, 1, axis=0)[None], "36h11", 3.0)
    assert number == 3
    assert np.array_equal(corners, tag)
    assert read_outlines(picture, none, "36h11", 3.0) == []


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
