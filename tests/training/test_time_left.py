"""The time that is left, from the pace of what was done since the start."""

import time
from itertools import pairwise

import pytest

from lightgesture.training.time_left import NeverSilent, Pace, TimeLeft, tenths


@pytest.mark.parametrize(
    ("passed", "done", "words"),
    [
        (0.0, 40, "time left unknown"),
        (10.0, 60, "20 s left"),
        (120.0, 60, "4 min left"),
        (7200.0, 60, "4.0 h left"),
        (7200.0, 100, "done"),
    ],
)
def test_what_was_there_before_tells_nothing_of_the_pace(passed, done, words):
    now = [5.0]
    left = TimeLeft(100, 40, lambda: now[0])
    now[0] += passed
    assert left.told(done) == words


def test_every_tenth_of_each_step_is_a_line():
    lines = []
    show = tenths(lines.append)
    for done in range(1, 41):
        show("draw", done, 40)
    assert len(lines) == 10
    assert lines[0].startswith("draw: 4 of 40, ")
    assert lines[-1] == "draw: 40 of 40, done"


def test_a_step_of_unknown_length_is_a_line_each_half_minute():
    now = [5.0]
    lines = []
    show = tenths(lines.append, lambda: now[0])
    for done in range(1, 71):
        show("describe", done, 0)
        now[0] += 1.0
    assert lines == ["describe: 31 so far", "describe: 61 so far"]


def test_a_slow_step_tells_its_time_within_a_minute_and_each_minute():
    now = [0.0]
    pace = Pace(60000, 0, lambda: now[0])
    told = []
    for step in range(1, 301):
        now[0] += 1.0
        if (left := pace.line(step)) is not None:
            told.append((now[0], left))
    assert told[0] == (20.0, "16.7 h left")
    gaps = [later - sooner for (sooner, _), (later, _) in pairwise(told)]
    assert gaps
    assert max(gaps) <= 60


def test_a_step_without_parts_is_told_of():
    lines = []
    with NeverSilent(lines.append, silent_s=0.05) as progress:
        progress("reading 9 hands")
        end = time.monotonic() + 10.0
        while len(lines) < 3 and time.monotonic() < end:
            time.sleep(0.01)
    assert lines[0] == "reading 9 hands"
    assert lines[1] == "still at work, 0 s after: reading 9 hands"
    count = len(lines)
    time.sleep(0.1)
    assert len(lines) == count, "it ends with its block"
