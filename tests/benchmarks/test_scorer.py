"""The arithmetic that every figure rests on."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightgesture.benchmarks.scorer import (
    NOT_READ,
    Reading,
    Score,
    Tally,
    accuracy_by,
    auroc,
    confusion,
    iou,
    macro_average,
    match_boxes,
    percentile,
    score_frame,
    total,
    wilson_interval,
    worst,
)
from lightgesture.training.datasets import Label

boxes = st.tuples(*[st.integers(-50, 50)] * 2, *[st.integers(1, 60)] * 2)


def test_iou_of_half_overlapping_boxes_is_a_third():
    assert iou((0, 0, 10, 10), (5, 0, 10, 10)) == pytest.approx(1 / 3)


def test_iou_is_zero_for_touching_and_empty_boxes():
    assert iou((0, 0, 10, 10), (10, 0, 10, 10)) == 0.0
    assert iou((0, 0, 0, 10), (0, 0, 10, 10)) == 0.0


@given(boxes, boxes)
def test_iou_is_symmetric_bounded_and_one_only_for_equal_boxes(first, second):
    value = iou(first, second)
    assert value == iou(second, first)
    assert 0.0 <= value <= 1.0
    assert (value == 1.0) == (first == second)


def test_matching_prefers_two_matches_to_one_better_one():
    """A greedy choice would give the middle box to the left label and lose the right one."""
    labels = [(0, 0, 10, 10), (4, 0, 10, 10)]
    middle, left = (1, 0, 10, 10), (-3, 0, 10, 10)
    assert iou(middle, labels[0]) > iou(left, labels[0])
    assert [match[:2] for match in match_boxes([middle, left], labels)] == [(1, 0), (0, 1)]


@given(st.lists(boxes, max_size=2), st.lists(boxes, max_size=4))
def test_matches_are_one_to_one_and_reach_the_threshold(given_boxes, labels):
    matches = match_boxes(given_boxes, labels)
    rows = [match[0] for match in matches]
    columns = [match[1] for match in matches]
    assert len(set(rows)) == len(rows)
    assert columns == sorted(set(columns))
    assert all(overlap >= 0.5 for *_, overlap in matches)


def test_threshold_is_inclusive():
    assert match_boxes([(0, 0, 10, 10)], [(0, 0, 10, 20)], threshold=0.5) == [(0, 0, 0.5)]


LEFT = Label((100, 0, 20, 20), "left", "5")
RIGHT = Label((0, 0, 20, 20), "right", "ok")


def test_both_hands_read():
    score = score_frame([LEFT, RIGHT], [Reading(LEFT.box, "left", "5"), Reading(RIGHT.box, "right", "ok")])
    assert score == Score(
        frames=1,
        hands=2,
        found=2,
        sides=2,
        sides_right=2,
        tokens=2,
        read=2,
        pairs=1,
        both=1,
        iou_sum=2.0,
    )


def test_refused_token_is_neither_read_nor_wrong():
    score = score_frame([LEFT], [Reading(LEFT.box, "left", None)])
    assert (score.found, score.read, score.wrong) == (1, 0, 0)


def test_wrong_token_and_swapped_side():
    score = score_frame([LEFT], [Reading(LEFT.box, "right", "4")])
    assert (score.read, score.wrong, score.sides, score.sides_right) == (0, 1, 1, 0)


def test_token_on_another_hand_shape_is_wrong_but_no_token_is_counted():
    score = score_frame([Label((0, 0, 9, 9), None, "none")], [Reading((0, 0, 9, 9), "left", "2")])
    assert (score.hands, score.found, score.tokens, score.wrong, score.sides) == (1, 1, 0, 1, 0)


def test_unscored_shape_counts_as_a_hand_to_find_only():
    pair = [LEFT, Label(RIGHT.box, "right", None)]
    score = score_frame(pair, [Reading(LEFT.box, "left", "5"), Reading(RIGHT.box, "right", "1")])
    assert (score.found, score.tokens, score.read, score.wrong) == (2, 1, 1, 0)
    assert (score.pairs, score.both) == (0, 0)


@pytest.mark.parametrize(("complete", "extra"), [(True, 1), (False, 0)])
def test_box_on_nothing_is_extra_only_where_all_hands_are_labelled(complete, extra):
    readings = [Reading(LEFT.box, "left", "5"), Reading((300, 300, 9, 9), "right", "5")]
    assert score_frame([LEFT], readings, complete).extra == extra


def test_scores_add_up():
    found = score_frame([LEFT], [Reading(LEFT.box, "left", "5")])
    missed = score_frame([LEFT], [])
    both = total([found, missed])
    assert (both.frames, both.hands, both.found, both.mean_iou) == (2, 2, 1, 1.0)
    assert total([]).mean_iou is None


def test_accuracy_per_key_macro_and_worst():
    tallies = accuracy_by(["a", "a", "b", "b"], ["1", "2", "1", "2"], ["1", "2", "1", None])
    assert tallies == {"a": Tally(2, 2), "b": Tally(1, 2)}
    assert macro_average(tallies) == pytest.approx(0.75)
    assert worst(tallies) == ("b", Tally(1, 2))
    assert macro_average({}) is None
    assert worst({}) is None


def test_macro_average_weighs_keys_alike():
    assert macro_average({"many": Tally(100, 100), "few": Tally(0, 1)}) == pytest.approx(0.5)


def test_confusion_counts_a_missing_answer_in_its_own_column():
    assert confusion(["1", "1"], ["2", None]) == {("1", "2"): 1, ("1", NOT_READ): 1}


def test_wilson_interval_against_published_values():
    """Newcombe, Statistics in Medicine 17 (1998), table I, method 3."""
    assert wilson_interval(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert wilson_interval(15, 148) == pytest.approx((0.0624, 0.1605), abs=5e-5)
    assert wilson_interval(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)
    assert wilson_interval(0, 0) == (0.0, 1.0)


@given(st.lists(st.integers(0, 5), min_size=1), st.lists(st.integers(0, 5), min_size=1))
def test_auroc_is_the_share_of_ordered_pairs(positive, negative):
    ordered = sum((p > n) + 0.5 * (p == n) for p in positive for n in negative)
    assert auroc(positive, negative) == pytest.approx(ordered / (len(positive) * len(negative)))


def test_auroc_needs_both_kinds():
    assert auroc([], [1.0]) is None
    assert auroc([1.0], []) is None


def test_percentile_interpolates():
    assert percentile([4.0, 1.0, 3.0, 2.0], 50) == pytest.approx(2.5)
    assert percentile([7.0], 95) == 7.0
    assert math.isclose(percentile(list(range(101)), 95), 95.0)
