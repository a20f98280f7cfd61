"""Frames of odd kinds become 8-bit BGR or are refused in one line."""

from itertools import pairwise

import numpy as np
import pytest

from lightgesture.features.image import BitDepth, as_bgr8

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
    frame = np.array([[[0, 257, 128 * 257]], [[65535, 100, 300]]], np.uint16)
    np.testing.assert_array_equal(as_bgr8(frame), [[[0, 1, 128]], [[255, 0, 1]]])


@pytest.mark.parametrize("bits", [8, 10, 12, 14, 16])
def test_full_scale_of_a_sensor_is_full_scale(bits):
    full = 2**bits - 1
    depth = BitDepth(pytest.fail)
    np.testing.assert_array_equal(depth.bgr8(np.full((2, 3), full, np.uint16)), np.full((2, 3, 3), 255))
    half = depth.bgr8(np.full((2, 3), full // 2, np.uint16))
    np.testing.assert_array_equal(half, np.full((2, 3, 3), 127))


@pytest.mark.parametrize("bits", [10, 12, 14, 16])
def test_brightness_that_changes_is_monotone_and_never_jumps(bits):
    """The first frame decides; those that are darker by a power of two must not be brightened again."""
    full = 2**bits - 1
    depth = BitDepth(pytest.fail)
    values = [full, *range(0, full, full // 97), full]
    seen = [int(depth.bgr8(np.full((2, 2), value, np.uint16))[0, 0, 0]) for value in values]
    assert seen[0] == seen[-1] == 255
    assert seen[1] == 0
    assert all(0 <= after - before <= 3 for before, after in pairwise(seen[1:]))


def test_a_frame_that_exceeds_the_bits_raises_them_with_a_message():
    told = []
    depth = BitDepth(told.append)
    levels = [depth.bgr8(np.full((2, 2), value, np.uint16))[0, 0, 0] for value in (600, 1023, 3000, 1023)]
    assert levels == [600 >> 2, 255, 3000 >> 4, 1023 >> 4]
    assert told == ["a picture is brighter than 10 bits can be; read with 12 bits from here on"]


def test_declared_bits_come_before_the_first_frame():
    depth = BitDepth(pytest.fail)
    depth.declare(4095)
    depth.declare(65535)
    assert depth.bgr8(np.full((2, 2), 600, np.uint16))[0, 0, 0] == 600 >> 4


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
