"""What each colour normalisation promises."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lightgesture.features.normalise import compensate_red, gray_world, shades_of_gray, white_patch

NORMALISATIONS = {"gray-world": gray_world, "shades of gray": shades_of_gray, "white patch": white_patch}


def _scene(seed=0):
    return np.random.default_rng(seed).uniform(0.02, 0.5, (30, 40, 3)).astype(np.float32)


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


@pytest.mark.parametrize("normalise", NORMALISATIONS.values(), ids=NORMALISATIONS.keys())
@given(light=st.tuples(*[st.floats(0.3, 1.0)] * 3))
def test_the_colour_of_the_light_drops_out(normalise, light):
    scene = _scene()
    plain, tinted = normalise(scene), normalise(scene * np.array(light, np.float32))
    # Gray-world and shades of gray keep the brightness: only the proportions of the channels are compared.
    free = (plain < 1.0).all(axis=2) & (tinted < 1.0).all(axis=2)
    ratio = plain[free] / tinted[free]
    np.testing.assert_allclose(ratio, np.broadcast_to(ratio.mean(), ratio.shape), rtol=1e-3)


@pytest.mark.parametrize("normalise", [*NORMALISATIONS.values(), lambda bgr: compensate_red(bgr, 1.0)])
@pytest.mark.parametrize(
    "image",
    [np.zeros((5, 6, 3)), np.ones((5, 6, 3)), np.full((1, 1, 3), 0.3), np.eye(3).reshape(1, 3, 3)],
    ids=["black", "white", "one pixel", "one channel each"],
)
def test_range_shape_and_type_stay_and_the_input_is_left_alone(normalise, image):
    given_image = image.astype(np.float32)
    kept = given_image.copy()
    found = normalise(given_image)
    assert found.shape == image.shape
    assert found.dtype == np.float32
    assert found.min() >= 0.0
    assert found.max() <= 1.0
    np.testing.assert_array_equal(given_image, kept)


def test_shades_of_gray_of_order_one_is_gray_world():
    np.testing.assert_allclose(shades_of_gray(_scene(), 1.0), gray_world(_scene()), rtol=1e-5)
    with pytest.raises(ValueError, match="order"):
        shades_of_gray(_scene(), 0.5)


def test_shades_of_gray_of_a_high_order_makes_the_brightest_equal():
    image = _scene() * np.array([1.0, 0.7, 0.4], np.float32)
    brightest = shades_of_gray(image, 200.0).reshape(-1, 3).max(axis=0)
    np.testing.assert_allclose(brightest, brightest.mean(), rtol=0.03)


def test_white_patch_makes_the_brightest_white():
    image = _scene() * np.array([1.0, 0.7, 0.4], np.float32)
    np.testing.assert_allclose(white_patch(image, 100.0).reshape(-1, 3).max(axis=0), 1.0)
    assert (white_patch(image, 90.0) == 1.0).mean() == pytest.approx(0.1, abs=0.01)
