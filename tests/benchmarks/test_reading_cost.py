"""What reading costs: counts that can be reckoned by hand, and that a strange classifier is no error."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.benchmarks.reading.cost import (
    WARM_UP,
    Pair,
    added_memory,
    cost_table,
    count_products,
    count_weights,
    kernel_products,
    model_alone,
)
from lightgesture.features.hog import HogSettings
from lightgesture.features.patch import PatchSettings
from lightgesture.features.vector import VectorSettings, block_lengths
from lightgesture.models import load_classifier
from lightgesture.models.svm import SvmClassifier
from lightgesture.models.svm_file import SvmModel

CALLS = 3
PAIR = Pair(np.full((60, 80, 3), 90, np.uint8), ((5, 5, 20, 30), (40, 5, 20, 30)))


@pytest.fixture
def machine():
    """Two classes, seven centres in three dimensions; 24 of a patch's 28 pixels in cells of 12 with 4 directions."""
    features = VectorSettings(PatchSettings(28), HogSettings(rim=2, cell=12, bins=4))
    length = sum(block_lengths(features))
    return SvmModel(
        classes=("5", "none"),
        features=features,
        mean=np.zeros(length, np.float32),
        projection=np.zeros((length, 3), np.float32),
        centres=np.zeros((7, 3), np.float32),
        weights=np.ones((7, 2), np.float32),
        bias=np.zeros(2, np.float32),
        gamma=1.0,
        temperature=1.0,
        smallest_hand=8,
    )


def test_products_of_the_machine(machine):
    length = sum(block_lengths(machine.features))
    pooling = 4 * (2 * 24 * 24 + 2 * 2 * 24)
    assert kernel_products(machine) == pooling + length * 3 + 7 * 3 + 7 * 2
    assert count_products(SvmClassifier(machine)) == kernel_products(machine)
    assert count_weights(SvmClassifier(machine)) == length + length * 3 + 7 * 3 + 7 * 2 + 2
    more = replace(machine, centres=np.zeros((8, 3), np.float32), weights=np.ones((8, 2), np.float32))
    assert kernel_products(more) - kernel_products(machine) == 5


def test_row_of_a_strange_classifier_has_its_time_alone(fake_classifier):
    (row,) = cost_table({"fake": fake_classifier}, PAIR, CALLS).to_dicts()
    assert row["pair_ms"] >= 0.0
    assert {name for name, cell in row.items() if cell is None} == {
        *("file_kb", "weights", "multiply_adds", "model_ms", "memory_mb"),
    }
    assert fake_classifier.calls[0] == ((60, 80, 3), list(PAIR.boxes), ["right", "left"])
    assert len(fake_classifier.calls) == WARM_UP + CALLS


@pytest.mark.slow
def test_row_of_the_shipped_machine():
    classifier = load_classifier("svm")
    (row,) = cost_table({"svm": classifier}, PAIR, CALLS).to_dicts()
    assert row["file_kb"] < 2000
    assert row["weights"] == classifier.model.centres.size + sum(
        array.size
        for array in (
            classifier.model.mean,
            classifier.model.projection,
            classifier.model.weights,
            classifier.model.bias,
        )
    )
    assert row["pair_ms"] > row["model_ms"] > 0.0
    assert model_alone(classifier)().shape == (2, len(classifier.classes))
    assert 0.5 < added_memory("svm") < 100.0
