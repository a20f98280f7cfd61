"""Numbers of outlines whose values are known, and of outlines that hardly are any."""

import numpy as np
import pytest

from lightgesture.features.outline.contours import (
    SHAPE_NUMBERS,
    ContourSettings,
    contour_numbers,
    defect_depths,
)

SQUARE = np.array([[10, 10], [30, 10], [30, 30], [10, 30]], np.int32)
ARROW = np.array([[0, 0], [100, 40], [0, 80], [30, 40]], np.int32)
"""A square's half with a dent 30 pixels deep in its straight side."""

BARELY = {
    "point": np.array([[5, 7]], np.int32),
    "two points": np.array([[5, 7], [9, 7]], np.int32),
    "line": np.array([[0, 0], [5, 5], [10, 10], [5, 5]], np.int32),
    "the same point": np.full((9, 2), 4, np.int32),
    "triangle": np.array([[0, 0], [4, 0], [0, 4]], np.int32),
}


def _numbers(contour):
    """Area, solidity, extent, aspect, circularity and number of deep defects in a picture 100 pixels wide."""
    return contour_numbers(contour, ContourSettings(size=100))[:SHAPE_NUMBERS]


def test_a_square():
    # OpenCV's boxes hold pixels, so a side from 10 to 30 is 21 long.
    expected = 0.04, 1.0, 400 / 21**2, 1.0, np.pi / 4, 0.0
    assert _numbers(SQUARE) == pytest.approx(expected)
    assert len(defect_depths(SQUARE)) == 0


def test_a_dent_is_found_with_its_depth():
    assert defect_depths(ARROW) == pytest.approx([30.0], abs=0.01)
    assert _numbers(ARROW)[1] == pytest.approx(0.7)


@pytest.mark.parametrize("contour", BARELY.values(), ids=BARELY.keys())
def test_what_is_hardly_an_outline_gives_finite_numbers(contour):
    numbers = contour_numbers(contour)
    assert np.isfinite(numbers).all()
    assert (numbers[:SHAPE_NUMBERS] >= 0.0).all()
    assert len(defect_depths(contour)) == 0


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_every_gap_between_fingers_is_a_dent(count):
    points = [[0, 300]]
    for finger in range(count):
        # An arc of tips: were they level, the hull would touch the outer ones alone.
        left, tip = finger * 60, round(10 * abs(finger - (count - 1) / 2) ** 2)
        points += [[left, 160], [left + 20, tip], [left + 30, tip], [left + 50, 160]]
    contour = np.array([*points, [60 * count - 10, 300]], np.int32)
    assert (defect_depths(contour) > 100.0).sum() == count - 1


def test_a_disc_has_no_dent_and_is_round():
    angles = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    disc = np.rint(300 + 200 * np.stack([np.cos(angles), np.sin(angles)], axis=1)).astype(np.int32)
    assert defect_depths(disc).max(initial=0.0) < 2.0
    assert _numbers(disc)[4] == pytest.approx(1.0, abs=0.02)
