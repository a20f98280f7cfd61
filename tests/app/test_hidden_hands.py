"""Hands that something hides in their place are shown and not read, so that no sentence goes on without their sign."""

from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.track.kalman import start_box
from lightgesture.features.track.state import begin
from lightgesture.features.types import HandRegion
from lightgesture.hands.hidden import STILL, HiddenHands

SIDE = 40


def track(key, missed=0, speed=0.0):
    """A hand of SIDE by SIDE pixels that moves to the right by so many of its sizes a second."""
    box = (100 * key, 50, SIDE, SIDE)
    across, down, width, height = start_box(box)
    found = begin(key, 0, HandRegion(box, np.zeros((0, 2), np.int32), None, 0.9), 0.0)
    return replace(found, motion=(across._replace(velocity=SIDE * speed), down, width, height), missed=missed)


def answers(*frames):
    hidden = HiddenHands()
    return [hidden.process(tracks) for tracks in frames]


def test_both_hands_that_vanish_in_their_place_are_hidden():
    held = [track(1), track(2)]
    gone = [track(1, missed=1), track(2, missed=1)]
    assert answers(held, gone, gone, held) == [False, True, True, False]


@pytest.mark.parametrize(
    "gone",
    [
        [track(1, missed=1), track(2)],
        [track(1, missed=1)],
        [],
        [track(1, missed=1), track(3, missed=1)],
    ],
)
def test_one_hand_alone_or_another_is_not(gone):
    assert answers([track(1), track(2)], gone) == [False, False]


def test_a_hand_that_was_lowered_is_not():
    lowered = [track(1, speed=STILL + 0.1), track(2)]
    assert answers(lowered, [track(1, missed=1), track(2, missed=1)]) == [False, False]


def test_what_counts_is_how_a_hand_moved_when_it_was_seen():
    held = [track(1, speed=STILL), track(2)]
    predicted = [track(1, missed=1, speed=5.0), track(2, missed=1, speed=5.0)]
    assert answers(held, predicted) == [False, True]
