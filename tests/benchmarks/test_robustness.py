"""Tables of bad boxes, cut and covered hands, boxes without a hand, and found hands."""

import numpy as np
import pytest

from lightgesture.benchmarks.reading import robustness
from lightgesture.benchmarks.reading.robustness import (
    box_table,
    find_hands,
    found_table,
    random_table,
    trouble_table,
)
from lightgesture.training.datasets import read_frames, read_hands, read_negatives

CLASSES = ("2", "5", "none")


class Reader:
    """Reads the row that `rule` gives for a picture and a box."""

    classes = CLASSES

    def __init__(self, rule):
        self.rule = rule

    def probabilities(self, image_bgr, boxes, sides):
        return np.array([self.rule(image_bgr, box) for box in boxes], np.float32).reshape(-1, len(CLASSES))


FIVE, TWO, UNSURE, NONE = (0.01, 0.98, 0.01), (0.98, 0.01, 0.01), (0.4, 0.5, 0.1), (0.1, 0.1, 0.8)


def test_points_lost_in_bad_boxes(data):
    """Both hands are read as 5 where the box is exact or moved left; the one that is a 5 is lost elsewhere."""
    samples = read_hands(data)
    x, _, width, _ = samples[0].labels[0].box

    def rule(_image, box):
        return FIVE if box[0] <= x and box[2] == width else TWO

    rows = box_table(Reader(rule), samples[:1], "m").to_dicts()
    assert [(row["error"], row["readings"]) for row in rows] == [
        ("shifted by 10%", 4),
        ("sides × 0.85", 1),
        ("sides × 1.15", 1),
    ]
    assert [row["exact"] for row in rows] == [1.0] * 3
    assert [row["lost"] for row in rows] == [0.25, 1.0, 1.0]
    assert rows[0]["worst_lost"] == 1.0


@pytest.mark.parametrize(
    ("answer", "word"), [(FIVE, "right"), (TWO, "wrong"), (UNSURE, "refused"), (NONE, "refused")]
)
def test_what_is_read_of_hidden_hands(data, answer, word):
    rows = trouble_table(Reader(lambda *_: answer), read_hands(data)[:1], "m").to_dicts()
    assert [(row["trouble"], row["readings"]) for row in rows] == [
        ("25% beyond the edge", 4),
        ("50% beyond the edge", 4),
        ("half covered by skin", 4),
    ]
    for row in rows:
        assert {name: row[name] for name in ("right", "refused", "wrong")} == {
            name: float(name == word) for name in ("right", "refused", "wrong")
        }


def test_the_edge_makes_the_product_doubt(data):
    """0.95 suffices for a whole hand and not for a cut one."""
    reader = Reader(lambda *_: (0.03, 0.95, 0.02))
    words = {row["trouble"]: row for row in trouble_table(reader, read_hands(data)[:1], "m").to_dicts()}
    assert words["25% beyond the edge"]["refused"] == 1.0
    assert words["half covered by skin"]["right"] == 1.0


def test_random_boxes_are_counted_in_all_and_in_unseen_sets(data, monkeypatch):
    samples = read_negatives(data)

    def accepted(seen):
        monkeypatch.setattr(robustness, "SEEN_SETS", seen)
        table = random_table(Reader(lambda _, box: FIVE if box[2] > box[3] else NONE), samples, "m")
        return {row["sets"]: row for row in table.to_dicts()}

    rows = accepted(frozenset())
    assert rows["all"]["boxes"] == rows["unseen"]["boxes"] == 40
    assert rows["all"]["frames"] == 2
    assert 0 < rows["all"]["accepted"] < 40
    assert rows["all"]["share"] == rows["all"]["accepted"] / 40
    assert rows["all"]["as"] == f"5 ({rows['all']['accepted']})"
    assert accepted(frozenset()) == rows
    assert set(accepted(frozenset({"reef"}))) == {"all"}


def test_found_hands_are_read_in_the_found_boxes(data, fake_method):
    """Of four labelled tokens at image left or right, the left ones are found."""
    found = find_hands(fake_method.read, read_frames(data))
    (row,) = found_table(Reader(lambda *_: FIVE), found, "m").to_dicts()
    assert row["source"] == "lab"
    assert (row["hands"], row["found"], row["right"], row["read"], row["read_wrong"]) == (4, 3, 1, 1, 2)
    (row,) = found_table(Reader(lambda *_: UNSURE), found, "m").to_dicts()
    assert (row["right"], row["read"], row["read_wrong"]) == (1, 0, 0)
