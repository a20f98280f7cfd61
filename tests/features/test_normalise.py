"""What each colour normalisation promises."""

import numpy as np
import pytest

from lightgesture.features.normalise import compensate_red, gray_world


def test_red_is_given_back_only_where_green_leads():
    image = np.full((4, 4, 3), (0.5, 0.6, 0.2), np.float32)
    expected = 0.2 + (0.6 - 0.2) * (1 - 0.2) * 0.6
    assert compensate_red(image, 1.0)[0, 0, 2] == pytest.approx(expected)
    reddish = np.full((4, 4, 3), (0.2, 0.3, 0.6), np.float32)
    np.testing.assert_array_equal(compensate_red(reddish, 1.0), reddish)


def test_gray_world_makes_the_means_equal():
    rng = np.random.default_rng(0)
    image = rng.uniform(0.1, 0.4, (30, 40, 3)).astype(np.float32) * np.array([1.0, 0.8, 0.4], np.float32)
    means = gray_world(image).reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(means, means.mean(), rtol=0.01)
