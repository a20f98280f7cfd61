"""Where the reading of hands changes its mind: edges, faces, other hands, time, and how surely something was read."""

from collections import namedtuple
from dataclasses import replace

import numpy as np
import pytest

from lightgesture.features.track.kalman import start_box
from lightgesture.features.track.state import begin
from lightgesture.features.types import HandRegion
from lightgesture.hands.hidden import STILL, HiddenHands
from lightgesture.hands.looks import STANDS_S, SURE, LastLooks, says_the_same
from lightgesture.hands.memory import (
    MOST_FRAMES,
    ReadingMemory,
    memory_for_hold,
    memory_for_sentences,
    middle,
)
from lightgesture.hands.reading import ReadingSettings, ReadingStage, clearest, is_crowded, read_token

CLASSES = ("0", "5", "none")
PICTURE = np.zeros((480, 640, 3), np.uint8)
Seen = namedtuple("Seen", "number side box alternatives certainty", defaults=((), 1.0))


class Named:
    """Gives each box the row that a test has for it, and keeps what it was asked."""

    classes = CLASSES

    def __init__(self, rows, otherwise=(0.9, 0.05, 0.05)):
        self.rows, self.otherwise, self.asked = rows, otherwise, []

    def probabilities(self, image, boxes, sides):
        self.asked.append(list(zip(boxes, sides, strict=True)))
        return np.array([self.rows.get(box, self.otherwise) for box in boxes], np.float32)


def reads(box, row=(0.99, 0.005, 0.005), **settings):
    """Token and reason of a hand in a box of a picture of 640 by 480 pixels."""
    stage = ReadingStage(Named({box: row}), ReadingSettings(**settings))
    (hand,) = stage.process(PICTURE, [Seen(1, "left", box)])
    return hand.token, hand.reason


@pytest.mark.parametrize(
    ("box", "cut"),
    [
        ((100, 100, 200, 100), False),
        ((8, 100, 200, 100), True),  # a twenty-fifth of its own side
        ((9, 100, 200, 100), False),
        ((100, 4, 200, 100), True),
        ((100, 5, 200, 100), False),
        ((432, 100, 200, 100), True),
        ((431, 100, 200, 100), False),
        ((100, 376, 200, 100), True),
        ((100, 375, 200, 100), False),
    ],
)
def test_the_edge_cuts_a_hand_that_is_within_a_share_of_its_own_side(box, cut):
    told = reads(box, row=(0.9, 0.05, 0.05), edge_share=0.04)
    assert told == ((None, "partial") if cut else ("0", None))


@pytest.mark.parametrize(
    ("others", "face", "expected"),
    [
        ([], (100.0, 200.0), True),
        ([], (99.9, 200.0), False),
        ([], (139.9, 279.9), True),
        ([], (140.0, 240.0), False),
        ([], (120.0, 280.0), False),
        ([], (120.0, 199.9), False),
        # Forty by eighty pixels: a quarter is ten of its forty columns, or twenty of its eighty rows.
        ([(130, 0, 90, 900)], None, False),
        ([(129, 0, 90, 900)], None, True),
        ([(20, 0, 90, 900)], None, False),
        ([(20, 0, 91, 900)], None, True),
        ([(0, 260, 900, 90)], None, False),
        ([(0, 259, 900, 90)], None, True),
        ([(0, 130, 900, 90)], None, False),
        ([(0, 130, 900, 91)], None, True),
        ([(0, 300, 900, 90), (100, 200, 40, 80)], None, True),
        ([(200, 290, 40, 80)], None, False),  # beside it in both ways
    ],
)
def test_a_hand_is_crowded_by_the_middle_of_a_face_or_from_a_quarter_covered_on(others, face, expected):
    assert is_crowded((100, 200, 40, 80), others, face) is expected
    assert is_crowded((100, 200, 40, 80), others, face, ReadingSettings(covered_share=1.0)) is (
        face is not None and expected
    )


def test_only_the_other_hands_crowd_a_hand():
    stage = ReadingStage(Named({}, otherwise=(0.75, 0.15, 0.1)))
    one, other = Seen(1, "left", (100, 100, 60, 60)), Seen(2, "right", (110, 100, 60, 60))
    assert [hand.reason for hand in stage.process(PICTURE, [one])] == [None]
    assert [hand.reason for hand in stage.process(PICTURE, [one, other])] == ["occluded"] * 2


@pytest.mark.parametrize(
    ("confidence", "at_edge", "crowded", "token"),
    [
        (0.5, False, False, "0"),
        (0.499, False, False, None),
        (1.0, True, False, "0"),
        (0.999, True, False, None),
        (0.625, False, True, "0"),
        (0.624, False, True, None),
        (0.999, True, True, None),
    ],
)
def test_how_likely_a_token_must_be_where_it_is(confidence, at_edge, crowded, token):
    settings = ReadingSettings(token_probability=0.5, edge_factor=0.5, crowded_factor=0.8)
    row = np.array([confidence, 0.0, 0.0])
    assert read_token(row, CLASSES, at_edge, crowded, settings)[0] == token


def test_none_is_no_token_however_clear():
    rows = np.array([[0.1, 0.3, 0.6], [0.2, 0.0, 0.8], [0.31, 0.0, 0.69]], np.float32)
    assert clearest(rows, CLASSES) == 2
    assert clearest(rows[:2], CLASSES) == 0
    assert clearest(rows, ("none", "0", "5")) == 1


# What is read of a hand with several extents

OWN, WIDE, TALL = (100, 100, 60, 60), (100, 100, 80, 60), (100, 100, 60, 80)


@pytest.mark.parametrize(
    ("wide", "tall", "box", "token"),
    [
        ((0.0, 0.95, 0.05), (0.8, 0.1, 0.1), WIDE, "5"),
        ((0.8, 0.1, 0.1), (0.0, 0.95, 0.05), TALL, "5"),
        ((0.1, 0.8, 0.1), (0.1, 0.8, 0.1), OWN, "0"),
    ],
)
def test_the_box_that_is_told_is_the_one_that_was_read(wide, tall, box, token):
    stage = ReadingStage(Named({WIDE: wide, TALL: tall}))
    (hand,) = stage.process(PICTURE, [Seen(3, None, OWN, (WIDE, TALL))])
    assert (hand.box, hand.token, hand.side, hand.track) == (box, token, "right", 3)
    assert sum(hand.probabilities.values()) == pytest.approx(1.0)


def test_all_hands_are_asked_about_at_once_each_with_its_side():
    named = Named({})
    one, other = Seen(1, "left", OWN, (WIDE,)), Seen(2, None, (300, 100, 60, 60))
    ReadingStage(named).process(PICTURE, [one, other])
    assert named.asked == [[(OWN, "left"), (WIDE, "left"), ((300, 100, 60, 60), "right")]]


def test_other_extents_are_asked_about_anew_only_where_the_box_says_something_else():
    named, memory = Named({OWN: (0.97, 0.02, 0.01)}), ReadingMemory(5)
    stage, hand = ReadingStage(named), [Seen(1, "left", OWN, (WIDE, TALL))]
    noise = np.random.default_rng(0)

    def asked(time_s):
        named.asked.clear()
        picture = noise.integers(0, 256, PICTURE.shape).astype(np.uint8)  # never the same place
        stage.process(picture, hand, None, memory, time_s)
        return [[box for box, _ in one] for one in named.asked]

    assert asked(1.0) == [[OWN, WIDE, TALL]]
    assert asked(1.03) == [[OWN]]
    named.rows[OWN] = (0.02, 0.97, 0.01)
    assert asked(1.06) == [[OWN], [WIDE, TALL]]
    assert asked(1.09) == [[OWN]]
    assert asked(1.06 + STANDS_S + 0.001) == [[OWN, WIDE, TALL]]


# What stands for a moment


def look(row=(0.95, 0.03, 0.02), others_s=1.0):
    looks = LastLooks()
    row = np.array(row, np.float32)
    looks.keep(PICTURE, 1, OWN, (row, 0, row[None], others_s), 1.0)
    return looks


@pytest.mark.parametrize(
    ("time_s", "x", "expected"),
    [
        (1.0, 100, True),
        (0.999, 100, False),
        (1.0 + STANDS_S - 0.001, 100, True),
        (1.0 + STANDS_S + 0.001, 100, False),
        (1.05, 110, True),  # overlaps by five sevenths
        (1.05, 111, False),
    ],
)
def test_how_long_and_where_a_reading_stands(time_s, x, expected):
    box = (x, 100, 60, 60)
    assert (look().standing(PICTURE, 1, box, time_s) is not None) == expected
    assert (look().recent(1, box, time_s) is not None) == expected


def test_a_look_is_recent_by_its_other_extents():
    assert look(others_s=0.95).recent(1, OWN, 1.03) is not None
    assert look(others_s=0.93).recent(1, OWN, 1.03) is None
    assert look().recent(None, OWN, 1.03) is None
    assert look().recent(2, OWN, 1.03) is None


@pytest.mark.parametrize(("sure", "expected"), [(SURE, True), (SURE - 0.01, False)])
def test_how_sure_a_reading_must_be_to_stand(sure, expected):
    row = (np.float32(sure) + np.float32(1e-6), 0.05, 0.05)
    assert (look(row).standing(PICTURE, 1, OWN, 1.03) is not None) == expected
    last = look((0.95, 0.03, 0.02)).recent(1, OWN, 1.0)
    assert says_the_same(np.array(row, np.float32), last) == expected
    assert not says_the_same(np.array(row, np.float32)[::-1], last)


# Memory


@pytest.mark.parametrize(("rows", "expected"), [([3, 1, 2], 2), ([4, 1, 2, 8], 3), ([7], 7), ([1, 3], 2)])
def test_the_middle_of_rows(rows, expected):
    assert middle(np.array(rows, np.float32)[:, None])[0] == expected


def told(memory, values, step_s):
    """What a memory makes of values that come `step_s` apart, each written out as one class."""
    return [
        float(memory.steady(1, np.array([v], np.float32), 8 + n * step_s)[0]) for n, v in enumerate(values)
    ]


def test_a_memory_looks_at_so_many_frames_and_at_none_older_than_its_seconds():
    values = [1, 9, 5, 3, 3, 9, 9]
    assert told(ReadingMemory(3), values, 0.125) == [1, 9, 5, 5, 3, 3, 9]
    assert told(ReadingMemory(4), values, 0.125) == [1, 9, 5, 4, 4, 4, 6]
    assert told(ReadingMemory(9, 0.25), values, 0.125) == [1, 9, 5, 5, 3, 3, 9]
    assert told(ReadingMemory(9, 0.24), values, 0.125) == values
    assert told(ReadingMemory(1), values, 0.125) == values
    assert told(ReadingMemory(2), values, 0.125) == values


@pytest.mark.parametrize(("hold", "frames"), [(3, 1), (8, 2), (9, 3), (15, 5), (1, 1)])
def test_a_third_of_a_hold_in_frames_is_looked_at(hold, frames):
    values = [float(n * n) for n in range(12)]
    assert told(memory_for_hold(hold, None), values, 1.0) == told(ReadingMemory(frames), values, 1.0)


def test_the_memory_of_a_hold_in_seconds_is_bounded_in_frames():
    values = [float(n * n) for n in range(200)]
    for memory, seconds in ((memory_for_hold(None, 0.75), 0.25), (memory_for_sentences(0.5), 0.251)):
        assert told(memory, values, 1 / 16) == told(ReadingMemory(MOST_FRAMES, seconds), values, 1 / 16)
    assert told(memory_for_hold(None, 90.0), values, 0.01) == told(ReadingMemory(31), values, 0.01)
    assert told(memory_for_hold(None, None), values, 0.01) == values


def test_readings_stand_only_where_several_frames_are_looked_at():
    assert ReadingMemory(1).looks is None
    assert ReadingMemory(2).looks is not None


# Hidden hands


@pytest.mark.parametrize(
    ("across", "down", "expected"),
    [
        (0.0, 0.0, True),
        (STILL, 0.0, True),
        (STILL + 0.01, 0.0, False),
        (0.0, -STILL - 0.01, False),
        (1.5, 1.5, False),
    ],
)
def test_a_hand_is_still_by_its_own_size_in_any_direction(across, down, expected):
    def moving(key, missed):
        region = HandRegion(
            (0, 0, 90, 40), np.zeros((0, 2), np.int32), None, 0.9
        )  # 60 is the root of its area
        one = begin(key, 0, region, 0.0)
        x, y, width, height = start_box(region.box)
        motion = x._replace(velocity=60 * across), y._replace(velocity=60 * down), width, height
        return replace(one, motion=motion, missed=missed)

    hidden = HiddenHands()
    assert not hidden.process([moving(1, 0), moving(2, 0)])
    assert hidden.process([moving(1, 1), moving(2, 1)]) is expected
