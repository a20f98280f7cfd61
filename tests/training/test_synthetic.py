"""Rendered hands as training samples: all tokens, never originals, the same for the same seed."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.training.pictures.augment import AugmentSettings
from lightgesture.training.pool import patch_kinds
from lightgesture.training.pool.patch_kinds import rendered_hands


@pytest.fixture(autouse=True)
def _few_backdrops(monkeypatch):
    monkeypatch.setattr(patch_kinds, "CROPS", replace(patch_kinds.CROPS, backdrops=1))


def _samples(seed, count=12):
    return list(rendered_hands(count, seed, AugmentSettings()))


def test_rendered_hands_hold_all_tokens_and_are_never_originals():
    samples = _samples(3, 24)
    assert {sample.token for sample in samples} >= {"0", "5", "left", "right", "pic", "ok"}
    assert not any(sample.original for sample in samples)
    assert len({sample.source for sample in samples}) == 24
    for sample in samples:
        x, y, width, height = sample.box
        rows, columns = sample.image.shape[:2]
        assert x < columns
        assert y < rows
        assert x + width > 0
        assert y + height > 0


def test_nothing_to_train_on_is_refused_in_one_line(capsys):
    assert main(["train", "svm"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_same_seed_renders_the_same_pixels():
    for first, second in zip(_samples(8, 6), _samples(8, 6), strict=True):
        np.testing.assert_array_equal(first.image, second.image)
        assert (first.box, first.token) == (second.box, second.token)


def test_none_asked_for_is_none_given():
    assert _samples(1, 0) == []
