"""Other colours for patches: shapes stay, and so does what a net takes for granted of its inputs."""

import numpy as np
import pytest

from lightgesture.features.standardise import LARGEST
from lightgesture.training.nets.hand_samples import standardised
from lightgesture.training.nets.patch_colours import GREY_SHARE, INVERTED_SHARE, MIXED_SHARE, recolour

COUNT = 400


@pytest.fixture(name="patches", scope="module")
def _patches():
    """A bright bar on a dark ground, other in each channel, in noise."""
    random = np.random.default_rng(1)
    patches = random.integers(20, 60, (COUNT, 32, 32, 3))
    patches[:, 8:24, 12:20] += np.array([30, 90, 150])
    return standardised(patches.astype(np.uint8))


@pytest.fixture(name="changed")
def _changed(patches):
    changed = patches.copy()
    recolour(changed, np.random.default_rng(2))
    return changed


def test_patches_stay_standardised(changed):
    assert changed.dtype == np.float32
    assert np.abs(changed).max() <= LARGEST
    assert changed.mean(axis=(1, 2)) == pytest.approx(0.0, abs=0.1)
    assert changed.std(axis=(1, 2)).max() < 1.1
    assert changed.std(axis=(1, 2)).min() > 0.7


def test_a_share_of_the_patches_is_changed_and_the_rest_is_not(patches, changed):
    same = (changed == patches).all(axis=(1, 2, 3))
    assert same.mean() == pytest.approx((1 - MIXED_SHARE) * (1 - INVERTED_SHARE), abs=0.08)
    grey = np.ptp(changed, axis=3).max(axis=(1, 2)) < 1e-4
    assert grey.mean() == pytest.approx(MIXED_SHARE * GREY_SHARE, abs=0.08)


def test_the_bar_is_where_it_was_bright_or_dark(changed):
    bar = changed[:, 10:22, 13:19].mean(axis=(1, 2, 3)) - changed[:, :6].mean(axis=(1, 2, 3))
    assert np.abs(bar).min() > 0.5
    assert (bar < 0).mean() == pytest.approx(INVERTED_SHARE, abs=0.06)


def test_the_same_generator_gives_the_same_colours(patches, changed):
    again = patches.copy()
    recolour(again, np.random.default_rng(2))
    np.testing.assert_array_equal(again, changed)


def test_no_patch_is_no_error():
    recolour(np.zeros((0, 32, 32, 3), np.float32), np.random.default_rng(0))
