"""The count on another processor: what an emulator prints is read, and told where it breaks off."""

import shlex
import sys

import numpy as np
import pytest

from lightgesture.benchmarks import emulated, instructions
from lightgesture.benchmarks.emulated import count, read_marks

PRINTED = """
LGMARK 0 thread 5 all 1000
LGMARK 1 thread 5 all 9000
LGMARK 2 thread 5 all 20000
LGMARK 3 thread 5 all 50000
"""


def test_instructions_between_two_marks_are_those_of_the_frames():
    # Stands for an emulator: it prints the marks whatever program it is given.
    words = [sys.executable, "-c", f"print({PRINTED!r})"]
    assert count(words) == {"searched": 8000 / emulated.SEARCHED, "followed": 30000 / emulated.FOLLOWED}


def test_a_program_that_does_not_come_to_its_end_is_told():
    with pytest.raises(emulated.InputError, match="Illegal instruction"):
        read_marks("LGMARK 0 thread 1 all 7\nIllegal instruction\n")


def test_an_emulator_that_is_not_there_is_one_line(capsys):
    assert emulated.main(["--emulator", shlex.quote("no such emulator")]) != 0
    assert "cannot be run" in capsys.readouterr().err


def test_the_program_that_is_counted_marks_four_times(tmp_path, monkeypatch):
    frames = tmp_path / "frames.npy"
    np.save(frames, np.zeros((instructions.WARM_UP + 1, 24, 32, 3), np.uint8))
    monkeypatch.setattr(instructions, "SEARCHED", 1)
    marks = []
    instructions.run_counted(frames, lambda: marks.append("begin"), lambda: marks.append("end"))
    assert marks == ["begin", "end", "begin", "end"]
    compile(emulated.PROGRAM.format(root="/root", frames="/frames.npy"), "program", "exec")
