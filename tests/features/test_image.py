"""Frames of odd kinds become 8-bit BGR or are refused in one line."""

import numpy as np
import pytest

from lightgesture.features.image import as_bgr8

GREY = np.arange(12, dtype=np.uint8).reshape(3, 4)


def test_a_frame_that_is_right_is_not_copied():
    frame = np.zeros((3, 4, 3), np.uint8)
    assert as_bgr8(frame) is frame


@pytest.mark.parametrize("frame", [GREY, GREY[..., None]], ids=["two axes", "one channel"])
def test_grey_becomes_three_equal_channels(frame):
    bgr = as_bgr8(frame)
    assert bgr.dtype == np.uint8
    np.testing.assert_array_equal(bgr, np.stack([GREY] * 3, axis=2))


def test_sixteen_bits_use_their_whole_range():
    frame = np.array([[[0, 257, 128 * 257]], [[65535, 100, 200]]], np.uint16)
    np.testing.assert_array_equal(as_bgr8(frame), [[[0, 1, 128]], [[255, 0, 1]]])


def test_sixteen_bit_grey_is_both():
    np.testing.assert_array_equal(as_bgr8(np.full((2, 2), 65535, np.uint16)), np.full((2, 2, 3), 255))


def test_alpha_is_dropped():
    frame = np.random.default_rng(0).integers(0, 256, (5, 6, 4), np.uint8)
    np.testing.assert_array_equal(as_bgr8(frame), frame[..., :3])


def test_a_flipped_view_is_read_as_it_looks():
    frame = np.random.default_rng(0).integers(0, 256, (5, 6, 4), np.uint8)[:, ::-1]
    np.testing.assert_array_equal(as_bgr8(frame), frame[..., :3])


@pytest.mark.parametrize(
    ("frame", "named"),
    [
        (np.zeros((3, 4, 3)), "float64"),
        (np.zeros((3, 4, 3), bool), "bool"),
        (np.zeros((3, 4, 3), np.int16), "int16"),
        (np.zeros((3, 4, 2), np.uint8), "(3, 4, 2)"),
        (np.zeros(5, np.uint8), "(5,)"),
        (np.zeros((2, 3, 4, 3), np.uint8), "(2, 3, 4, 3)"),
        (np.zeros((0, 4, 3), np.uint8), "(0, 4, 3)"),
        (None, "NoneType"),
    ],
)
def test_what_is_no_picture_is_refused_in_one_line(frame, named):
    with pytest.raises(ValueError, match="frame of") as caught:
        as_bgr8(frame)
    message = str(caught.value)
    assert named in message
    assert "\n" not in message
