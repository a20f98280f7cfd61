"""Standardised colours: the quick way for small pictures gives what the histogram gives; casts drop out."""

import cv2
import numpy as np
import pytest

from lightgesture.features.net.network import Quantisation
from lightgesture.features.net.runner import dequantise, quantise
from lightgesture.features.standardise import LARGEST, channel_tables, level_tables, luma_tables, patch_levels

FINE = Quantisation(3.0 / 127.5, -1)


def seen(table, patch):
    """What a table makes of the values that a patch has."""
    return np.take_along_axis(table, patch.reshape(-1, 3).astype(int), axis=0)


@pytest.mark.parametrize("quantisation", [FINE, Quantisation(0.05, 3), Quantisation(0.01, -100)])
@pytest.mark.parametrize("dark", [1, 4, 60])
def test_many_small_pictures_as_one_by_one(dark, quantisation):
    patches = (np.random.default_rng(dark).integers(0, 256, (5, 32, 32, 3)) // dark).astype(np.uint8)
    for patch, levels in zip(patches, patch_levels(patches, quantisation), strict=True):
        expected = quantise(channel_tables(patch)[0], quantisation)
        off = np.abs(levels.reshape(-1, 3).astype(int) - seen(expected, patch))
        assert off.max() <= 1
        assert (off > 0).mean() < 0.05


def test_values_far_from_the_mean_are_clipped():
    patches = np.full((1, 32, 32, 3), 90, np.uint8)
    patches[0, :2, :2] = 255
    patches[0, -2:, -2:] = 0
    coarse = Quantisation(0.05, 3)
    values = dequantise(patch_levels(patches, coarse), coarse)
    assert (values.min(), values.max()) == pytest.approx((-LARGEST, LARGEST), abs=0.03)


def test_a_flat_picture_is_all_zeros():
    flat = np.full((2, 8, 8, 3), 77, np.uint8)
    levels = patch_levels(flat, FINE)
    assert levels.shape == flat.shape
    assert np.abs(levels - FINE.zero).max() <= 1


def test_a_gain_of_each_channel_drops_out():
    bright = np.random.default_rng(2).integers(80, 250, (1, 32, 32, 3)).astype(np.uint8)
    tinted = np.rint(bright * np.array([0.9, 0.7, 0.5])).astype(np.uint8)
    ours, same = (dequantise(patch_levels(one, FINE), FINE) for one in (bright, tinted))
    # The added evenness weighs more in the darker picture.
    assert np.abs(ours - same).max() < 0.25


def test_lumas_of_many_pictures_are_those_of_each_alone():
    pictures = np.random.default_rng(3).integers(0, 256, (4, 32, 32, 3)).astype(np.uint8)
    pictures[1] //= 2
    lumas, tables = luma_tables(pictures)
    for picture, luma, table in zip(pictures, lumas, tables, strict=True):
        alone, own = luma_tables(picture[None])
        np.testing.assert_array_equal(luma, alone[0])
        np.testing.assert_array_equal(table, own[0])
        np.testing.assert_array_equal(luma, cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY))
        seen = table[luma]
        assert (seen.mean(), seen.std()) == pytest.approx((0.0, 1.0), abs=0.25)


@pytest.mark.parametrize("quantisation", [FINE, Quantisation(0.05, 3), Quantisation(0.01, -100)])
@pytest.mark.parametrize("dark", [1, 4, 60])
def test_tables_of_integers_are_those_of_the_histogram(dark, quantisation):
    picture = (np.random.default_rng(dark).integers(0, 256, (60, 80, 3)) // dark).astype(np.uint8)
    off = np.abs(
        level_tables(picture, quantisation).astype(int) - quantise(channel_tables(picture), quantisation)
    )
    assert off.max() <= 1
    assert (off > 0).mean() < 0.05
