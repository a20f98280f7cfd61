"""Reading less often: a hand that is held still is spared, one that changed or is in doubt is read at once."""

from collections import namedtuple

import cv2
import numpy as np
import pytest

from lightgesture.hands.looks import CHANGED, STANDS_S, LastLooks
from lightgesture.hands.memory import ReadingMemory, memory_for_sentences, middle
from lightgesture.hands.reading import ReadingSettings, ReadingStage

BOX = (200, 150, 90, 110)
SURE = np.array([0.97, 0.02, 0.01], np.float32)
DOUBT = np.array([0.6, 0.3, 0.1], np.float32)


def scene(fingers=5, shift=0.0, noise=0, seed=0):
    """A drawn hand in BOX, its fingers from the left; shift: pixels to the right; noise: deviation, grey levels."""
    picture = np.full((480, 640, 3), (140, 100, 50), np.uint8)
    x, y, width, height = BOX
    middle_x = x + width / 2 + shift
    cv2.circle(
        picture, (round(16 * middle_x), 16 * (y + height - 35)), 16 * 32, (120, 160, 215), -1, cv2.LINE_AA, 4
    )
    for finger in range(fingers):
        end = middle_x - 36 + 18 * finger
        start = round(16 * middle_x), 16 * (y + height - 40)
        cv2.line(picture, start, (round(16 * end), 16 * (y + 8)), (120, 160, 215), 11, cv2.LINE_AA, 4)
    grain = np.random.default_rng(seed).normal(0.0, max(noise, 1e-9), picture.shape)
    return np.clip(picture + grain, 0, 255).round().astype(np.uint8)


def keep(looks, picture, row=SURE, time_s=10.0):
    looks.keep(picture, 1, BOX, (row, 0, row[None], time_s), time_s)
    return looks


def kept(row=SURE, **options):
    return keep(LastLooks(), scene(**options), row)


@pytest.mark.parametrize("noise", [0, 2, 6])
def test_the_reading_of_a_still_hand_stands_in_noise(noise):
    looks = kept(noise=noise)
    look = looks.standing(scene(noise=noise, seed=1), 1, BOX, 10.033)
    assert look is not None
    assert look.row is SURE


@pytest.mark.parametrize("fingers", [0, 1, 2, 3, 4])
def test_a_changed_sign_is_read_at_once(fingers):
    assert kept().standing(scene(fingers), 1, BOX, 10.033) is None
    assert kept(fingers=fingers).standing(scene(fingers + 1), 1, BOX, 10.033) is None


def test_a_moved_hand_is_read_at_once_even_where_its_box_stays():
    assert kept().standing(scene(shift=0.3), 1, BOX, 10.033) is not None
    assert kept().standing(scene(shift=8), 1, BOX, 10.033) is None
    x, y, width, height = BOX
    assert kept().standing(scene(), 1, (x + 30, y, width, height), 10.033) is None


@pytest.mark.parametrize("time_s", [10.001 + STANDS_S, 9.9, float("nan"), 12.0])
def test_a_reading_stands_for_a_moment_only(time_s):
    assert kept().standing(scene(), 1, BOX, time_s) is None


def test_what_was_in_doubt_or_of_another_hand_does_not_stand():
    assert kept(DOUBT).standing(scene(), 1, BOX, 10.033) is None
    looks = kept()
    keep(looks, scene(), DOUBT, 10.033)
    assert looks.standing(scene(), 1, BOX, 10.05) is None
    assert kept().standing(scene(), 2, BOX, 10.033) is None
    assert kept().standing(scene(), None, BOX, 10.033) is None
    looks = kept()
    looks.keep_only([2])
    assert looks.standing(scene(), 1, BOX, 10.033) is None


def test_the_bound_goes_by_the_contrast_of_the_place():
    dim = (scene() // 8 + 60).astype(np.uint8)
    looks = keep(LastLooks(), dim)
    changed = (scene(4) // 8 + 60).astype(np.uint8)
    assert looks.standing(changed, 1, BOX, 10.033) is None
    assert 0.0 < CHANGED < 1.0


Tracked = namedtuple("Tracked", "number side box alternatives certainty")


class Counting:
    """Names a hand by its fingers, and counts how often it is asked."""

    classes = ("5", "4", "none")

    def __init__(self):
        self.asked = 0
        self.row = SURE

    def probabilities(self, image, boxes, sides):
        self.asked += len(boxes)
        return np.array([self.row] * len(boxes), np.float32)


def read(stage, memory, picture, frame, alternatives=()):
    hand = Tracked(1, "left", BOX, alternatives, 1.0)
    (found,) = stage.process(picture, [hand], None, memory, frame / 30)
    return found


def test_of_three_frames_of_a_still_hand_one_is_read():
    classifier, memory = Counting(), memory_for_sentences(0.4)
    stage = ReadingStage(classifier)
    for frame in range(30):
        assert read(stage, memory, scene(noise=2, seed=frame), frame).token == "5"
    assert classifier.asked == 10


def test_no_changed_sign_is_taken_for_the_old_one():
    """Whatever the phase, the frame that shows another sign is read, and so is each after it until it is sure."""
    for phase in range(3):
        classifier, memory = Counting(), memory_for_sentences(0.4)
        stage = ReadingStage(classifier)
        for frame in range(6 + phase):
            read(stage, memory, scene(), frame)
        before, classifier.row = classifier.asked, DOUBT
        for frame in range(6 + phase, 10 + phase):
            read(stage, memory, scene(4), frame)
        assert classifier.asked == before + 4


def test_without_memory_and_at_ten_frames_a_second_every_frame_is_read():
    for memory, rate in ((None, 1), (ReadingMemory(1), 1), (memory_for_sentences(0.4), 3)):
        classifier = Counting()
        for frame in range(0, 6 * rate, rate):
            read(ReadingStage(classifier), memory, scene(), frame)
        assert classifier.asked == 6


def test_other_extents_are_read_where_they_can_change_the_answer():
    classifier, memory = Counting(), memory_for_sentences(0.4)
    stage = ReadingStage(classifier, ReadingSettings(extents="mean"))

    def asked(frame, fingers, row):
        before, classifier.row = classifier.asked, row
        hand = read(stage, memory, scene(fingers), frame, (BOX,))
        return classifier.asked - before, hand

    assert asked(0, 5, SURE)[0] == 2
    # The picture changed a little and the box says surely what all said: the other extent is not asked.
    assert asked(1, 4, SURE)[0] == 1
    # It may be spared no longer than a reading stands.
    assert asked(4, 5, SURE)[0] == 2
    # Where the box is in doubt, or says another sign, it is.
    assert asked(5, 4, DOUBT)[0] == 2
    assert asked(6, 5, SURE)[0] == 2
    assert asked(7, 4, SURE[[1, 0, 2]])[0] == 2


@pytest.mark.parametrize("count", range(1, 9))
def test_the_quick_median_is_the_median(count):
    rows = np.random.default_rng(count).random((count, 11)).astype(np.float32)
    assert middle(rows).tolist() == np.median(rows, axis=0).tolist()
