"""The time that is left, from the pace of what was done since the start."""

import pytest

from lightgesture.training.time_left import TimeLeft


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
