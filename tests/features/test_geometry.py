"""Boxes: which of many that overlap are kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.find.settings import SelectorSettings
from lightgesture.features.geometry import best_distinct, box_iou, keep_distinct, pairwise_iou


def _written_out(boxes, scores, selection):
    """The definition, word for word: best first, each beside all that are kept."""
    kept = []
    for index in sorted(range(len(boxes)), key=lambda index: (-scores[index], index)):
        overlaps = [pairwise_iou(boxes[index], boxes[other])[0, 0] for other in kept]
        if scores[index] >= selection.least_score and all(one < selection.distinct_iou for one in overlaps):
            kept.append(index)
    return kept[: selection.candidates]


@given(
    rows=st.lists(
        st.tuples(
            *[st.integers(0, 30)] * 2, *[st.integers(1, 30)] * 2, st.sampled_from([0.0, 0.2, 0.5, 0.9])
        ),
        max_size=25,
    ),
    most=st.integers(1, 12),
    iou=st.sampled_from([0.1, 0.25, 0.5]),
)
@settings(max_examples=150, deadline=None)
def test_the_best_distinct_boxes_are_those_of_the_definition(rows, most, iou):
    table = np.array(rows, np.float32).reshape(-1, 5)
    selection = SelectorSettings(candidates=most, least_score=0.2, distinct_iou=iou)
    boxes, scores = table[:, :4], table[:, 4]
    assert best_distinct(boxes, scores, selection) == _written_out(boxes, scores, selection)


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
    nothing = np.zeros((0, 4), np.float32)
    assert best_distinct(nothing, np.zeros(0, np.float32), SelectorSettings()) == []


@given(
    boxes=st.lists(st.tuples(*[st.integers(0, 40)] * 2, *[st.integers(1, 40)] * 2), min_size=2, max_size=2)
)
def test_the_overlap_of_two_boxes_is_that_of_arrays(boxes):
    one, other = boxes
    expected = pairwise_iou(np.array([one]), np.array([other]))[0, 0]
    assert box_iou(one, other) == pytest.approx(expected)
