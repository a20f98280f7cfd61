"""Numbers of outlines whose values are known, and of outlines that hardly are any."""

import numpy as np
import pytest

from lightgesture.features.outline import shape
from lightgesture.features.outline.curvature import CurvatureSettings, curvature_points
from lightgesture.features.outline.resample import resample

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


def test_a_square():
    assert shape.area(SQUARE) == 400
    assert shape.perimeter(SQUARE) == 80
    assert shape.solidity(SQUARE) == 1.0
    assert shape.aspect(SQUARE) == 1.0
    # OpenCV's boxes hold pixels, so a side from 10 to 30 is 21 long.
    assert shape.extent(SQUARE) == pytest.approx(400 / 21**2)
    assert shape.circularity(SQUARE) == pytest.approx(np.pi / 4)
    np.testing.assert_allclose(shape.hull_centre(SQUARE), (20, 20))
    assert len(shape.convexity_defects(SQUARE)) == 0


def test_a_dent_is_found_with_its_place_and_depth():
    defects = shape.convexity_defects(ARROW)
    assert defects.deepest.tolist() == [[30, 40]]
    assert defects.depth == pytest.approx([30.0], abs=0.01)
    assert {tuple(defects.start[0]), tuple(defects.end[0])} == {(0, 0), (0, 80)}
    assert len(shape.convexity_defects(ARROW, least_depth=31.0)) == 0
    assert shape.solidity(ARROW) == pytest.approx(0.7)
    np.testing.assert_allclose(shape.hull_centre(ARROW), (100 / 3, 40))
    assert sorted(map(tuple, shape.convex_hull(ARROW))) == [(0, 0), (0, 80), (100, 40)]


@pytest.mark.parametrize("contour", BARELY.values(), ids=BARELY.keys())
def test_what_is_hardly_an_outline_gives_finite_numbers(contour):
    for number in (
        shape.area,
        shape.perimeter,
        shape.solidity,
        shape.extent,
        shape.aspect,
        shape.circularity,
    ):
        value = number(contour)
        assert np.isfinite(value), number.__name__
        assert value >= 0.0
    assert np.isfinite(shape.hull_centre(contour)).all()
    assert len(shape.convexity_defects(contour)) == 0
    assert curvature_points(contour).fingertips.shape[1] == 2
    assert np.isfinite(resample(contour, 16)).all()


def test_depths_alone_are_those_of_the_defects():
    for contour in (SQUARE, ARROW, _fingers(4)):
        assert np.array_equal(shape.defect_depths(contour), shape.convexity_defects(contour).depth)
    assert shape.defect_depths(_fingers(4)).max() > 100.0


def _fingers(count):
    """Outline of a wide palm with pointed fingers upwards."""
    points = [[0, 300]]
    for finger in range(count):
        left = finger * 60
        points += [[left, 160], [left + 20, 0], [left + 30, 0], [left + 50, 160]]
    points.append([60 * count - 10, 300])
    return np.array(points, np.int32)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
def test_fingertips_and_valleys_are_counted(count):
    contour = _fingers(count)
    found = curvature_points(contour)
    tips = found.fingertips[found.fingertips[:, 1] < 40]
    valleys = found.valleys[found.valleys[:, 1] > 120]
    np.testing.assert_allclose(sorted(tips[:, 0]), [25 + 60 * finger for finger in range(count)], atol=12)
    np.testing.assert_allclose(
        sorted(valleys[:, 0]), [55 + 60 * finger for finger in range(count - 1)], atol=12
    )


def test_a_disc_has_neither():
    angles = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    disc = np.rint(300 + 200 * np.stack([np.cos(angles), np.sin(angles)], axis=1)).astype(np.int32)
    found = curvature_points(disc)
    assert len(found.fingertips) == 0
    assert len(found.valleys) == 0
    assert shape.circularity(disc) == pytest.approx(1.0, abs=0.02)


def test_blunter_turns_count_when_asked_for():
    hexagon = np.array([[100, 0], [200, 60], [200, 180], [100, 240], [0, 180], [0, 60]], np.int32)
    assert len(curvature_points(hexagon).fingertips) == 0
    assert len(curvature_points(hexagon, CurvatureSettings(fingertip=135.0)).fingertips) == 6


def test_resampled_points_are_evenly_spaced_whatever_the_corners():
    along = np.arange(10, 30)
    dense = np.concatenate(
        [
            np.stack([along, np.full(20, 10)], 1),
            np.stack([np.full(20, 30), along], 1),
            np.stack([along[::-1] + 1, np.full(20, 30)], 1),
            np.stack([np.full(20, 10), along[::-1] + 1], 1),
        ]
    ).astype(np.int32)
    np.testing.assert_allclose(resample(SQUARE, 20), resample(dense, 20))
    np.testing.assert_allclose(np.abs(np.diff(resample(SQUARE, 20))), 4.0)
