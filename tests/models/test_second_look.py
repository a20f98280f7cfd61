"""The second look: asked about what the small net doubts and about nothing else, kept in the file, bounded."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.patch import cut_patches
from lightgesture.models import ModelError
from lightgesture.models.archive import read_model
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import MOST_DOUBTED, SECOND_WEIGHT, CnnClassifier, SecondLook, most_doubted
from lightgesture.models.cnn_file import cnn_model_from
from lightgesture.training.model_files import write_cnn_model
from tests.models.test_cnn import random_model

BOXES = [(10 * number, 5 * number, 60, 70) for number in range(6)]
SIDES = ["left"] * len(BOXES)


def with_second(sure):
    model, other = random_model(3, has_outline=False), random_model(4, has_outline=False)
    return replace(model, second=SecondLook(other.network, 1.3, sure))


def read(model):
    image = np.random.default_rng(0).integers(0, 256, (240, 320, 3)).astype(np.uint8)
    return image, CnnClassifier(model, "numpy").probabilities(image, BOXES, SIDES)


def test_a_sure_small_net_is_not_asked_again():
    alone = read(replace(with_second(0.0), second=None))[1]
    np.testing.assert_array_equal(read(with_second(0.0))[1], alone)


def test_the_most_doubted_are_weighed_and_no_others():
    model = with_second(1.0)
    image, both = read(model)
    first = read(replace(model, second=None))[1]
    patches = cut_patches(image, BOXES, SIDES, model.patch)
    second = softmax(CnnClassifier(model, "numpy").second_scores(patches), 1.3)
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
    assert (back.second.temperature, back.second.sure) == (1.3, 0.8)
    np.testing.assert_array_equal(read(back)[1], read(model)[1])


@pytest.mark.parametrize("sure", [-0.1, 1.5, float("nan")])
def test_a_share_that_is_none_is_refused(tmp_path, sure):
    write_cnn_model(with_second(sure), tmp_path / "m.npz")
    with pytest.raises(ModelError, match="sure is"):
        cnn_model_from(tmp_path / "m.npz", *read_model(tmp_path / "m.npz"))
