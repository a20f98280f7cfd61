"""The contour bank made from the data folder."""

import numpy as np
import pytest

from lightgesture.errors import InputError
from lightgesture.features.find.bank import OTHER
from lightgesture.models import CLASSES, NONE
from lightgesture.training.datasets import find_data
from lightgesture.training.pool.left_out import LeftOut
from lightgesture.training.regions import bank as training
from lightgesture.training.regions.bank import OTHER_TIMES, hand_outlines, make_bank


@pytest.fixture(scope="module")
def data():
    try:
        return find_data()
    except InputError:
        pytest.skip("needs the optional data folder ../shared/data")


def test_a_bank_holds_the_tokens_and_other_things_and_is_the_same_each_time(data, monkeypatch):
    for name, few in {"CENTRES": 2, "HANDS": 2, "FRAMES": 4, "OTHERS": 6}.items():
        monkeypatch.setattr(training, name, few)
    first, second = make_bank(data, 5), make_bank(data, 5)
    assert first.classes == (*(token for token in CLASSES if token != NONE), OTHER)
    sizes = np.bincount(first.owner)
    assert sizes[:-1].tolist() == [2] * 10
    assert sizes[-1] == 2 * OTHER_TIMES
    np.testing.assert_array_equal(first.centres, second.centres)


def test_no_left_out_source_is_read_and_each_hand_is_of_another_source(data, monkeypatch):
    seen = []

    def read(_, row):
        seen.append((row["token"], row["set"]))
        return np.array([[0, 0], [9, 0], [9, 9]], np.int32)

    monkeypatch.setattr(training, "cut_out_outline", read)
    monkeypatch.setattr(training, "HANDS", 10)
    without = LeftOut(fold=2)
    outlines = hand_outlines(data, np.random.default_rng(0), without)
    assert [len(found) for found in outlines.values()] == [10] * 10
    sources = {source for _, source in seen}
    assert "emre_drone" not in sources
    assert not any(without.covers(source) for source in sources)
    assert len(set(seen)) == len(seen)
