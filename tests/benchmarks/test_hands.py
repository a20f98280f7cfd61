"""The classifier in given boxes."""

import pytest

from lightgesture.benchmarks.reading.hands import (
    by_source_table,
    by_token_table,
    classify,
    confusion_table,
    summary_table,
)
from lightgesture.errors import InputError
from lightgesture.training.datasets import read_frames, read_hands


def test_boxes_and_sides_reach_the_classifier(data, fake_classifier):
    classify(fake_classifier, read_frames(data))
    assert fake_classifier.calls[0] == ((120, 160, 3), [(20, 30, 31, 41)], ["right"])
    assert fake_classifier.calls[1][2] == ["right", "left"]


def test_hands_without_a_known_token_are_not_asked(data, fake_classifier):
    assert len(classify(fake_classifier, read_frames(data))) == 4


def test_summary_over_tokens_and_none(data, fake_classifier):
    answers = classify(fake_classifier, read_hands(data))
    sure = [answer for answer in answers if not answer.sample.doubtful]
    first, second = summary_table([("all", answers), ("sure", sure), ("empty", [])], "m").to_dicts()
    assert (first["hands"], first["right"], first["accuracy"]) == (2, 1, 0.5)
    assert (first["macro_token"], first["worst_token"], first["worst_accuracy"]) == (0.5, "2", 0.0)
    assert (first["none_hands"], first["none_auroc"], first["none_refused"]) == (1, 0.5, 0.0)
    assert first["low_95"] < 0.5 < first["high_95"]
    assert (second["part"], second["accuracy"]) == ("sure", 1.0)


def test_argmax_over_tokens_ignores_none(data, fake_classifier):
    class Refuser(type(fake_classifier)):
        def probabilities(self, image_bgr, boxes, sides):
            return super().probabilities(image_bgr, [(0, 0, 9, 9)] * len(boxes), sides)

    answers = classify(Refuser(), read_hands(data))
    assert {answer.token for answer in answers} == {"5"}
    (row,) = summary_table([("all", answers)], "m").to_dicts()
    assert (row["none_refused"], row["tokens_refused"]) == (1.0, 1.0)


def test_model_without_none_has_no_auroc(data, fake_classifier):
    class TenTokens(type(fake_classifier)):
        classes = ("2", "5")

        def probabilities(self, image_bgr, boxes, sides):
            return super().probabilities(image_bgr, boxes, sides)[:, :2]

    (row,) = summary_table([("all", classify(TenTokens(), read_hands(data)))], "m").to_dicts()
    assert (row["accuracy"], row["none_auroc"]) == (0.5, None)


def test_tables_per_token_source_and_pair(data, fake_classifier):
    answers = classify(fake_classifier, [*read_hands(data), *read_frames(data)])
    tokens = {row["token"]: (row["hands"], row["right"]) for row in by_token_table(answers, "m").to_dicts()}
    assert tokens == {"1": (1, 0), "2": (1, 0), "5": (3, 3), "ok": (1, 0)}
    mistaken = [row["mistaken_for"] for row in by_token_table(answers, "m").to_dicts()]
    assert mistaken == ["5 (1)", "5 (1)", "", "5 (1)"]
    sources = [(row["source"], row["accuracy"]) for row in by_source_table(answers, "m").to_dicts()]
    assert sources == [("lab", 0.5), ("anna", 0.5)]
    rows = {row["truth"]: row["5"] for row in confusion_table(answers, "m").to_dicts()}
    assert rows == {"1": 1, "2": 1, "5": 3, "ok": 1}


@pytest.mark.parametrize("index", [0, 1])
def test_failure_is_a_token_read_as_another(data, fake_classifier, index):
    assert classify(fake_classifier, read_hands(data))[index].failed is (index == 1)


def test_broken_picture_is_named_in_one_line(data, fake_classifier):
    """A figure over fewer pictures than the table names would be another figure, so nothing is skipped."""
    samples = read_hands(data)
    samples[1].path.write_bytes(b"no picture")
    with pytest.raises(InputError, match=r"2\.png: is no picture") as error:
        classify(fake_classifier, samples)
    assert "\n" not in str(error.value)
