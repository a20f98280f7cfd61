"""Instructions a frame, counted by callgrind: `python -m lightgesture.benchmarks.instructions`.

A busy machine changes every time, and no count. A fixed run of the bundled clip's frames is counted by valgrind's
callgrind, which shows the program a processor of its own: the libraries choose the same code on every machine whose
processor has AVX2. What was counted is compared with the baseline beside this file; `--write` makes a new one.
"""

import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, Final

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.cli import exit_status
from lightgesture.console import messages_shown, print_line, say
from lightgesture.errors import ExitStatus, InputError
from lightgesture.results.atomic import replacing
from lightgesture.sources import DEFAULT_FPS, open_source

BASELINE: Final = Path(__file__).with_name("instructions.json")
"""Counts of the last release, by kind of processor."""
SIZE: Final = (640, 480)
"""Width and height of the frames, pixels."""
FIRST: Final = 60
"""Frame of the clip with which the run begins: both hands are in view."""
WARM_UP, FOLLOWED, SEARCHED = 8, 30, 8
"""Frames before the counting starts, of the stream that is counted, and of those, searched as single pictures."""
TOLERANCE: Final = 0.05
"""Share by which a count may exceed the baseline's where the libraries are the same."""
TOLERANCE_OTHER: Final = 0.3
"""The same where one of the libraries is of another version."""
LIBRARIES: Final = ("numpy", "opencv-python-headless", "ai-edge-litert")
PARTS: Final = ("searched", "followed")
"""What is counted, in the order of the run."""
ENVIRONMENT: Final = {"PYTHONHASHSEED": "0", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def write_frames(path: Path) -> None:
    """The frames of the run as an array, made here so that no video is decoded under valgrind."""
    import cv2
    import numpy as np

    with open_source(SAMPLE) as source:
        images = [frame.image for frame, _ in zip(source, range(FIRST + WARM_UP + FOLLOWED), strict=False)]
    frames = [cv2.resize(image, SIZE, interpolation=cv2.INTER_AREA) for image in images[FIRST:]]
    np.save(path, np.array(frames))


def run_counted(
    path: Path, begin: Callable[[], object] = os.getppid, end: Callable[[], object] = os.getpgrp
) -> None:
    """What the counted process does with the frames in a file: the pictures that are searched, then the frames that are
    followed. `begin` and `end` are called before and after each; callgrind's are calls of the system that nothing else
    makes."""
    import cv2
    import numpy as np

    from lightgesture.pipeline import Pipeline

    cv2.setNumThreads(1)
    frames = np.load(path)
    pipeline = Pipeline()
    for index, frame in enumerate(frames[:WARM_UP]):
        pipeline.process(frame, index / DEFAULT_FPS)
    begin()
    for frame in frames[:SEARCHED]:
        pipeline.recognize(frame)
    end()
    stream = pipeline.for_stream(None)
    for index, frame in enumerate(frames):
        if index == WARM_UP:
            begin()
        stream.process(frame, index / DEFAULT_FPS)
    end()


def count(folder: Path) -> dict[str, int]:
    """Instructions a frame of each part, in thousands. InputError: valgrind failed."""
    frames, dumps = folder / "frames.npy", folder / "counts"
    write_frames(frames)
    command = [
        "valgrind",
        "--tool=callgrind",
        "--zero-before=getppid",
        "--dump-before=getpgrp",
        f"--callgrind-out-file={dumps}",
        *(sys.executable, "-m", "lightgesture.benchmarks.instructions", "--counted", str(frames)),
    ]
    run = subprocess.run(
        command, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True, check=False
    )
    if run.returncode:
        raise InputError(f"valgrind: {run.stderr.strip().splitlines()[-1]}; look whether it runs here at all")
    counted = (SEARCHED, FOLLOWED)
    return {
        part: round(read_total(Path(f"{dumps}.{number}")) / frames_of / 1000)
        for number, (part, frames_of) in enumerate(zip(PARTS, counted, strict=True), start=1)
    }


def read_total(path: Path) -> int:
    """Instructions that a callgrind file sums up. InputError: it has no such line."""
    with path.open(encoding="utf-8", errors="replace") as lines:
        for line in lines:
            if line.startswith("summary:"):
                return int(line.split()[1])
    raise InputError(f"{path}: has no line `summary:`; run it again with another version of valgrind")


def processor() -> str:
    """The kind of processor that a count is of."""
    try:
        has_avx2 = "avx2" in Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        has_avx2 = False
    return platform.machine() + ("-avx2" if has_avx2 else "")


def versions() -> dict[str, str]:
    """Of all that runs in a frame besides this program."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = ""
    return found


def compare(
    counts: Mapping[str, int], known: Mapping[str, Any] | None, used: Mapping[str, str], tolerance: float
) -> tuple[Table, bool]:
    """The table of counts beside the baseline's, and whether all keep to it; without a baseline they do.

    known: {"versions": …, "thousands": …} of this kind of processor. tolerance: share above it that is allowed.
    """
    before: Mapping[str, int] = {} if known is None else known["thousands"]
    rows: list[dict[str, Cell]] = []
    keeps = True
    is_alike = known is not None and known["versions"] == used
    allowed = tolerance if is_alike else max(tolerance, TOLERANCE_OTHER)
    for part, thousands in counts.items():
        was = before.get(part)
        ratio = None if was is None else thousands / was
        keeps &= ratio is None or ratio <= 1.0 + allowed
        rows.append({"part": part, "thousands": thousands, "baseline": was, "ratio": ratio})
    note = f"allowed: {1.0 + allowed:.2f} times the baseline" if before else "no baseline for this processor"
    if before and not is_alike:
        note += ", which is of other versions of the libraries"
    columns = ("part", "thousands", "baseline", "ratio")
    return Table("instructions", "Instructions a frame, thousands", columns, tuple(rows), note), keeps


def run(args: argparse.Namespace) -> int:
    """Count, compare, write where asked; 0 where all keeps to the baseline or nothing can be counted."""
    if shutil.which("valgrind") is None:
        say("valgrind is not installed, so no instructions are counted: apt-get install valgrind")
        return ExitStatus.OK
    with tempfile.TemporaryDirectory() as folder:
        counts = count(Path(folder))
    baseline = json.loads(BASELINE.read_text(encoding="utf-8")) if BASELINE.is_file() else {}
    table, keeps = compare(counts, baseline.get(processor()), versions(), args.tolerance)
    print_line(to_text([table]))
    if args.write:
        baseline[processor()] = {"versions": versions(), "thousands": counts}
        with replacing(BASELINE) as temporary:
            temporary.write_text(json.dumps(baseline, indent=1) + "\n", encoding="utf-8")
        say(f"wrote {BASELINE}")
        return ExitStatus.OK
    if not keeps:
        say("a frame takes more instructions than before: find out why, or accept it with --write")
        return ExitStatus.SOME_FAILED
    return ExitStatus.OK


@messages_shown()
def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.instructions",
        description="Instructions a frame by callgrind, compared with the baseline.",
    )
    parser.add_argument("--write", action="store_true", help="make what is counted the new baseline")
    parser.add_argument(
        "--tolerance",
        type=float,
        default=TOLERANCE,
        metavar="SHARE",
        help=f"by which a count may exceed the baseline (default {TOLERANCE:g})",
    )
    parser.add_argument("--counted", metavar="FILE", help="only run the frames, as the counted process does")
    args = parser.parse_args(argv)
    if args.counted:
        run_counted(Path(args.counted))
        return ExitStatus.OK
    return exit_status(lambda: run(args), "nothing was counted")


if __name__ == "__main__":
    sys.exit(main())
