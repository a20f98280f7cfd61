from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.training.pictures.augment import (
    CANVAS,
    REACH,
    AugmentSettings,
    augment,
    hand_mask,
    shifted_box,
)
from lightgesture.training.pictures.light import LightSettings, path_before_hand, relight
from lightgesture.training.pool.negatives import Scene, missed_hand, negatives
from lightgesture.training.pool.samples import LabelledHand, landmark_box

STILL = LightSettings(gamma=0, contrast=0, gain=0, gradient=0, dark=0, backlit=0, water=0, blur=0, noise=0)
"""Light that changes nothing."""

PLAIN = AugmentSettings(mirror=0, rotation=0, stretch=0, shear=0, background=0, shift=0, scale=0, light=STILL)
"""Copies that only move the hand to the canvas."""


def thumb_left(token: str = "left", landmarks: bool = True) -> LabelledHand:
    """A block with a bar to image left, and landmarks over it."""
    image = np.full((80, 80, 3), 60, np.uint8)
    cv2.rectangle(image, (36, 30), (60, 60), (100, 150, 210), -1)
    cv2.rectangle(image, (18, 40), (36, 46), (100, 150, 210), -1)
    points = np.full((21, 2), (48, 45), np.float32)
    points[0], points[4], points[9], points[12], points[5], points[17] = (
        (48, 58), (20, 43), (48, 36), (48, 32), (42, 36), (56, 38),
    )  # fmt: skip
    box = landmark_box(points)
    return LabelledHand(image, box, "left", token, "someone", points if landmarks else None)


def bright_columns(image: np.ndarray) -> float:
    """Mean column of the reddest pixels of the thumb's rows minus that of all the hand's."""
    red = image[..., 2] > 150
    rows = np.flatnonzero(red.any(axis=1))
    widest = max(rows, key=lambda row: int(np.ptp(np.flatnonzero(red[row]))))
    return float(np.flatnonzero(red[widest]).mean() - np.argwhere(red)[:, 1].mean())


def test_a_mirrored_copy_exchanges_left_and_right() -> None:
    random = np.random.default_rng(0)
    image, _, token, _ = augment(thumb_left(), [], PLAIN, random)
    mirrored, _, other, _ = augment(thumb_left(), [], replace(PLAIN, mirror=1.0), random)
    assert (token, other) == ("left", "right")
    assert bright_columns(image) < 0 < bright_columns(mirrored)
    assert augment(thumb_left("pic"), [], replace(PLAIN, mirror=1.0), random)[2] == "pic"


@pytest.mark.parametrize("landmarks", [True, False])
def test_the_box_follows_the_hand(landmarks: bool) -> None:
    hand = thumb_left(landmarks=landmarks)
    image, box, _, _ = augment(hand, [], PLAIN, np.random.default_rng(0))
    assert image.shape == (CANVAS, CANVAS, 3)
    zoom = CANVAS / (REACH * max(hand.box[2:]))
    assert box[2] == pytest.approx(hand.box[2] * zoom, abs=2)
    assert box[0] + box[2] / 2 == pytest.approx(CANVAS / 2, abs=2)


def test_another_background_leaves_the_hand() -> None:
    hand = thumb_left()
    before = augment(hand, [], PLAIN, np.random.default_rng(0)).image
    water = np.full((40, 50, 3), (200, 160, 20), np.uint8)
    after = augment(hand, [water], replace(PLAIN, background=1.0), np.random.default_rng(0)).image
    assert after[2, 2].tolist() == pytest.approx([200, 160, 20], abs=2)
    assert np.abs(after[48, 52].astype(int) - before[48, 52]).max() <= 2


def test_the_same_random_state_gives_the_same_copy() -> None:
    def copy(seed: int) -> np.ndarray:
        return augment(thumb_left(), [], AugmentSettings(), np.random.default_rng(seed))[0]

    assert np.array_equal(copy(5), copy(5))
    assert not np.array_equal(copy(5), copy(6))


def test_box_errors_have_the_size_that_was_asked_for() -> None:
    random = np.random.default_rng(0)
    settings = AugmentSettings(shift=0.05, scale=0.0)
    boxes = np.array([shifted_box((50, 50, 100, 100), settings, random) for _ in range(2000)])
    assert boxes[:, 0].std() == pytest.approx(5, rel=0.1)
    assert (boxes[:, 2] == 100).all()


def test_the_mask_covers_the_landmarks_and_not_the_corners() -> None:
    landmarks = thumb_left().landmarks
    assert landmarks is not None
    mask = hand_mask(landmarks, 80, 0.3)
    points = landmarks.astype(int)
    assert mask[points[:, 1], points[:, 0]].min() > 0.5
    assert mask[0, 0] == mask[0, -1] == 0.0


def test_still_light_changes_nothing() -> None:
    image = thumb_left().image
    changed = relight(image, None, STILL, np.random.default_rng(0))
    assert np.abs(changed.astype(int) - image).max() <= 1


def test_water_takes_red_first() -> None:
    picture = np.full((8, 8, 3), 0.6, np.float32)
    for seed in range(20):
        clear = replace(path_before_hand(np.random.default_rng(seed)), scattered=np.float32(1.0))
        blue, green, red = clear.see(picture)[4, 4]
        assert red < min(blue, green)
        assert max(blue, green) <= 0.6


def test_negatives_lie_on_no_hand() -> None:
    random = np.random.default_rng(0)
    scene = Scene(
        thumb_left().image.repeat(3, axis=0).repeat(3, axis=1), ((40, 80, 150, 110),), ((0, 0, 30, 30),), "s"
    )
    samples = list(negatives([scene] * 8, random))
    assert len(samples) > 20
    assert samples[0].box == (0, 0, 30, 30)
    for sample in samples:
        assert sample.token == "none"
        x, y, width, height = sample.box
        wide = max(0, min(x + width, 190) - max(x, 40))
        high = max(0, min(y + height, 190) - max(y, 80))
        assert wide * high <= 0.33 * (width * height + 150 * 110 - wide * high)


def test_a_missed_hand_overlaps_it_little() -> None:
    random = np.random.default_rng(0)
    hand = thumb_left()
    found = [missed_hand(hand, random) for _ in range(200)]
    assert any(sample is not None for sample in found)
    assert any(sample is None for sample in found)
