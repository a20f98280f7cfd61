"""Samples of both nets: boxes move with their pictures, targets say where hands are, few steps of training run."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.features.find.locator import DETAIL
from lightgesture.training.nets.locator_samples import LocatorSamples, make_targets, warp
from lightgesture.training.nets.window_samples import (
    REFINER,
    VERIFIER,
    WindowSamples,
    cut_turned,
    hard_regions,
    target_edges,
)
from lightgesture.training.pictures import light
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.light import photometric
from lightgesture.training.regions.nets import larger_net


def a_picture(boxes=((120, 80, 60, 80),)):
    image = np.zeros((240, 320, 3), np.uint8)
    for x, y, w, h in boxes:
        cv2.ellipse(image, (x + w // 2, y + h // 2), (w // 2, h // 2), 0, 0, 360, (255,) * 3, -1)
    return BoxedPicture(image, boxes, (), True, frozenset({"drawn"}))


@pytest.mark.parametrize("seed", range(12))
def test_a_drawn_ellipse_stays_in_its_box(seed):
    rng = np.random.default_rng(seed)
    image, hands, _, _ = warp(a_picture(), rng, (0.6, 1.5))
    x, y, width, height = cv2.boundingRect((image[..., 0] > 127).astype(np.uint8))
    seen = np.clip(hands[0], 0, (160, 120, 160, 120)) * DETAIL
    assert (x, y, x + width, y + height) == pytest.approx(tuple(seen), abs=3.0)


def test_boxes_and_pictures_do_not_drift_apart():
    # A filled rectangle covers the pixels of its box and no other, which OpenCV's ellipse does not.
    square = np.zeros((240, 320, 3), np.uint8)
    square[80:160, 120:180] = 255
    picture, offsets = replace(a_picture(), image=square), []
    for seed in range(40):
        image, hands, _, _ = warp(picture, np.random.default_rng(seed), (0.6, 1.5))
        corners = hands[0]
        if corners.min() < 3 or corners[2] > 157 or corners[3] > 117:
            continue  # the border may continue what it cuts
        weights = np.clip(image[..., 0].astype(np.float64) - 60, 0, None)
        y, x = (np.mgrid[0:240, 0:320] + 0.5) / DETAIL
        seen = np.array([(weights * x).sum(), (weights * y).sum()]) / weights.sum()
        offsets.append(seen - (corners[:2] + corners[2:]) / 2)
    assert len(offsets) > 20
    assert np.mean(offsets, axis=0) == pytest.approx((0, 0), abs=0.05)
    assert np.abs(offsets).max() < 0.4


@pytest.mark.parametrize("seed", range(4))
def test_samples_repeat_for_a_seed(seed):
    pictures, empty = [a_picture()], [a_picture(())]
    located = LocatorSamples(pictures, empty, pictures)
    (first, maps), (again, same) = (located.draw(np.random.default_rng(seed)) for _ in "ab")
    np.testing.assert_array_equal(first, again)
    for name in ("heat", "weight", "box", "box_weight"):
        np.testing.assert_array_equal(getattr(maps, name), getattr(same, name))
    assert first.shape == (256, 320, 3)
    assert not first[240:].any()
    assert np.abs(first).max() <= 3

    false = np.array([[10, 10, 30, 40.0]], np.float32)
    kinds = [[(picture, false)] for picture in (*pictures, *empty, *pictures)]
    for settings, channels in ((REFINER, 4), (VERIFIER, 3)):
        samples = WindowSamples(*kinds, None, [], settings)
        drawn, repeated = (samples.draw(np.random.default_rng(seed)) for _ in "ab")
        for one, other in zip(drawn, repeated, strict=True):
            np.testing.assert_array_equal(one, other)
        assert drawn[0].shape == (8, 32, 32, channels)
        assert set(drawn[1][:, 0]) <= {0.0, 1.0}


def test_targets_are_hottest_in_the_middle_and_measure_to_the_edges():
    maps = make_targets(np.array([[40, 20, 80, 60]], np.float32), np.zeros((0, 4), np.float32), False)
    row, column = np.unravel_index(maps.heat[0].argmax(), maps.heat[0].shape)
    assert maps.heat[0].max() == 1
    x, y = (column + 0.5) * 4, (row + 0.5) * 4
    np.testing.assert_allclose(maps.box[:, row, column], (x - 40, y - 20, 80 - x, 60 - y))
    assert maps.weight[1, 0, 0] == 0
    assert maps.weight[1, row, column] == 1


@pytest.mark.parametrize("flip", [False, True])
@pytest.mark.parametrize("turn", [-0.3, 0.0, 0.3])
def test_edges_of_a_window_go_round_the_turned_hand(turn, flip):
    window = (90, 60, 120)
    cut = cut_turned(a_picture().image, window, 96, turn, flip)
    x, y, width, height = cv2.boundingRect((cut[..., 0] > 127).astype(np.uint8))
    edges = (target_edges(np.array([120, 80, 60, 80.0]), window, turn, flip) + 0.5) * 96
    assert (x, y, x + width, y + height) == pytest.approx(tuple(edges), abs=2.0)


def test_another_light_repeats_for_a_seed():
    first, again = (photometric(a_picture().image, np.random.default_rng(2), True) for _ in "ab")
    np.testing.assert_array_equal(first, again)
    assert first.dtype == np.uint8


def test_without_any_change_the_light_stays_and_each_change_is_felt(monkeypatch):
    picture = np.clip(a_picture().image, 90, 200)
    shares = ("WATER", "DARK", "GAMMA", "BALANCE", "CONTRAST", "GREY", "BLURRED", "NOISY")

    def changed(image, in_air, **given):
        for share in shares:
            monkeypatch.setattr(light, f"{share}_SHARE", given.get(share, 0.0))
        return photometric(image, np.random.default_rng(0), in_air).astype(int)

    np.testing.assert_allclose(changed(picture, True), picture, atol=1)
    coloured = picture * np.array([1, 0, 1], np.uint8)
    for share in shares:
        assert np.abs(changed(coloured, True, **{share: 1.0}) - coloured).max() > 2, share
    np.testing.assert_allclose(changed(picture, False, WATER=0.5, DARK=0.5), picture, atol=1)


@pytest.mark.slow
def test_two_steps_train_the_nets_and_go_on_from_their_checkpoints(tmp_path):
    pytest.importorskip("torch")
    from lightgesture.training.nets.locator import train_locator
    from lightgesture.training.nets.refiner import train_refiner
    from lightgesture.training.nets.verifier import train_verifier

    pictures, empty, said = [a_picture()], [a_picture(())], []
    locator = train_locator(
        LocatorSamples(pictures, empty, pictures), 2, "float32", None, 0, tmp_path / "locator.pt", said.append
    )
    kinds = [hard_regions(part, locator) for part in (pictures, empty, pictures)]
    windows = WindowSamples(*kinds, None, [], REFINER)
    refiner = train_refiner(windows, 2, "float32", None, 0, tmp_path / "refiner.pt", said.append)
    alone, reader = WindowSamples(*kinds, None, [], VERIFIER), larger_net("cnn")
    verifier = train_verifier(alone, 2, "float32", reader, 0, tmp_path / "verifier.pt", said.append)
    assert (verifier.inputs, verifier.outputs) == ({"patch": (32, 32, 3)}, ("hand",))
    told = len(said)
    again = train_refiner(windows, 2, "float32", refiner, 0, tmp_path / "refiner.pt", said.append)
    assert len(said) == told, "nothing was left to learn"
    for name, weights in refiner.weights.items():
        np.testing.assert_array_equal(again.weights[name].weights, weights.weights)
