"""Palm, arm and wrist on drawn hands, and what the cut is worth on real frames."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lightgesture.features.find.forearms import (
    LEAST_HEIGHT,
    WRIST_DISTANCE,
    arm_direction,
    cut_forearm,
    palm_circle,
)


def _raised_hand(slant_degrees, scale=1.0):
    """Mask of a palm with three fingers upwards and a forearm that leaves it downwards at an angle."""
    mask = np.zeros((round(260 * scale), round(300 * scale)), np.uint8)
    centre = np.array([150, 110]) * scale
    radius = 30 * scale
    cv2.circle(mask, tuple(np.rint(centre).astype(int)), round(radius), 255, cv2.FILLED)
    for x in (-20, 0, 20):
        tip = centre + np.array([x, -75]) * scale
        base = centre + np.array([x, 0]) * scale
        cv2.line(
            mask, tuple(np.rint(base).astype(int)), tuple(np.rint(tip).astype(int)), 255, round(11 * scale)
        )
    angle = np.radians(slant_degrees)
    end = centre + np.array([np.sin(angle), np.cos(angle)]) * 130 * scale
    ends = (tuple(np.rint(point).astype(int)) for point in (centre, end))
    cv2.line(mask, *ends, 255, round(34 * scale))
    return mask, centre, radius


def _outline(mask):
    contours = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0]
    contour = max(contours, key=cv2.contourArea).reshape(-1, 2).astype(np.int32)
    return contour, cv2.boundingRect(contour)


@given(slant=st.floats(-50, 50), scale=st.floats(0.4, 1.5))
@settings(max_examples=40, deadline=None)
def test_a_slanted_forearm_is_cut_across_its_own_direction(slant, scale):
    mask, centre, radius = _raised_hand(slant, scale)
    hand = cut_forearm(*_outline(mask))
    assert hand is not None
    along = np.array([np.sin(np.radians(slant)), np.cos(np.radians(slant))])
    reach = ((hand - centre) @ along).max()
    assert reach == pytest.approx(WRIST_DISTANCE * radius, abs=0.3 * radius)
    assert hand[:, 1].min() == mask.any(axis=1).argmax()


@given(slant=st.floats(-50, 50))
@settings(max_examples=20, deadline=None)
def test_a_mirrored_hand_is_cut_as_its_mirror_image(slant):
    mask, _, _ = _raised_hand(slant)
    boxes = []
    for view in (mask, np.ascontiguousarray(mask[:, ::-1])):
        hand = cut_forearm(*_outline(view))
        assert hand is not None
        boxes.append(cv2.boundingRect(hand))
    x, y, width, height = boxes[1]
    np.testing.assert_allclose(boxes[0], (mask.shape[1] - x - width, y, width, height), atol=4)


def test_a_fist_without_an_arm_stays_whole():
    mask = np.zeros((80, 80), np.uint8)
    cv2.ellipse(mask, (40, 40), (24, 28), 0, 0, 360, 255, cv2.FILLED)
    assert cut_forearm(*_outline(mask)) is None


def test_fingers_upwards_are_no_arm():
    mask, _, _ = _raised_hand(0.0)
    mask[142:] = 0
    centre, radius = palm_circle(mask)
    assert arm_direction(mask, centre, radius) is None


@pytest.mark.parametrize("size", [(1, 1), (1, 60), (60, 1), (3, 3), (40, 40)])
def test_filled_rectangles_of_any_size_are_handled(size):
    mask = np.zeros((size[0] + 2, size[1] + 2), np.uint8)
    mask[1:-1, 1:-1] = 255
    hand = cut_forearm(*_outline(mask))
    assert hand is None or cv2.boundingRect(hand)[3] >= LEAST_HEIGHT


def test_rests_that_balance_about_the_palm_are_no_arm():
    mask = np.zeros((41, 61), np.uint8)
    mask[20, 10:51] = 255
    assert arm_direction(mask, (30, 20), 1.0) is None
    mask[20, 51:55] = 255
    np.testing.assert_allclose(arm_direction(mask, (30, 20), 1.0), (1, 0))
