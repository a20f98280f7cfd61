"""Reliability of probabilities."""

import numpy as np
import pytest

from lightgesture.benchmarks.reading.hands import HandAnswer
from lightgesture.benchmarks.reading.reliability import calibration_error, reliability_bins, reliability_table
from lightgesture.training.datasets import Label, Sample

CLASSES = ("2", "5", "none")


def answer(truth, *probabilities):
    label = Label((0, 0, 9, 9), "left", truth)
    return HandAnswer(Sample("a.png", (label,), "s", "s"), label, CLASSES, np.float32(probabilities))


ANSWERS = [
    answer("5", 0.05, 0.95, 0.0),
    answer("2", 0.03, 0.97, 0.0),
    answer("none", 0.2, 0.2, 0.6),
    answer("2", 1.0, 0.0, 0.0),
]


def test_bins_hold_confidence_and_right_answers():
    unsure, sure = reliability_bins(ANSWERS)
    assert (unsure.hands, unsure.right) == (1, 1.0)
    assert unsure.confidence == pytest.approx(0.6)
    assert (sure.hands, sure.right) == (3, pytest.approx(2 / 3))
    assert sure.confidence == pytest.approx((0.95 + 0.97 + 1.0) / 3)
    expected = (0.4 + 3 * abs(sure.confidence - 2 / 3)) / 4
    assert calibration_error([unsure, sure]) == pytest.approx(expected)


def test_no_hands_have_no_error():
    assert reliability_bins([]) == []
    assert calibration_error([]) is None


def test_table_ends_with_all_hands():
    rows = reliability_table(ANSWERS, "m").to_dicts()
    assert [(row["bin"], row["hands"]) for row in rows] == [("0.60", 1), ("0.97", 3), ("all", 4)]
    assert rows[0]["gap"] == pytest.approx(-0.4, abs=1e-6)
    assert rows[-1]["gap"] == pytest.approx(calibration_error(reliability_bins(ANSWERS)), abs=1e-6)
