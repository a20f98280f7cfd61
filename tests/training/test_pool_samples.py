from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lightgesture.features.patch import PatchSettings, cut_patch
from lightgesture.training.pool import patch_kinds
from lightgesture.training.pool.negatives import Scene
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.patch_pool import PatchPool, make_pool
from lightgesture.training.pool.pool_samples import ALTERED_WEIGHT, pool_samples
from lightgesture.training.pool.samples import LabelledHand

SETTINGS = PoolSettings(copies=3, mild_share=1 / 3, rounds=1, rendered=0)


@pytest.fixture(autouse=True)
def _few_backdrops(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patch_kinds, "CROPS", replace(patch_kinds.CROPS, backdrops=1))


def hand(token: str, source: str) -> LabelledHand:
    random = np.random.default_rng(len(source))
    picture = random.integers(0, 256, (80, 80, 3)).astype(np.uint8)
    return LabelledHand(picture, (20, 20, 40, 40), "right", token, source, None)


@pytest.fixture
def originals() -> Originals:
    sea = Scene(np.random.default_rng(1).integers(0, 256, (60, 80, 3)).astype(np.uint8), (), (), "sea")
    return Originals([hand("1", "anna"), hand("5", "ben"), hand("none", "anna")], [sea])


def pool_of(originals: Originals, folder: Path) -> PatchPool:
    folder.mkdir()
    return make_pool(originals, SETTINGS, 0, 1, folder, lambda *_: None)


def test_hands_come_first_then_each_row_once(originals: Originals, tmp_path: Path) -> None:
    pool = pool_of(originals, tmp_path / "pool")
    rows, hands = np.ones(len(pool.tokens), bool), np.array([True, False, True])
    rows[1] = False
    found = list(pool_samples(pool, originals, rows, hands, SETTINGS, 0))
    plain, drawn = found[:2], found[2:]
    assert [(one.token, one.source, one.side, one.original) for one in plain] == [
        ("1", "anna", "right", True),
        ("none", "anna", "right", True),
    ]
    assert [one.token for one in drawn] == pool.tokens[rows].tolist()
    assert [one.source for one in drawn] == pool.sources[rows].tolist()
    assert not any(one.original for one in drawn)
    copied = np.flatnonzero(pool.hands[rows] >= 0)
    weights = np.array([one.weight for one in drawn])
    # The last copy of each hand is the mild one.
    assert (weights[copied[-3:]] == 1.0).all()
    assert weights.sum() == pytest.approx(3 + ALTERED_WEIGHT * (len(drawn) - 3))


def test_a_row_is_seen_as_the_net_sees_it_shifted_within_its_margin(
    originals: Originals, tmp_path: Path
) -> None:
    pool = pool_of(originals, tmp_path / "pool")
    rows, hands = np.ones(len(pool.tokens), bool), np.zeros(3, bool)
    corners = set()
    for row, sample in zip(
        pool.patches, pool_samples(pool, originals, rows, hands, SETTINGS, 0), strict=True
    ):
        patch = cut_patch(sample.image, sample.box, sample.side, PatchSettings())
        places = [
            (top, left)
            for top in range(5)
            for left in range(5)
            if np.array_equal(row[top : top + 32, left : left + 32], patch)
        ]
        assert places
        corners.add(places[0])
    assert len(corners) > 5


def test_rendered_hands_alone_are_the_originals(tmp_path: Path) -> None:
    nothing = Originals([])
    pool = make_pool(nothing, replace(SETTINGS, rendered=4), 0, 1, tmp_path, lambda *_: None)
    rows = np.ones(len(pool.tokens), bool)
    found = list(pool_samples(pool, nothing, rows, np.zeros(0, bool), SETTINGS, 0))
    assert found
    assert all(one.original for one in found)
