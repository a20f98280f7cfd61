"""`lightgesture train look`: a larger net in the place of a model's own, or beside them."""

import json
from pathlib import Path

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.models import load_classifier
from lightgesture.models.cnn import CnnClassifier, LargerNet

pytest.importorskip("torch")
QUICK = ("--copies", "1", "--synthetic", "0", "--quiet")


def train(folder: Path, kind: str, out: Path, *more: str) -> int:
    return main(["train", kind, "--data", str(folder), "--out", str(out), *QUICK, *more])


def larger_nets(path: Path) -> tuple[LargerNet, ...]:
    model = load_classifier(str(path))
    assert isinstance(model, CnnClassifier)
    assert model.model.second is not None
    return model.model.second.nets


def is_same(one: LargerNet, other: LargerNet) -> bool:
    return all(
        np.array_equal(own.weights, other.network.weights[name].weights)
        for name, own in one.network.weights.items()
    )


@pytest.mark.slow
def test_a_larger_net_comes_in_the_place_of_another_or_beside_it(folder: Path, tmp_path: Path) -> None:
    net = ("--teachers", "1", "--teacher-steps", "2", "--steps", "1", "--size", "small")
    assert train(folder, "cnn", tmp_path / "one.npz", *net) == 0
    look = ("--first", str(tmp_path / "one.npz"), "--steps", "2", "--seed", "1")
    assert train(folder, "look", tmp_path / "other.npz", *look) == 0
    # The net is the same, so what was learnt of it serves.
    (tmp_path / "other.parts").rename(tmp_path / "both.parts")
    assert train(folder, "look", tmp_path / "both.npz", *look, "--beside") == 0
    ((one,), (other,), both) = (larger_nets(tmp_path / f"{name}.npz") for name in ("one", "other", "both"))
    assert not is_same(one, other)
    assert is_same(both[0], one)
    assert is_same(both[1], other)
    card = json.loads((tmp_path / "both.json").read_text(encoding="utf-8"))
    assert card["training"]["seed"] == 1
    assert [training["seed"] for training in card["trainings_of_the_other_larger_nets"]] == [0]
    assert len(card["model"]["second_look"]["nets"]) == 2


def test_nothing_stays_where_there_is_no_larger_net(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        train(folder, "cnn", tmp_path / "small.npz", "--teachers", "0", "--steps", "1", "--size", "small")
        == 0
    )
    look = ("--first", str(tmp_path / "small.npz"), "--beside")
    assert train(folder, "look", tmp_path / "new.npz", *look) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "small.npz: has 0 larger nets" in line
    assert not (tmp_path / "new.parts").exists()
