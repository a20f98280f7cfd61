"""Bad boxes, cut and covered hands, boxes without a hand."""

import numpy as np
import pytest

from lightgesture.benchmarks.reading.troubles import (
    EDGES,
    cut_by_edge,
    half_covered,
    random_boxes,
    scaled_box,
    shifted_boxes,
)

BOX = (30, 20, 40, 60)


@pytest.fixture
def picture():
    """Each pixel tells its column and its row; the hand is one plain colour."""
    rows, columns = np.mgrid[:100, :120]
    image = np.stack([columns, rows, np.zeros_like(rows)], axis=-1).astype(np.uint8)
    x, y, width, height = BOX
    image[y : y + height, x : x + width] = (90, 120, 180)
    return image


def test_shifted_boxes_move_by_a_share_of_each_side():
    assert shifted_boxes(BOX, 0.1) == [(26, 20, 40, 60), (30, 14, 40, 60), (34, 20, 40, 60), (30, 26, 40, 60)]


@pytest.mark.parametrize(("factor", "box"), [(0.5, (40, 35, 20, 30)), (1.5, (20, 5, 60, 90))])
def test_scaled_box_keeps_its_middle(factor, box):
    assert scaled_box(BOX, factor) == box


@pytest.mark.parametrize(
    ("edge", "first_pixel", "box"),
    [
        ("left", (40, 0), (0, 20, 30, 60)),
        ("top", (0, 35), (30, 0, 40, 45)),
        ("right", (0, 0), (30, 20, 30, 60)),
        ("bottom", (0, 0), (30, 20, 40, 45)),
    ],
)
def test_a_quarter_of_the_hand_lies_beyond_the_edge(picture, edge, first_pixel, box):
    shown, seen = cut_by_edge(picture, BOX, edge, 0.25)
    assert seen == box
    column, row = first_pixel
    np.testing.assert_array_equal(
        shown, picture[row : row + shown.shape[0], column : column + shown.shape[1]]
    )
    x, y, width, height = seen
    assert (shown[y : y + height, x : x + width] == (90, 120, 180)).all()
    touched = {"left": x == 0, "top": y == 0, "right": x + width == shown.shape[1]}
    assert touched.get(edge, y + height == shown.shape[0])


@pytest.mark.parametrize("edge", EDGES)
def test_a_box_over_the_edge_still_leaves_something_to_see(picture, edge):
    shown, (x, y, width, height) = cut_by_edge(picture, (-10, -10, 150, 140), edge, 0.5)
    assert width > 0 < height
    assert x >= 0 <= y
    assert x + width <= shown.shape[1]
    assert y + height <= shown.shape[0]


@pytest.mark.parametrize("edge", EDGES)
def test_about_half_of_the_hand_is_covered_in_its_own_colour(picture, edge):
    x, y, width, height = BOX
    marked = picture.copy()
    marked[y : y + height, x : x + width, 0] = np.arange(width) % 2 * 100
    covered = half_covered(marked, BOX, edge)
    inner = np.s_[y : y + height, x : x + width]
    changed = (covered[inner] != marked[inner]).any(axis=2)
    assert 0.35 < changed.mean() < 0.55
    middle = {"left": changed[:, :5], "right": changed[:, -5:], "top": changed[:5], "bottom": changed[-5:]}
    assert middle[edge].mean() > 0.8
    tint = covered[inner][changed].astype(float)
    assert (tint[:, 2] > tint[:, 1]).mean() > 0.95


def test_random_boxes_lie_in_the_picture_and_follow_their_seed():
    def drawn(seed):
        return list(random_boxes((90, 200), 300, (0.1, 0.6), np.random.default_rng(seed)))

    boxes = drawn(0)
    assert boxes == drawn(0) != drawn(1)
    for x, y, width, height in boxes:
        assert x >= 0 <= y
        assert x + width <= 200
        assert y + height <= 90
        assert 8 <= max(width, height) <= 55
        assert max(width, height) <= 1.6 * min(width, height) + 1
    assert {width > height for _, _, width, height in boxes} == {True, False}
