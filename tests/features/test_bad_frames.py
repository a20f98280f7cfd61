"""Frames that no camera should give: bounded time and memory, no exception, no hand that is not there."""

import time
import tracemalloc

import cv2
import numpy as np
import pytest

from lightgesture.features import find_hands
from lightgesture.features.colour import WORKING_PIXELS, ColourStage
from lightgesture.features.find.proposals import propose
from lightgesture.features.image import as_bgr8
from lightgesture.features.outline.contours import contour_numbers
from lightgesture.features.profile import ColourProfile

SKIN, WATER = (110, 140, 200), (150, 120, 40)
MOST_SECONDS = 3.0
"""Of a processor, for any frame; a usual one takes a few milliseconds."""

RAMP = np.linspace(0, 255, 16, dtype=np.uint8)
PROFILE = ColourProfile("glove", "blue", 0.9, 3.0, np.broadcast_to(RAMP[:, None, None], (16, 16, 16)).copy())


def _specks(count, seed=3):
    rng = np.random.default_rng(seed)
    image = np.full((480, 640, 3), WATER, np.uint8)
    for x, y in zip(rng.integers(0, 640, count), rng.integers(0, 480, count), strict=True):
        image[y : y + 2, x : x + 2] = SKIN
    return image


EMPTY = {
    "black": np.zeros((480, 640, 3), np.uint8),
    "white": np.full((480, 640, 3), 255, np.uint8),
    "constant": np.full((480, 640, 3), (90, 130, 110), np.uint8),
    "all skin": np.full((480, 640, 3), SKIN, np.uint8),
    "1x1": np.full((1, 1, 3), 200, np.uint8),
    "2x3": np.arange(18, dtype=np.uint8).reshape(2, 3, 3),
    "short row": np.full((1, 19_000, 3), 90, np.uint8),
    "one row": np.full((1, 100_000, 3), 90, np.uint8),
    "one column": np.full((100_000, 1, 3), 90, np.uint8),
    "grey": np.full((480, 640), 100, np.uint8),
    "16-bit": np.full((480, 640, 3), 30_000, np.uint16),
    "16-bit grey": np.full((480, 640), 30_000, np.uint16),
    "four channels": np.full((480, 640, 4), 100, np.uint8),
}

BUSY = {
    "specks": _specks(10_000),
    "noise": np.random.default_rng(1).integers(0, 256, (480, 640, 3), np.uint8),
    "grey noise": np.random.default_rng(2).integers(0, 256, (480, 640), np.uint8),
    "16-bit noise": np.random.default_rng(4).integers(0, 65_536, (480, 640, 4), np.uint16),
    "chequers": np.kron(np.indices((120, 160)).sum(axis=0) % 2 * 255, np.ones((4, 4), int)).astype(np.uint8),
}


@pytest.mark.parametrize("image", EMPTY.values(), ids=EMPTY.keys())
def test_frames_of_nothing_hold_no_region_and_no_hand(image):
    for profile in (None, PROFILE):
        colour = ColourStage(profile).process(as_bgr8(image))
        assert colour.picture.ndim == 3
        assert colour.skin.shape == colour.picture.shape[:2]
        assert colour.source_size == (image.shape[1], image.shape[0])
        assert len(propose(colour)) == 0
    assert find_hands(image) == []


@pytest.mark.parametrize("image", BUSY.values(), ids=BUSY.keys())
@pytest.mark.parametrize("profile", [None, PROFILE], ids=["default", "profile"])
def test_frames_of_everything_take_bounded_time(image, profile):
    start = time.process_time()
    proposals = propose(ColourStage(profile).process(as_bgr8(image)))
    for contour in proposals.contours:
        numbers = contour_numbers(contour)
        assert 0.0 < numbers[1] <= 1.0
        assert np.isfinite(numbers).all()
    assert time.process_time() - start < MOST_SECONDS
    assert len(proposals) <= 160


@pytest.mark.parametrize("image", BUSY.values(), ids=BUSY.keys())
def test_frames_of_everything_hold_no_hand(image):
    assert find_hands(image) == []


@pytest.mark.parametrize(
    "image",
    [np.zeros((6000, 8000, 3), np.uint8), np.zeros((80_000, 600, 3), np.uint8)],
    ids=["8000x6000", "600x80000"],
)
def test_huge_frames_take_bounded_time_and_memory(image):
    tracemalloc.start()
    start = time.process_time()
    colour = ColourStage().process(image)
    regions = len(propose(colour))
    seconds = time.process_time() - start
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert regions == 0
    assert colour.picture.shape[0] * colour.picture.shape[1] <= 1.05 * WORKING_PIXELS
    assert seconds < MOST_SECONDS
    # Only what is looked at is copied.
    assert most < 20e6


def test_odd_kinds_of_a_frame_give_the_map_of_the_plain_one():
    plain = cv2.GaussianBlur(_specks(300), (31, 31), 0)
    stage = ColourStage()
    expected = stage.process(plain)
    for other in (
        np.dstack([plain, np.zeros((480, 640), np.uint8)]),
        plain.astype(np.uint16) * 257,
        np.asfortranarray(plain),
        plain[:, ::-1][:, ::-1],
    ):
        found = stage.process(as_bgr8(other))
        np.testing.assert_array_equal(found.picture, expected.picture)
        np.testing.assert_array_equal(found.skin, expected.skin)


@pytest.mark.parametrize("image", [np.zeros((4, 4, 3)), np.zeros((0, 4, 3), np.uint8), np.zeros(4, np.uint8)])
def test_what_is_no_frame_is_refused_in_one_line(image):
    with pytest.raises(ValueError, match=r"frame of .*convert it first"):
        find_hands(image)
