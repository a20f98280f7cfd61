"""What turning, enlarging and mirroring an outline does to each of its numbers."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.outline import shape
from lightgesture.features.outline.curvature import CurvatureSettings, curvature_points
from lightgesture.features.outline.hu import hu_moments
from lightgesture.features.outline.resample import resample

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


def _moved(points, matrix):
    """Points of the first outline where they lie on the second."""
    return (np.asarray(points) - 9000.0) @ matrix.T + 9000.0


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_sizes_grow_with_the_outline_and_ratios_stay(points, change):
    matrix, factor = change
    before, after = _both(points, matrix)
    assert shape.area(after) == pytest.approx(factor**2 * shape.area(before), rel=0.02)
    assert shape.perimeter(after) == pytest.approx(factor * shape.perimeter(before), rel=0.02)
    assert shape.solidity(after) == pytest.approx(shape.solidity(before), abs=0.01)
    assert shape.circularity(after) == pytest.approx(shape.circularity(before), abs=0.03)


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_hull_and_defects_go_with_the_outline(points, change):
    matrix, factor = change
    before, after = _both(points, matrix)
    np.testing.assert_allclose(
        shape.hull_centre(after), _moved(shape.hull_centre(before), matrix), atol=2 + 2 * factor
    )
    hull = _moved(shape.convex_hull(before), matrix)
    gaps = np.hypot(*(hull[:, None] - after[None]).transpose(2, 0, 1)).min(axis=1)
    assert gaps.max() < 2 + 2 * factor
    depths = [np.sort(shape.convexity_defects(contour).depth)[::-1][:2] for contour in (before, after)]
    sizes = [np.pad(found, (0, 2 - len(found))) for found in depths]
    np.testing.assert_allclose(sizes[1], factor * sizes[0], atol=3 + 3 * factor)


@given(points=outlines(), factor=st.floats(0.5, 4.0))
@settings(max_examples=30, deadline=None)
def test_the_upright_box_gives_the_same_numbers_enlarged_or_mirrored_but_not_turned(points, factor):
    before, mirrored = _both(points, np.diag([-factor, factor]))
    _, turned = _both(points, factor * np.array([[0.0, -1.0], [1.0, 0.0]]))
    assert shape.extent(mirrored) == pytest.approx(shape.extent(before), abs=0.02)
    assert shape.aspect(mirrored) == pytest.approx(shape.aspect(before), rel=0.02)
    assert shape.aspect(turned) == pytest.approx(1.0 / shape.aspect(before), rel=0.02)


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


@given(points=outlines(), change=changes())
@settings(max_examples=60, deadline=None)
def test_fingertips_and_valleys_go_with_the_outline(points, change):
    matrix, _ = change
    before, after = _both(points, matrix)
    limits = CurvatureSettings()
    first, second = curvature_points(before), curvature_points(after)
    reach = (limits.apart + 2.0 / limits.points) * shape.perimeter(after)
    for points_of, angles_of, limit in (
        ("fingertips", "fingertip_angles", limits.fingertip),
        ("valleys", "valley_angles", limits.valley),
    ):
        # An angle near the limit may fall to either side of it by rounding.
        sharp = getattr(first, angles_of) < limit - 12.0
        places = getattr(second, points_of)
        for point in _moved(getattr(first, points_of)[sharp], matrix):
            assert len(places)
            assert np.hypot(*(places - point).T).min() < reach


@given(points=outlines(), change=changes(), count=st.integers(3, 200))
@settings(max_examples=40, deadline=None)
def test_resampled_points_go_with_the_outline(points, change, count):
    matrix, factor = change
    walk, other = (resample(contour, count) for contour in _both(points, matrix))
    moved = _moved(np.stack([walk.real, walk.imag], axis=1), matrix)
    np.testing.assert_allclose(np.stack([other.real, other.imag], axis=1), moved, atol=20 + 20 * factor)
