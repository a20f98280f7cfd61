"""What turning, enlarging and mirroring an outline does to each of its numbers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.outline.contours import contour_numbers, defect_depths, hu_moments

VERTICES = 300
DEGREES = np.array([1, 2, 3, 3, 6, 4, 6])
"""Each of Hu's invariants over this power of the first is a number without the outline's spread."""


@st.composite
def outlines(draw):
    """A closed star-shaped outline with bulges and dents, float64 (300, 2), 1,200 to 4,000 pixels wide:
    the pixels to which it is rounded then hardly matter."""
    knots = np.array(draw(st.lists(st.floats(0.3, 1.0), min_size=5, max_size=12)))
    angles = np.linspace(0, 2 * np.pi, VERTICES, endpoint=False)
    places = np.linspace(0, 2 * np.pi, len(knots) + 1)
    # A cosine between the knots keeps the outline round, as a hand's is.
    position = np.searchsorted(places, angles, side="right") - 1
    inside = (angles - places[position]) / (places[1] - places[0])
    ease = (1 - np.cos(np.pi * inside)) / 2
    radius = knots[position] * (1 - ease) + knots[(position + 1) % len(knots)] * ease
    return 2000.0 * np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1)


@st.composite
def changes(draw):
    """A turn, an enlargement and perhaps a mirror, as the matrix (2, 2) and the factor."""
    angle, factor = draw(st.floats(-np.pi, np.pi)), draw(st.floats(0.5, 4.0))
    mirror = -1.0 if draw(st.booleans()) else 1.0
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return factor * turn @ np.diag([mirror, 1.0]), factor


def _pixels(points):
    return np.rint(points + 9000.0).astype(np.int32)


def _both(points, matrix):
    return _pixels(points), _pixels(points @ matrix.T)


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_the_area_grows_with_the_outline_and_ratios_stay(points, change):
    matrix, factor = change
    before, after = (contour_numbers(contour) for contour in _both(points, matrix))
    assert after[0] == pytest.approx(factor**2 * before[0], rel=0.02)
    assert after[1] == pytest.approx(before[1], abs=0.01)
    assert after[4] == pytest.approx(before[4], abs=0.03)


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_defects_grow_with_the_outline(points, change):
    matrix, factor = change
    depths = [np.sort(defect_depths(contour))[::-1][:2] for contour in _both(points, matrix)]
    sizes = [np.pad(found, (0, 2 - len(found))) for found in depths]
    np.testing.assert_allclose(sizes[1], factor * sizes[0], atol=3 + 3 * factor)


@given(points=outlines(), factor=st.floats(0.5, 4.0))
@settings(max_examples=30, deadline=None)
def test_the_upright_box_gives_the_same_numbers_enlarged_or_mirrored_but_not_turned(points, factor):
    before, mirrored = (contour_numbers(one) for one in _both(points, np.diag([-factor, factor])))
    turned = contour_numbers(_both(points, factor * np.array([[0.0, -1.0], [1.0, 0.0]]))[1])
    assert mirrored[2] == pytest.approx(before[2], abs=0.02)
    assert mirrored[3] == pytest.approx(before[3], rel=0.02)
    assert turned[3] == pytest.approx(1.0 / before[3], rel=0.02)


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_hu_moments_stay_and_a_mirror_image_turns_the_sign_of_the_seventh(points, change):
    matrix, _ = change
    before, after = _both(points, matrix)
    expected, found = hu_moments(before), hu_moments(after)
    if np.linalg.det(matrix) < 0:
        expected[6] = -expected[6]
    scale = expected[0] ** DEGREES
    np.testing.assert_allclose(found / scale, expected / scale, atol=0.01)
