"""Cards: what is kept and what is wrong at each threshold, and what both cost."""

from pathlib import Path

import numpy as np
import pytest

from lightgesture.training.card import COST_OF_WRONG, FEW, held_out_section, limits, operating_points
from lightgesture.training.pool.kept_sources import HeldOut
from lightgesture.training.pool.samples import HandRow

CLASSES = ("1", "5", "none")


def held_out():
    """Of four tokens two are right, surely and hardly, one wrong, one taken for none; a none taken for a token."""
    rows = [[0.97, 0.02, 0.01], [0.3, 0.55, 0.15], [0.1, 0.85, 0.05], [0.2, 0.2, 0.6], [0.75, 0.05, 0.2]]
    return HeldOut(
        np.array(rows, np.float32),
        np.array([0, 1, 0, 1, 2]),
        np.array(["a", "a", "b", "b", "b"]),
        np.ones(5, bool),
    )


def test_operating_points_count_what_is_kept_and_what_is_wrong():
    points = {point["threshold"]: point for point in operating_points(held_out(), CLASSES)}
    assert points[0.5]["tokens_read_rightly"] == 0.5
    assert points[0.7]["tokens_read_rightly"] == 0.25
    assert points[0.5]["hands_read_wrongly"] == 0.4
    assert points[0.8]["hands_read_wrongly"] == 0.2
    assert points[0.9]["hands_read_wrongly"] == 0.0
    assert points[0.7]["none_read_as_a_token"] == 1.0
    assert points[0.8]["none_read_as_a_token"] == 0.0
    # Refused at 0.5: the one taken for none. At 0.9: all but the sure one.
    assert points[0.5]["cost"] == pytest.approx((1 + 2 * COST_OF_WRONG) / 5)
    assert points[0.9]["cost"] == pytest.approx(3 / 5)


def test_held_out_scores_leave_none_aside():
    section = held_out_section([], held_out(), CLASSES)
    assert section["accuracy"] == 0.5
    assert section["accuracy_of_altered_copies"] is None
    assert section["per_class"] == {"1": 0.5, "5": 0.5}
    assert section["per_source"]["b"] == {"accuracy": 0.0, "pictures": 2}
    assert section["none_auroc"] == 0.75


def rows_of(token, sources, count=FEW):
    return [HandRow(Path("a.png"), token, source, licence="MIT") for source in sources for _ in range(count)]


def answers(count, source):
    """Right ones for hands of one source."""
    return HeldOut(
        np.tile(np.array([[0.9, 0.1]], np.float32), (count, 1)),
        np.zeros(count, int),
        np.array([source] * count),
        np.ones(count, bool),
    )


def test_a_training_that_lacks_nothing_has_no_limits():
    rows = rows_of("up", "abc") + rows_of("none", "abc")
    assert limits(rows, answers(2 * FEW, "c"), ("up", "none")) == []


def test_limits_say_what_this_training_could_not_learn():
    rows = [*rows_of("up", "ab", 3), *rows_of("down", "b"), HandRow(Path("b.png"), "down", "b")]
    lines = limits(rows, answers(5, "b"), ("up", "down"))
    for number, words in enumerate(
        [
            "classes whose pictures come from one source: down (b)",
            "classes of few pictures: up (6)",
            "no source was held out",
            "probabilities are not calibrated: 5 hands",
            "there is no class none",
            f"1 of {FEW + 7} pictures state no licence",
        ]
    ):
        assert lines[number].startswith(words)
    assert len(lines) == 6
    assert any("no hand was held out" in line for line in limits(rows, answers(0, "b"), ("up", "down")))
