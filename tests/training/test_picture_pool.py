"""Composed pictures: the same by however many processes, made once, with the sources that went into each."""

import cv2
import numpy as np
import pytest

from lightgesture.training.pictures import surroundings
from lightgesture.training.pictures.composites import Background
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pool.picture_pool import Ingredients, compose_pool

COUNT = 12
COUNT_OF_PLACES = surroundings.COUNT
"""What other processes draw."""


def a_hand(source):
    alpha = np.zeros((60, 60), np.float32)
    cv2.circle(alpha, (30, 30), 22, 1.0, -1)
    image = np.full((60, 60, 3), (90, 120, 200), np.uint8)
    return Cutout(image, alpha, (8, 8, 45, 45), (30.0, 52.0), "0", source)


@pytest.fixture(name="ingredients", scope="module")
def _ingredients():
    rng = np.random.default_rng(0)
    rooms = [Background(rng.integers(0, 255, (90, 120, 3), np.uint8), "room")]
    waters = [Background(np.full((90, 120, 3), (150, 110, 40), np.uint8), "sea")]
    return Ingredients([a_hand("anna"), a_hand("ben")], waters, rooms, (80, 60))


@pytest.fixture(name="few_places", scope="module")
def _few_places():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(surroundings, "COUNT", 1)
        yield


@pytest.fixture(name="pool", scope="module")
def _pool(few_places, ingredients, tmp_path_factory):
    return compose_pool(ingredients, COUNT, 3, 1, tmp_path_factory.mktemp("pool") / "one.npy")


def assert_same(first, second):
    for one, other in zip(first, second, strict=True):
        np.testing.assert_array_equal(one.image, other.image)
        assert (one.boxes, one.faces, one.sources) == (other.boxes, other.faces, other.sources)


def test_each_picture_names_its_hands_and_background(pool):
    assert len({picture.image.tobytes() for picture in pool}) == COUNT
    for picture in pool:
        assert picture.image.shape == (60, 80, 3)
        assert picture.sources & {"anna", "ben"}
        assert picture.sources <= {"anna", "ben", "room", "sea"}
        assert not picture.all_faces
    assert {"room", "sea"} & frozenset().union(*(picture.sources for picture in pool))
    assert any(picture.boxes for picture in pool)
    assert any(picture.faces for picture in pool)


def test_a_pool_that_is_there_is_used_as_it_is(few_places, ingredients, tmp_path):
    path = tmp_path / "pool.npy"
    first = compose_pool(ingredients, 2, 0, 1, path)
    written = path.stat().st_mtime_ns
    assert_same(first, compose_pool(ingredients, 2, 0, 1, path))
    assert path.stat().st_mtime_ns == written


def test_pictures_without_their_table_are_made_again(few_places, ingredients, tmp_path):
    path = tmp_path / "pool.npy"
    np.save(path, np.zeros((2, 60, 80, 3), np.uint8))
    whole = compose_pool(ingredients, 2, 0, 1, tmp_path / "whole.npy")
    assert_same(whole, compose_pool(ingredients, 2, 0, 1, path))


@pytest.mark.slow
def test_two_processes_compose_what_one_does(ingredients, tmp_path, monkeypatch):
    monkeypatch.setattr(surroundings, "COUNT", COUNT_OF_PLACES)
    alone, shared = (compose_pool(ingredients, COUNT, 3, jobs, tmp_path / f"{jobs}.npy") for jobs in (1, 2))
    assert_same(alone, shared)
