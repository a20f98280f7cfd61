"""Pictures of errors, confusions and reliability."""

import numpy as np
import pytest

from lightgesture.benchmarks.reading.hands import classify
from lightgesture.benchmarks.reading.pictures import (
    CELL,
    MARGIN,
    PLOT,
    confusion_picture,
    error_sheet,
    reliability_diagram,
)
from lightgesture.training.datasets import read_hands


@pytest.fixture
def answers(data, fake_classifier):
    """A 5 read as 5, a doubtful 2 read as 5, a `none` read as 5, each with 0.6."""
    return classify(fake_classifier, read_hands(data))


def test_every_error_gets_a_tile_with_its_two_likeliest_tokens(answers):
    assert [(name, round(value, 1)) for name, value in answers[1].likeliest_tokens(2)] == [
        ("5", 0.6),
        ("2", 0.1),
    ]
    sheet = error_sheet(answers)
    assert sheet.shape == (150 + 2 * 14 + 4, 1600, 3)
    assert sheet[:150, :160].any()
    assert sheet[152:, :160].any()
    assert not sheet[:, 160:].any()


def test_all_errors_are_shown(answers):
    sheet = error_sheet([answers[1]] * 123)
    assert sheet.shape[0] == 13 * 182
    assert sheet[12 * 182 :, : 3 * 160].any()


def test_no_errors_no_sheet(answers):
    assert error_sheet([answers[0]]) is None


def test_reliability_draws_a_point_where_it_is(answers):
    image = reliability_diagram({"m": answers})
    # Confidence 0.6, one answer of three right.
    point = MARGIN + round(0.6 * PLOT), MARGIN + round(PLOT * (1 - 1 / 3))
    assert image[point[1], point[0]].tolist() == [180, 90, 20]
    assert image[MARGIN + 50, MARGIN + 10].tolist() == [255, 255, 255]


def test_confusions_stand_side_by_side_and_count_none(answers):
    one = confusion_picture({"m": answers})
    both = confusion_picture({"m": answers, "n": answers})
    assert one.shape == (3 * CELL + MARGIN + 16, 3 * CELL + MARGIN + 16, 3)
    assert both.shape[1] == 2 * one.shape[1]
    right, wrong = one[MARGIN + CELL + 4, MARGIN + CELL + 4], one[MARGIN + 4, MARGIN + CELL + 4]
    assert right.tolist() == [150, 70, 20]
    assert wrong.tolist() == [60, 60, 220]
    np.testing.assert_array_equal(one[MARGIN + 4, MARGIN + 4], [255, 255, 255])
