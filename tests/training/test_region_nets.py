"""The nets of a selector among the parts of its training."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.features.find.selector_file import load_classical, load_learned
from lightgesture.training.model_files import write_networks, write_selector
from lightgesture.training.nets.checkpoints import sha256_of
from lightgesture.training.regions import learned, train
from lightgesture.training.regions.card import MODEL
from lightgesture.training.regions.learned import Pictures
from lightgesture.training.regions.nets import LOCATOR, NETS, REFINER, RegionTraining, learn_nets
from lightgesture.training.regions.region_pictures import Material


def test_nets_that_lie_in_their_folder_are_not_trained_again(tmp_path):
    parts = load_learned()
    write_networks({LOCATOR: parts.locator, REFINER: parts.refiner}, tmp_path / NETS)
    locator, refiner = learn_nets(Material([], [], [], []), [], tmp_path, 0, RegionTraining(), lambda _: None)
    assert (locator.nodes, refiner.nodes) == (parts.locator.nodes, parts.refiner.nodes)
    assert all(
        np.array_equal(own.weights, parts.locator.weights[name].weights)
        for name, own in locator.weights.items()
    )


def test_the_learned_choice_can_be_trained_alone(tmp_path, monkeypatch):
    pytest.importorskip("torch")
    marked = replace(load_classical(), pairs=replace(load_classical().pairs, base=0.25))
    write_selector(marked, load_learned(), tmp_path / "start.npz")
    nothing = Pictures(Material([], [], [], []), Material([], [], [], []), [], [])
    monkeypatch.setattr(train, "read_pictures", lambda *_: nothing)
    monkeypatch.setattr(train, "learn_choice", lambda *_: load_learned())
    settings = RegionTraining(start=tmp_path / "start.npz")
    train.train_regions(tmp_path, tmp_path / "new.npz", settings=settings, keeps_classical=True)
    assert load_classical(tmp_path / "new.npz").pairs.base == 0.25
    card = json.loads((tmp_path / "new.json").read_text())
    assert card["classical_trees"] == "of that selector"
    assert card["nets_went_on_from_the_selector_of_sha256"] == settings.start_digest()
    assert isinstance(card["seconds"], int)


def test_the_verifier_can_be_trained_alone(tmp_path, monkeypatch):
    pytest.importorskip("torch")
    known = load_learned()
    write_selector(load_classical(), replace(known, verifier=None), tmp_path / "start.npz")
    (tmp_path / "start.json").write_text('{"seed": 7}')
    nothing = Pictures(Material([], [], [], []), Material([], [], [], []), [], [])
    monkeypatch.setattr(train, "read_pictures", lambda *_: nothing)
    monkeypatch.setattr(learned, "learn_verifier", lambda *_: known.verifier)
    monkeypatch.setattr(learned, "fit_place_pairs", lambda _, scorer, seed: known.pairs)
    train.train_verifier(tmp_path, tmp_path / "new.npz", tmp_path / "start.npz")
    made = load_learned(tmp_path / "new.npz")
    assert made.verifier is not None
    assert made.verifier.nodes == known.verifier.nodes
    assert made.places.base == known.places.base
    card = json.loads((tmp_path / "new.json").read_text())
    assert card["seed"] == 7
    assert card["model"] == MODEL
    assert card["verifier"]["steps"] == RegionTraining().verifier_steps
    assert card["verifier"]["beside_the_selector_of_sha256"] == sha256_of(tmp_path / "start.npz")
    assert isinstance(card["verifier"]["seconds"], int)


@pytest.mark.parametrize("alone", [[], ["--verifier", "--start", "bundled"]])
def test_a_reader_that_nothing_can_learn_on_from_is_refused_before_anything_is_done(
    alone, tmp_path, monkeypatch, capsys
):
    pytest.importorskip("torch")
    monkeypatch.setattr(train, "read_pictures", lambda *_: pytest.fail("pictures were read"))
    command = ["train", "regions", "--data", str(tmp_path), "--out", str(tmp_path / "a.npz"), *alone]
    for reader, reason in (("svm", "has no larger net"), (str(tmp_path / "nosuch.npz"), "No such file")):
        assert main([*command, "--reader", reader]) == 2
        line = capsys.readouterr().err.strip()
        assert line.count("\n") == 0
        assert reader in line
        assert reason in line


@pytest.mark.parametrize("option", ["--learned", "--classical", "--verifier"])
def test_what_keeps_a_part_of_another_file_must_name_it(option, tmp_path, capsys):
    assert main(["train", "regions", "--data", str(tmp_path), "--out", str(tmp_path / "a.npz"), option]) == 2
    assert f"{option} keeps the" in capsys.readouterr().err
