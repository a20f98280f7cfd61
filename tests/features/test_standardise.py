"""Standardised colours: the quick way for small pictures gives what the histogram gives; casts drop out."""

import numpy as np
import pytest

from lightgesture.features.standardise import channel_tables, patch_tables


@pytest.mark.parametrize("dark", [1, 4, 60])
def test_many_small_pictures_as_one_by_one(dark):
    patches = (np.random.default_rng(dark).integers(0, 256, (5, 32, 32, 3)) // dark).astype(np.uint8)
    for patch, table in zip(patches, patch_tables(patches), strict=True):
        seen = np.take_along_axis(table, patch.reshape(-1, 3).astype(int), axis=0)
        expected = np.take_along_axis(channel_tables(patch)[0], patch.reshape(-1, 3).astype(int), axis=0)
        np.testing.assert_allclose(seen, expected, atol=1e-3)


def test_a_flat_picture_is_all_zeros():
    flat = np.full((2, 8, 8, 3), 77, np.uint8)
    np.testing.assert_allclose(patch_tables(flat)[:, 77], 0.0, atol=1e-2)


def test_a_gain_of_each_channel_drops_out():
    bright = np.random.default_rng(2).integers(80, 250, (1, 32, 32, 3)).astype(np.uint8)
    tinted = np.rint(bright * np.array([0.9, 0.7, 0.5])).astype(np.uint8)
    seen, same = (
        np.take_along_axis(patch_tables(one)[0], one.reshape(-1, 3).astype(int), axis=0)
        for one in (bright, tinted)
    )
    # The added evenness weighs more in the darker picture.
    assert np.abs(seen - same).max() < 0.25
