"""The fast skin map against its written-out reference."""

import time

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.errors import InputError
from lightgesture.features.colour import WORKING_PIXELS, reduce_picture
from lightgesture.features.skin_map import (
    compensate_red,
    gray_world,
    redness,
    reference_skin_map,
    skin_map,
    stretch,
)
from lightgesture.training.datasets import find_data, read_webcam


def _largest_difference(picture):
    slow, fast = reference_skin_map(picture), skin_map(picture)
    return int(np.abs(slow.astype(int) - fast).max())


def _scene(seed=0):
    return np.random.default_rng(seed).uniform(0.02, 0.5, (30, 40, 3)).astype(np.float32)


@given(
    seed=st.integers(0, 2**32 - 1),
    size=st.tuples(st.integers(1, 80), st.integers(1, 80)),
    light=st.tuples(*[st.floats(0.02, 1.0)] * 3),
    grain=st.integers(0, 60),
)
@settings(max_examples=60, deadline=None)
def test_fast_and_written_out_agree_on_any_light(seed, size, light, grain):
    rng = np.random.default_rng(seed)
    coarse = rng.integers(0, 256, (4, 4, 3)).astype(np.float32)
    picture = cv2.resize(coarse, (size[1] * 2, size[0] * 2)) * np.array(light, np.float32)
    picture = np.clip(picture + rng.normal(0, 1 + grain, picture.shape), 0, 255).astype(np.uint8)
    assert _largest_difference(picture) <= 2


@pytest.mark.parametrize("value", [0, 1, 128, 255])
def test_a_constant_picture_gives_zeros_in_both(value):
    picture = np.full((120, 160, 3), value, np.uint8)
    assert not reference_skin_map(picture).any()
    assert not skin_map(picture).any()


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_a_picture_of_one_channel_does_not_divide_by_its_dark_ones(channel):
    picture = np.zeros((120, 160, 3), np.uint8)
    picture[..., channel] = np.random.default_rng(1).integers(0, 256, (120, 160))
    assert _largest_difference(picture) <= 2


def test_fast_and_written_out_agree_on_real_frames():
    try:
        samples = read_webcam(find_data(), "val")
    except InputError:
        pytest.skip("needs the optional data folder ../shared/data")
    for sample in samples:
        picture = reduce_picture(cv2.imread(str(sample.path)), WORKING_PIXELS)[0]
        assert _largest_difference(picture) <= 2, sample.path.name


def test_the_fast_map_is_fast():
    picture = np.random.default_rng(0).integers(0, 256, (120, 160, 3), np.uint8)
    times = []
    for run in (reference_skin_map, skin_map):
        run(picture)
        best = float("inf")
        for _ in range(20):
            start = time.perf_counter()
            run(picture)
            best = min(best, time.perf_counter() - start)
        times.append(best)
    assert times[1] < times[0] / 1.5


def test_skin_is_redder_than_grey_and_grey_than_water():
    colours = np.array([[[110, 140, 200], [128, 128, 128], [150, 120, 40]]], np.float32) / 255
    skin, grey, water = redness(colours)[0]
    assert skin > grey + 0.05
    assert water < grey - 0.05
    assert abs(grey) < 1e-6


def test_stretching_spans_the_percentiles():
    values = np.linspace(-1, 1, 1001, dtype=np.float32).reshape(7, 143)
    levels = stretch(values)
    assert levels.min() == 0
    assert levels.max() == 255
    assert int((levels == 0).sum()) == pytest.approx(200, abs=4)


def test_red_is_given_back_only_where_green_leads():
    image = np.full((4, 4, 3), (0.5, 0.6, 0.2), np.float32)
    expected = 0.2 + (0.6 - 0.2) * (1 - 0.2) * 0.6
    assert compensate_red(image)[0, 0, 2] == pytest.approx(expected)
    reddish = np.full((4, 4, 3), (0.2, 0.3, 0.6), np.float32)
    np.testing.assert_array_equal(compensate_red(reddish), reddish)


def test_gray_world_makes_the_means_equal():
    rng = np.random.default_rng(0)
    image = rng.uniform(0.1, 0.4, (30, 40, 3)).astype(np.float32) * np.array([1.0, 0.8, 0.4], np.float32)
    means = gray_world(image).reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(means, means.mean(), rtol=0.01)


@given(light=st.tuples(*[st.floats(0.3, 1.0)] * 3))
def test_the_colour_of_the_light_drops_out(light):
    scene = _scene()
    plain, tinted = gray_world(scene), gray_world(scene * np.array(light, np.float32))
    # Gray-world keeps the brightness: only the proportions of the channels are compared.
    free = (plain < 1.0).all(axis=2) & (tinted < 1.0).all(axis=2)
    ratio = plain[free] / tinted[free]
    np.testing.assert_allclose(ratio, np.broadcast_to(ratio.mean(), ratio.shape), rtol=1e-3)


@pytest.mark.parametrize("normalise", [gray_world, compensate_red])
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
