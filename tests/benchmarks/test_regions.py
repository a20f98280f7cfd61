"""Methods over groups of frames, with a method whose answers are known."""

from dataclasses import replace

import pytest

from lightgesture.benchmarks.finding.region_tables import (
    instructions_table,
    negatives_table,
    regions_table,
    tokens_table,
)
from lightgesture.benchmarks.finding.regions import run_methods
from lightgesture.training.datasets import read_frames, read_negatives


def show_nothing(samples, _heading):
    return samples


@pytest.fixture
def runs(data, fake_method):
    return run_methods([fake_method], read_frames(data), show_nothing)


def test_sequences_are_read_alone_and_in_order(runs, fake_method):
    assert [(run.group, run.mode) for run in runs] == [
        ("hover", "single"),
        ("hover", "sequence"),
        ("tank", "single"),
    ]
    assert fake_method.holds == [3]
    assert fake_method.times == pytest.approx([0.0, 1 / 30])


def test_rows_of_the_regions_table(runs):
    hover, sequence, tank = regions_table(runs).to_dicts()
    assert {name: hover[name] for name in ("frames", "hands", "found", "tokens", "read", "wrong")} == {
        "frames": 2,
        "hands": 4,
        "found": 2,
        "tokens": 3,
        "read": 1,
        "wrong": 1,
    }
    assert (hover["found_share"], hover["mean_iou"]) == (0.5, 1.0)
    assert (hover["pairs"], hover["both"], hover["both_share"]) == (1, 0, 0.0)
    assert (hover["side_share"], hover["extra"]) == (1.0, 0)
    assert {**sequence, "mode": "single"} == hover
    assert (tank["found"], tank["read"], tank["wrong"], tank["both_share"]) == (1, 0, 1, None)


def test_tokens_are_counted_per_group_in_single_frames(runs):
    rows = [tuple(row.values())[1:6] for row in tokens_table(runs, "fake").to_dicts()]
    assert rows == [("hover", "5", 2, 1, 1), ("hover", "ok", 1, 1, 0), ("tank", "1", 1, 1, 0)]
    assert tokens_table(runs, "another").rows == ()


def test_instruction_of_a_signed_sequence(runs):
    (row,) = instructions_table(runs).to_dicts()
    assert (row["sequence"], row["hold"], row["issued"], row["right"]) == ("hover", 3, "STOP HOVER GO", "yes")
    assert row["words"] == "STOP, HOVER"


def test_failures_are_missed_hands_and_wrong_tokens(runs):
    assert [answer.failed for run in runs for answer in run.answers] == [True] * 5


def test_negatives_count_frames_and_sum_them_up(data, fake_method):
    class Guesser(type(fake_method)):
        """Sees a pair in every frame, and a third box that does not count."""

        def read(self, image):
            hand = super().read(image + 1)[0]
            return [hand] * 3

    runs = run_methods([fake_method, Guesser()], read_negatives(data), show_nothing)
    rows = [tuple(row.values())[1:3] + tuple(row.values())[4:] for row in negatives_table(runs).to_dicts()]
    assert rows == [
        ("fake", "reef_1", "single", 2, 0, 0, 0, None, None),
        ("fake", "reef_1", "sequence", 2, 0, 0, 0, 2, 1),
        ("fake", "reef_1", "single", 2, 2, 2, 2, None, None),
        ("fake", "reef_1", "sequence", 2, 2, 2, 2, 2, 1),
        ("fake", "all", "single", 4, 2, 2, 2, None, None),
    ]
    assert [answer.failed for answer in runs[0].answers] == [False, False]
    assert runs[-1].answers[0].failed


def test_rows_tell_what_the_models_were_trained_on(data, fake_method):
    samples = [replace(sample, group="rov25_reef", order=None) for sample in read_negatives(data)]
    runs = run_methods([fake_method], [*samples, *read_negatives(data)], show_nothing)
    seen = {row["group"]: row["seen"] for row in negatives_table(runs).to_dicts()}
    assert seen == {"rov25_reef": "pictures", "reef_1": "no", "all": None}
