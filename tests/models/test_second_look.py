"""The second look: asked about what the small net doubts and about nothing else, kept in the file, bounded."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.patch import cut_patches
from lightgesture.models import ModelError
from lightgesture.models.archive import read_model
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import (
    MOST_DOUBTED,
    SECOND_WEIGHT,
    CnnClassifier,
    LargerNet,
    SecondLook,
    most_doubted,
)
from lightgesture.models.cnn_file import cnn_model_from
from lightgesture.training.model_files import write_cnn_model
from tests.models.test_cnn import random_model

BOXES = [(10 * number, 5 * number, 60, 70) for number in range(6)]
SIDES = ["left"] * len(BOXES)


TEMPERATURES = 1.3, 0.7


def with_second(sure, nets=2):
    model = random_model(3, has_outline=False)
    larger = (
        LargerNet(random_model(4 + number, has_outline=False).network, temperature)
        for number, temperature in enumerate(TEMPERATURES[:nets])
    )
    return replace(model, second=SecondLook(tuple(larger), sure))


def read(model):
    image = np.random.default_rng(0).integers(0, 256, (240, 320, 3)).astype(np.uint8)
    return image, CnnClassifier(model, "numpy").probabilities(image, BOXES, SIDES)


def test_a_sure_small_net_is_not_asked_again():
    alone = read(replace(with_second(0.0), second=None))[1]
    np.testing.assert_array_equal(read(with_second(0.0))[1], alone)


@pytest.mark.parametrize("nets", [1, 2])
def test_the_most_doubted_are_weighed_and_no_others(nets):
    model = with_second(1.0, nets)
    image, both = read(model)
    first = read(replace(model, second=None))[1]
    patches = cut_patches(image, BOXES, SIDES, model.patch)
    alone = [replace(model, network=net.network, second=None) for net in model.second.nets]
    scores = [CnnClassifier(one, "numpy").scores(patches) for one in alone]
    second = sum(softmax(own, temperature) for own, temperature in zip(scores, TEMPERATURES, strict=False))
    second = second / nets
    asked = np.argsort(first.max(axis=1), kind="stable")[:MOST_DOUBTED]
    wanted = first.copy()
    wanted[asked] += SECOND_WEIGHT * (second[asked] - first[asked])
    np.testing.assert_allclose(both, wanted, atol=1e-6)
    np.testing.assert_allclose(both.sum(axis=1), 1.0, atol=1e-5)
    assert not np.allclose(both[asked], first[asked])


def test_doubt_ends_at_the_bound():
    rows = np.array([[0.9, 0.1], [0.5, 0.5], [0.89, 0.11]], np.float32)
    assert most_doubted(rows, 0.9).tolist() == [1, 2]


def test_the_file_keeps_it(tmp_path):
    model = with_second(0.8)
    write_cnn_model(model, tmp_path / "m.npz")
    back = cnn_model_from(tmp_path / "m.npz", *read_model(tmp_path / "m.npz"))
    assert back.second is not None
    assert ([net.temperature for net in back.second.nets], back.second.sure) == ([1.3, 0.7], 0.8)
    np.testing.assert_array_equal(read(back)[1], read(model)[1])


def test_a_file_of_before_with_one_is_read(tmp_path):
    model = with_second(0.8, nets=1)
    write_cnn_model(model, tmp_path / "m.npz")
    header, arrays = read_model(tmp_path / "m.npz")
    header |= {"format": 2, "second": {"temperature": 1.3, "sure": 0.8}}
    back = cnn_model_from(tmp_path / "m.npz", header, arrays)
    np.testing.assert_array_equal(read(back)[1], read(model)[1])


@pytest.mark.parametrize("nets", [[], [{"temperature": 1.0}] * 5, "many", [{"temperature": 0.0}] * 2])
def test_other_larger_nets_than_there_may_be_are_refused(tmp_path, nets):
    write_cnn_model(with_second(0.8), tmp_path / "m.npz")
    header, arrays = read_model(tmp_path / "m.npz")
    header["second"]["nets"] = nets
    with pytest.raises(ModelError, match=r"larger nets|temperature"):
        cnn_model_from(tmp_path / "m.npz", header, arrays)


@pytest.mark.parametrize("sure", [-0.1, 1.5, float("nan")])
def test_a_share_that_is_none_is_refused(tmp_path, sure):
    write_cnn_model(with_second(sure), tmp_path / "m.npz")
    with pytest.raises(ModelError, match="sure is"):
        cnn_model_from(tmp_path / "m.npz", *read_model(tmp_path / "m.npz"))
