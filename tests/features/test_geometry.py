"""Boxes: which of many that overlap are kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.find.candidates import DISTINCT_IOU, LEAST_SCORE, MOST, best_distinct
from lightgesture.features.geometry import (
    box_iou,
    keep_distinct,
    matched_iou,
    mirror_box,
    pairwise_iou,
    scale_boxes,
)


def _written_out(boxes, scores):
    """The definition, word for word: best first, each beside all that are kept."""
    kept = []
    for index in sorted(range(len(boxes)), key=lambda index: (-scores[index], index)):
        overlaps = [pairwise_iou(boxes[index], boxes[other])[0, 0] for other in kept]
        if scores[index] >= LEAST_SCORE and all(one < DISTINCT_IOU for one in overlaps):
            kept.append(index)
    return kept[:MOST]


@given(
    rows=st.lists(
        st.tuples(
            *[st.integers(0, 90)] * 2, *[st.integers(1, 30)] * 2, st.sampled_from([0.0, 0.05, 0.06, 0.5, 0.9])
        ),
        max_size=40,
    ),
)
@settings(max_examples=150, deadline=None)
def test_the_best_distinct_boxes_are_those_of_the_definition(rows):
    table = np.array(rows, np.float32).reshape(-1, 5)
    boxes, scores = table[:, :4], table[:, 4]
    assert best_distinct(pairwise_iou(boxes, boxes), scores) == _written_out(boxes, scores)


def test_what_a_dropped_one_overlaps_is_kept():
    # The middle box overlaps both others, which do not overlap each other.
    boxes = np.array([[0, 0, 10, 10], [5, 0, 10, 10], [10, 0, 10, 10]])
    same = pairwise_iou(boxes, boxes) > 0.3
    assert keep_distinct(same, range(3), 3) == [0, 2]
    assert keep_distinct(same, [1, 0, 2], 3) == [1]
    assert keep_distinct(same, [2, 1, 0], 3) == [2, 0]


@pytest.mark.parametrize(("most", "expected"), [(1, [0]), (2, [0, 1]), (9, [0, 1, 2, 3])])
def test_no_more_are_kept_than_wanted(most, expected):
    assert keep_distinct(np.eye(4, dtype=bool), range(4), most) == expected


def test_of_no_boxes_none_are_kept():
    assert best_distinct(np.zeros((0, 0)), np.zeros(0, np.float32)) == []


@given(
    boxes=st.lists(st.tuples(*[st.integers(0, 40)] * 2, *[st.integers(1, 40)] * 2), min_size=2, max_size=2)
)
def test_the_overlap_of_two_boxes_is_that_of_arrays(boxes):
    one, other = boxes
    expected = pairwise_iou(np.array([one]), np.array([other]))[0, 0]
    assert box_iou(one, other) == pytest.approx(expected)


def test_boxes_stay_inside_the_source():
    boxes = np.array([[150, 110, 20, 20], [-5, -5, 4, 4]])
    assert scale_boxes(boxes, (4.0, 4.0), (640, 480)) == [(600, 440, 40, 40), (0, 0, 1, 1)]
    assert scale_boxes(boxes[:0], (4.0, 4.0), (640, 480)) == []
    assert mirror_box((10, 5, 30, 40), 640) == (600, 5, 30, 40)


@given(
    box=st.tuples(*[st.floats(-50, 200)] * 2, *[st.floats(0.5, 200)] * 2),
    scale=st.tuples(*[st.floats(0.3, 30)] * 2),
    size=st.tuples(*[st.integers(1, 4000)] * 2),
)
def test_scaled_boxes_are_rounded_edge_by_edge_and_have_a_pixel(box, scale, size):
    (left, top, width, height), low = scale_boxes(np.array([box]), scale, size)[0], []
    for place, reach, one, most in ((left, width, 0, size[0]), (top, height, 1, size[1])):
        first, last = round(box[one] * scale[one]), round((box[one] + box[one + 2]) * scale[one])
        low.append(min(max(first, 0), most - 1))
        assert place == low[-1]
        assert reach == max(min(last, most) - low[-1], 1)


def test_boxes_matched_one_to_one_overlap_as_each_two_do():
    rng = np.random.default_rng(3)
    first, second = (rng.uniform(0, 60, (2, 7, 4))).astype(np.float32)
    assert np.array_equal(matched_iou(first, second), pairwise_iou(first, second).diagonal())
