"""The time that is left, from the pace of what was done since the start."""

import pytest

from lightgesture.training.time_left import TimeLeft, tenths


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
