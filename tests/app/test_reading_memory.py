"""Reading over some frames: a bad frame is bridged, a sign is neither made nor hidden, a lost hand is forgotten."""

import numpy as np
import pytest

from lightgesture.hands.memory import ReadingMemory, memory_for_hold, memory_for_sentences

SIGNS = {"5": (0.9, 0.1), "0": (0.1, 0.9)}


def read(memory, signs, step_s=1 / 30):
    """The likelier sign of each frame; "." is a frame in which the hand is not seen."""
    said = ""
    for index, sign in enumerate(signs):
        memory.keep_only([] if sign == "." else [1])
        if sign != ".":
            row = memory.steady(1, np.array(SIGNS[sign], np.float32), index * step_s)
            said += "50"[int(row.argmax())]
    return said


@pytest.mark.parametrize(
    ("shown", "said"),
    [
        ("55555055555", "55555555555"),
        ("55550055555", "55555555555"),
        # Passing on to another sign takes two frames more, and none of the frames is neither.
        ("5555500000", "5555555000"),
        # What was gone is new.
        ("55555.00000", "5555500000"),
    ],
)
def test_the_middle_of_five_frames(shown, said):
    assert read(memory_for_hold(15, None), shown) == said


def test_a_short_hold_remembers_nothing():
    assert read(memory_for_hold(3, None), "5050505") == "5050505"


@pytest.mark.parametrize(("rate", "bridged"), [(10, 0), (30, 2), (60, 4)])
def test_a_hold_in_seconds_bridges_the_same_time_at_any_rate(rate, bridged):
    memory = memory_for_hold(None, 0.5)
    shown = "5" * rate + "0" * bridged + "5" * rate
    assert read(memory, shown, 1 / rate) == "5" * len(shown)
    shown = "5" * rate + "0" * (bridged + 2) + "5" * rate
    assert "0" in read(memory_for_hold(None, 0.5), shown, 1 / rate)


def test_each_hand_has_its_own_memory_and_pictures_have_none():
    memory = ReadingMemory(5)
    rows = [np.array(SIGNS[sign], np.float32) for sign in "5050505"]
    for number, row in enumerate(rows):
        assert memory.steady(None, row, 0.0) is row
        memory.steady(number % 2, row, 0.0)
    assert memory.steady(0, rows[0], 0.0).argmax() == 0
    assert memory.steady(1, rows[1], 0.0).argmax() == 1


def test_time_that_runs_back_forgets():
    memory = ReadingMemory(5, 0.2)
    for time_s in (1.0, 1.1, 1.2):
        memory.steady(1, np.array(SIGNS["5"], np.float32), time_s)
    assert memory.steady(1, np.array(SIGNS["0"], np.float32), 0.5).argmax() == 1


@pytest.mark.parametrize(("rate", "bridged"), [(10, 1), (30, 3), (60, 6)])
def test_for_sentences_half_of_a_sign_is_looked_at(rate, bridged):
    shown = "5" * rate + "0" * bridged + "5" * rate
    assert "0" not in read(memory_for_sentences(0.4), shown, 1 / rate)
    shown = "5" * rate + "0" * (bridged + 2) + "5" * rate
    assert "0" in read(memory_for_sentences(0.4), shown, 1 / rate)
