"""Instructions a frame on another processor: `python -m lightgesture.benchmarks.emulated --emulator WORDS`.

The words begin a Python of that processor under an emulator that counts, QEMU with a plugin say. It needs the packages
that Lightgesture needs, and is given `-c PROGRAM`. Where the program calls the system's `getpid` with the arguments
0x6c67 and a number, the emulator must print `LGMARK NUMBER thread N all M`, M being the instructions so far. They are
those of the frames that `lightgesture.benchmarks.instructions` counts here.
"""

import argparse
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import lightgesture
from lightgesture.benchmarks.instructions import FOLLOWED, SEARCHED, write_frames
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.cli import exit_status
from lightgesture.console import print_line
from lightgesture.errors import ExitStatus, InputError

PROGRAM: Final = """
import ctypes, itertools, pathlib, platform, sys
sys.path.insert(0, {root!r})
from lightgesture.benchmarks.instructions import run_counted
calls = {{"aarch64": 172, "armv7l": 20, "x86_64": 39}}
system, numbers = ctypes.CDLL(None).syscall, itertools.count()
def mark():
    system(calls[platform.machine()], 0x6c67, next(numbers))
run_counted(pathlib.Path({frames!r}), mark, mark)
"""
"""What the emulated Python runs. An environment may not reach it, so that paths are written in."""
MARK: Final = re.compile(r"^LGMARK (\d+) thread \d+ all (\d+)$", re.MULTILINE)
PARTS: Final[Mapping[str, tuple[int, int]]] = {"searched": (0, SEARCHED), "followed": (2, FOLLOWED)}
"""What is counted: the mark with which it begins, and its frames; it ends with the next mark."""


def read_marks(text: str) -> dict[int, int]:
    """Instructions at each mark. InputError: one is missing, so that the program did not come to its end."""
    marks = {int(number): int(total) for number, total in MARK.findall(text)}
    if set(marks) != {0, 1, 2, 3}:
        last = text.strip().splitlines()[-1:] or ["it printed nothing"]
        raise InputError(f"the emulator did not count to the end ({last[0]}); try its command by hand")
    return marks


def count(emulator: Sequence[str]) -> dict[str, float]:
    """Instructions a frame of each part. InputError: the emulator does not run or does not count."""
    with tempfile.TemporaryDirectory() as folder:
        frames = Path(folder, "frames.npy")
        write_frames(frames)
        program = PROGRAM.format(root=str(Path(lightgesture.__file__).parents[1]), frames=str(frames))
        try:
            run = subprocess.run(
                [*emulator, "-c", program], capture_output=True, text=True, errors="replace", check=False
            )
        except OSError as error:
            raise InputError(f"{emulator[0]}: cannot be run ({error.strerror}); name an emulator") from None
    marks = read_marks(run.stdout + run.stderr)
    return {part: (marks[first + 1] - marks[first]) / of for part, (first, of) in PARTS.items()}


def counts_table(counts: Mapping[str, float]) -> Table:
    """The counts in millions."""
    rows: list[dict[str, Cell]] = [
        {"part": part, "frames": PARTS[part][1], "millions": value / 1e6} for part, value in counts.items()
    ]
    title = "Instructions a frame on the emulated processor"
    return Table("emulated", title, ("part", "frames", "millions"), tuple(rows))


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.emulated",
        description="Instructions a frame on another processor, by an emulator that counts.",
    )
    parser.add_argument(
        "--emulator",
        required=True,
        metavar="WORDS",
        help="command that runs that processor's Python and counts",
    )
    args = parser.parse_args(argv)

    def run() -> int:
        print_line(to_text([counts_table(count(shlex.split(args.emulator)))]))
        return ExitStatus.OK

    return exit_status(run, "nothing was counted")


if __name__ == "__main__":
    sys.exit(main())
