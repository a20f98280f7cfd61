"""Folds of real dives: each is seen once, by nets that learnt from all others and not from it."""

import json

import numpy as np
import pytest

from lightgesture.features.find.selector_file import load_learned
from lightgesture.training.model_files import write_networks
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.real_divers import RealDiver
from lightgesture.training.regions import dive_folds as module
from lightgesture.training.regions.card import DIVERS_KEY, has_seen_dives
from lightgesture.training.regions.dive_folds import dive_folds, shortened
from lightgesture.training.regions.nets import LOCATOR, NETS, REFINER, RegionTraining, learn_nets
from lightgesture.training.regions.region_pictures import Material

DIVES = [f"divers dive {number}" for number in range(12)]


def _diver(dive):
    picture = BoxedPicture(np.zeros((8, 8, 3), np.uint8), ((1, 1, 4, 4),), sources=frozenset({dive}))
    return RealDiver(picture, shows_sign=False)


def _names(pictures):
    return {source for picture in pictures for source in picture.sources}


@pytest.fixture(name="folds")
def _folds(monkeypatch, tmp_path):
    """Of each fold: the dives that its nets learnt from, and those that they had not."""

    def learn(material, _composed, folder, _seed, _settings, _progress):
        assert folder.is_dir()
        return _names(one.picture for one in material.divers)

    monkeypatch.setattr(module, "learn_nets", learn)
    material = Material([], [], [], [_diver(dive) for dive in DIVES for _ in range(2)])
    found = dive_folds(material, [], tmp_path, 0, RegionTraining(dive_folds=3), lambda _: None)
    return [(fold.nets, fold.pictures) for fold in found]


def test_no_net_has_learnt_from_the_dives_of_its_fold(folds):
    for learnt, apart in folds:
        assert learnt | _names(apart) == set(DIVES)
        assert not learnt & _names(apart)


def test_every_picture_is_in_one_fold(folds):
    assert sum(len(apart) for _, apart in folds) == 2 * len(DIVES)


def test_nets_that_lie_in_their_folder_are_not_trained_again(tmp_path):
    parts = load_learned()
    write_networks({LOCATOR: parts.locator, REFINER: parts.refiner}, tmp_path / NETS)
    locator, refiner = learn_nets(Material([], [], [], []), [], tmp_path, 0, RegionTraining(), lambda _: None)
    assert (locator.nodes, refiner.nodes) == (parts.locator.nodes, parts.refiner.nodes)
    assert all(
        np.array_equal(own.weights, parts.locator.weights[name].weights)
        for name, own in locator.weights.items()
    )


def test_the_nets_of_a_fold_learn_a_third_as_long():
    short = shortened(RegionTraining(locator_steps=3000, refiner_steps=1))
    assert (short.locator_steps, short.refiner_steps) == (1000, 1)


@pytest.mark.parametrize(("count", "expected"), [(1018, True), (0, False), (None, False)])
def test_the_card_beside_a_start_tells_whether_it_has_seen_dives(tmp_path, count, expected):
    card = {"data": {} if count is None else {DIVERS_KEY: count}}
    (tmp_path / "start.json").write_text(json.dumps(card), encoding="utf-8")
    assert has_seen_dives(tmp_path / "start.npz") is expected


def test_without_a_card_or_a_start_nothing_is_known_of_dives(tmp_path):
    assert not has_seen_dives(None)
    assert not has_seen_dives(tmp_path / "start.npz")
