"""What a training leaves out, and its way through a card."""

import json

import pytest

from lightgesture.errors import InputError
from lightgesture.training.datasets import fold_of
from lightgesture.training.pool.left_out import CARD_KEY, LeftOut, left_out, read_left_out

NAMES = [f"somebody/project {number}" for number in range(200)]


def test_every_source_is_left_out_by_one_fold_alone():
    folds = [left_out(fold=f"{number}/5") for number in range(1, 6)]
    assert all(sum(fold.covers(name) for fold in folds) == 1 for name in NAMES)
    assert all(fold.covers(name) for name in NAMES for fold in folds if fold_of(name, 5) == fold.fold - 1)
    assert all(25 <= sum(fold.covers(name) for name in NAMES) <= 55 for fold in folds)


def test_named_sources_are_left_out_besides_the_fold():
    both = left_out(["subhi"], "1/2")
    assert both.covers("subhi")
    assert {name for name in NAMES if both.covers(name)} == {name for name in NAMES if fold_of(name, 2) == 0}
    assert not left_out(["subhi"]).covers("drone")


@pytest.mark.parametrize("fold", ["", "2", "0/5", "6/5", "1/0", "a/5", "1/5/2", "-1/5"])
def test_what_is_no_fold_is_refused(fold):
    with pytest.raises(ValueError, match="is no fold"):
        left_out(fold=fold)


@pytest.mark.parametrize("what", [LeftOut(), left_out(["b", "a"]), left_out(["a"], "3/7")])
def test_a_card_keeps_what_was_left_out(tmp_path, what):
    card = {"model": "a selector", CARD_KEY: what.to_card()}
    (tmp_path / "fold.json").write_text(json.dumps(card), encoding="utf-8")
    assert read_left_out(tmp_path / "fold.npz") == what


@pytest.mark.parametrize(
    "content",
    [
        *(None, "{", "[]", "{}", "[" * 100_000, '{"left_out": ["a"]}'),
        *('{"left_out": {"sources": [], "fold": "9/5"}}', '{"left_out": {"sources": [], "fold": []}}'),
        '{"left_out": {"sources": "abc", "fold": null}}',
    ],
)
def test_a_card_that_does_not_say_it_is_refused_by_name(tmp_path, content):
    if content is not None:
        (tmp_path / "fold.json").write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=r"fold\.json: .*--without or --fold"):
        read_left_out(tmp_path / "fold.npz")
