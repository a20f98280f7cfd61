import math

import cv2
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from lightgesture.features.outline.contours import (
    SHAPE_NUMBERS,
    ContourSettings,
    contour_length,
    contour_numbers,
    contour_vectors,
    defect_depths,
    outline,
    radial_signature,
    segment,
)

WIDE = ContourSettings(size=256)


def drawn_hand(fingers: int, size: int = 256) -> np.ndarray:
    """Mask of a palm with upright fingers."""
    mask = np.zeros((size, size), np.uint8)
    unit = size // 16
    cv2.ellipse(mask, (8 * unit, 11 * unit), (4 * unit, 4 * unit), 0, 0, 360, 255, -1)
    for finger in range(fingers):
        x = 5 * unit + finger * 2 * unit
        # An arc of tips: were they level, the hull would touch the outer ones alone.
        tip = 2 * unit + round(unit / 2 * abs(finger - (fingers - 1) / 2))
        cv2.line(mask, (x, 10 * unit), (x, tip), 255, unit)
    return mask


def painted(mask: np.ndarray, hand: tuple[int, int, int], room: tuple[int, int, int]) -> np.ndarray:
    noise = np.random.default_rng(0).normal(0, 4, (*mask.shape, 3))
    picture = np.where(mask[..., None] > 0, hand, room) + noise
    return np.clip(picture, 0, 255).astype(np.uint8)


@pytest.mark.parametrize(
    ("hand", "room"),
    [
        ((110, 140, 200), (200, 190, 180)),
        ((140, 150, 120), (160, 140, 40)),
        ((25, 28, 36), (120, 130, 140)),
        ((60, 70, 100), (20, 25, 22)),
    ],
    ids=["skin in a room", "under water", "against the light", "in the dark"],
)
def test_the_hand_is_found_whatever_the_light(hand: tuple[int, int, int], room: tuple[int, int, int]) -> None:
    mask = drawn_hand(2, 48)
    found = segment(painted(mask, hand, room), ContourSettings(size=48)) > 0
    truth = mask > 0
    assert (found & truth).sum() / (found | truth).sum() > 0.85


def test_the_hand_is_cut_along_fishers_discriminant() -> None:
    """The threshold is Otsu's on the levels that the definition gives, pixel by pixel."""
    settings = ContourSettings(size=48)
    patch = painted(drawn_hand(2, 48), (110, 140, 200), (140, 150, 120))
    colours = np.sqrt(patch / 255.0)
    down, across = np.meshgrid(*[(np.arange(48) + 0.5) / 24 - 1] * 2, indexing="ij")
    middle = (across / settings.middle_width) ** 2 + (down / settings.middle_height) ** 2 < 1
    rim = np.zeros((48, 48), bool)
    rim[:5] = rim[:36, :5] = rim[:36, -5:] = True
    inside, outside = colours[middle], colours[rim]
    scatter = np.cov(inside.T, bias=True) + np.cov(outside.T, bias=True) + settings.evenness * np.eye(3)
    values = colours @ np.linalg.solve(scatter, inside.mean(axis=0) - outside.mean(axis=0))
    bump = np.exp(-(across**2) - down**2)
    values = (values - values.mean()) / values.std() + settings.prior * (bump - bump.mean()) / bump.std()
    levels = ((values - values.min()) * 255 / np.ptp(values)).astype(np.uint8)
    labels = cv2.connectedComponents(cv2.threshold(levels, 0, 255, cv2.THRESH_OTSU)[1])[1]
    hand = labels == np.bincount(labels[middle & (labels > 0)]).argmax()
    assert np.array_equal(segment(patch, settings) > 0, hand)


@given(st.integers(0, 255), st.integers(2, 96))
def test_a_flat_patch_gives_finite_numbers(grey: int, size: int) -> None:
    vectors = contour_vectors(np.full((1, size, size, 3), grey, np.uint8))
    assert vectors.shape == (1, contour_length())
    assert np.isfinite(vectors).all()


@given(st.integers(0, 2**32 - 1))
def test_noise_gives_finite_numbers(seed: int) -> None:
    patches = np.random.default_rng(seed).integers(0, 256, (2, 48, 48, 3)).astype(np.uint8)
    assert np.isfinite(contour_vectors(patches)).all()


def test_an_empty_mask_has_no_outline() -> None:
    assert outline(np.zeros((20, 20), np.uint8)) is None
    single = np.zeros((20, 20), np.uint8)
    single[4, 4] = 255
    assert outline(single) is None


@pytest.mark.parametrize("fingers", [2, 3, 4])
def test_gaps_between_fingers_are_deep_defects(fingers: int) -> None:
    contour = outline(drawn_hand(fingers))
    assert contour is not None
    depths = defect_depths(contour) / 256
    between = depths[depths > 0.2]
    assert len(between) == fingers - 1


def test_numbers_of_a_square() -> None:
    square = np.zeros((256, 256), np.uint8)
    square[64:192, 64:192] = 255
    contour = outline(square)
    assert contour is not None
    numbers = contour_numbers(contour, WIDE)
    area, solidity, extent, aspect, circularity, defects = numbers[:SHAPE_NUMBERS]
    assert area == pytest.approx(0.25, abs=0.01)
    assert solidity == pytest.approx(1.0)
    assert extent == pytest.approx(1.0, abs=0.02)
    assert aspect == pytest.approx(1.0)
    assert circularity == pytest.approx(np.pi / 4, abs=0.01)
    assert defects == 0


def test_a_fist_is_rounder_and_fuller_than_an_open_hand() -> None:
    fist, open_hand = outline(drawn_hand(0)), outline(drawn_hand(4))
    assert fist is not None
    assert open_hand is not None
    of_fist, of_open = contour_numbers(fist, WIDE), contour_numbers(open_hand, WIDE)
    assert of_fist[1] > of_open[1] + 0.1
    assert of_fist[4] > of_open[4] + 0.2


def test_the_signature_of_a_mirror_image_runs_backwards() -> None:
    mask = drawn_hand(2)
    contour, mirrored = outline(mask), outline(np.ascontiguousarray(mask[:, ::-1]))
    assert contour is not None
    assert mirrored is not None
    forward = radial_signature(contour, 24)
    backward = radial_signature(mirrored, 24)
    # Direction d along x becomes 12 - d.
    np.testing.assert_allclose(backward, forward[(12 - np.arange(24)) % 24], atol=0.05)


def test_the_signature_does_not_depend_on_size_or_place() -> None:
    contour = outline(drawn_hand(3))
    assert contour is not None
    larger = radial_signature(contour * 3 + 500, 24)
    np.testing.assert_allclose(larger, radial_signature(contour, 24), atol=0.02)


def slow_signature(contour: np.ndarray, directions: int) -> list[float]:
    """One point of the outline at a time."""
    moments = cv2.moments(contour)
    x, y = moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]
    reaches = [0.0] * directions
    for across, down in (contour - np.array([x, y])).tolist():
        direction = math.floor(math.atan2(down, across) / (2 * math.pi) * directions + 0.5) % directions
        reaches[direction] = max(reaches[direction], math.hypot(across, down) / moments["m00"] ** 0.5)
    return [
        reach or min(reaches[place - 1], reaches[(place + 1) % directions])
        for place, reach in enumerate(reaches)
    ]


@pytest.mark.parametrize("directions", [5, 8, 24, 25, 90])
def test_the_signature_equals_the_slow_reference(directions: int) -> None:
    for fingers in range(5):
        contour = outline(drawn_hand(fingers, 48))
        assert contour is not None
        expected = slow_signature(contour, directions)
        np.testing.assert_allclose(radial_signature(contour, directions), expected, rtol=1e-12)


@example(8958, 3)  # where rounding decides about a pixel
@given(st.integers(0, 2**32 - 1), st.integers(0, 6))
def test_the_outline_of_a_patch_is_that_of_its_segment(seed: int, blur: int) -> None:
    """Whether what is kept hangs together, lies in pieces or has pieces in its holes; and whatever is beside it."""
    patches = np.random.default_rng(seed).integers(0, 256, (2, 32, 32, 3)).astype(np.uint8)
    if blur:
        patches = np.stack([cv2.GaussianBlur(patch, (0, 0), blur / 2) for patch in patches])
    for patch, vector in zip(patches, contour_vectors(patches), strict=True):
        contour = outline(segment(patch))
        numbers = np.zeros(contour_length(), np.float32) if contour is None else contour_numbers(contour)
        np.testing.assert_allclose(vector, numbers, atol=1e-6)


def test_a_flat_patch_without_a_bump_has_no_outline() -> None:
    patch = np.full((1, 32, 32, 3), 90, np.uint8)
    assert not contour_vectors(patch, ContourSettings(prior=0.0)).any()
