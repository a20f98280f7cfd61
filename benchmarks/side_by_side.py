"""One run of all contenders at several sizes, two videos on two cores, and the picture of the times."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.benchmarks.contenders import COPY, decoders, interleave, products, yardsticks
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.benchmarks.timing import Image, limited_threads
from lightgesture.errors import UsageError
from lightgesture.results.atomic import replacing

SIZES: Final = ((640, 480), (1280, 720), (1920, 1080))
"""Widths and heights of the frames, pixels."""
FRAMES: Final = 60
"""Frames of the clip that are used: large ones fill the memory."""
COLUMNS: Final = ("size", "what", "calls", "median_ms", "p95_ms", "p99_ms", "copies")
NOTE: Final = (
    "Processor time; all take the same few frames in turn, on one core, in one thread; copies: median over a copy's.\n"
    "followed: the hands alone were looked at; searched: the whole frame was. The classical choice only searches."
)
ONE_VIDEO: Final = """
import json, os, sys, time
os.sched_setaffinity(0, {{{core}}})
import cv2, numpy
cv2.setNumThreads(1)
from lightgesture.console import native_messages_muted
from lightgesture.pipeline import Pipeline
from lightgesture.sources import open_source
with open_source({clip!r}) as source:
    frames = [frame.image for frame, _ in zip(source, range({count}))]
with native_messages_muted():
    pipeline = Pipeline()
    pipeline.process(frames[0], 0.0)
print("ready", flush=True)
sys.stdin.readline()
start = time.perf_counter()
for index, image in enumerate(frames * {rounds}):
    pipeline.process(image, (index + 1) / 30)
print(json.dumps(time.perf_counter() - start), flush=True)
"""
"""A process that decodes a clip on one core; it waits for a line so that two begin together."""


@contextmanager
def on_one_core() -> Iterator[None]:
    """Keep this process on the first core that it may use; where the system knows no such thing, as it is."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def scaled(frames: Sequence[Image], size: tuple[int, int]) -> list[Image]:
    """The frames at another size (width, height)."""
    return [np.asarray(cv2.resize(frame, size, interpolation=cv2.INTER_CUBIC), np.uint8) for frame in frames]


def side_by_side(
    frames: Sequence[Image], sizes: Sequence[tuple[int, int]] = SIZES, rounds: int = 3
) -> list[Table]:
    """Times of all contenders at each size, and the stages of the default pipeline."""
    rows: list[dict[str, Cell]] = []
    stages: list[dict[str, Cell]] = []
    with on_one_core(), limited_threads(1):
        for size in sizes:
            shown = scaled(frames, size)
            pipelines, default = products()
            contenders = [*yardsticks(), *pipelines, *decoders(shown)]
            times = interleave(contenders, shown, rounds)
            copy_ms = percentile(times[COPY], 50)
            text = f"{size[0]}x{size[1]}"
            rows += [
                {"size": text, **_row(name, spent), "copies": percentile(spent, 50) / copy_ms}
                for name, spent in times.items()
            ]
            stages += [{"size": text, **_row(name, spent)} for name, spent in default.stages().items()]
    return [
        Table("side_by_side", "Milliseconds a frame, side by side", COLUMNS, tuple(rows), NOTE),
        Table(
            "stages",
            "Stages of the default pipeline, milliseconds by the clock on the wall",
            COLUMNS[:-1],
            tuple(stages),
        ),
    ]


def _row(name: str, spent: Sequence[float]) -> dict[str, Cell]:
    return {
        "what": name,
        "calls": len(spent),
        "median_ms": percentile(spent, 50),
        "p95_ms": percentile(spent, 95),
        "p99_ms": percentile(spent, 99),
    }


def two_videos(clip: Path, count: int = 100, rounds: int = 3) -> Table | None:
    """A video on each of two cores against one alone; None where there are no two cores to choose.

    Raises subprocess.CalledProcessError where a process fails.
    """
    if not hasattr(os, "sched_getaffinity") or len(cores := sorted(os.sched_getaffinity(0))) < 2:
        return None
    alone = max(_decode(clip, cores[:1], count, rounds))
    both = max(_decode(clip, cores[:2], count, rounds))
    row: dict[str, Cell] = {"frames": count * rounds, "alone_s": alone, "both_s": both, "ratio": both / alone}
    note = "both_s: the slower of two processes, each on a core of its own."
    return Table(
        "two_videos", "Two videos on two cores", ("frames", "alone_s", "both_s", "ratio"), (row,), note
    )


def _decode(clip: Path, cores: Sequence[int], count: int, rounds: int) -> list[float]:
    """Seconds of processes that decode the clip at the same time, one on each core."""
    commands = [
        [sys.executable, "-c", ONE_VIDEO.format(core=core, clip=str(clip), count=count, rounds=rounds)]
        for core in cores
    ]
    pipe = subprocess.PIPE
    running = [subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True) for command in commands]
    try:
        for process in running:
            assert process.stdout is not None
            process.stdout.readline()
        for process in running:
            assert process.stdin is not None
            process.stdin.write("\n")
            process.stdin.flush()
        answers = [process.communicate()[0] for process in running]
    finally:
        for process in running:
            process.kill()
            process.wait()
    for process, command in zip(running, commands, strict=True):
        if process.returncode:
            raise subprocess.CalledProcessError(process.returncode, command)
    return [float(json.loads(answer)) for answer in answers]


def draw(rows: Sequence[Mapping[str, Cell]], path: Path) -> None:
    """Bars of the medians with a line to the 99th percentile, a panel for each size, as PNG.

    UsageError: matplotlib (the extra `plots`) is not installed, or the file cannot be written.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise UsageError("--picture needs matplotlib: pip install 'lightgesture[plots]'") from error
    sizes = list(dict.fromkeys(row["size"] for row in rows))
    most = max(sum(row["size"] == size for row in rows) for size in sizes)
    figure = Figure(figsize=(5.5 + 3.5 * len(sizes), 1.5 + 0.28 * most), layout="constrained")
    panels = figure.subplots(1, len(sizes), sharey=True, squeeze=False)[0]
    for axes, size in zip(panels, sizes, strict=True):
        own = [row for row in rows if row["size"] == size]
        medians, tails = ([float(row[key] or 0.0) for row in own] for key in ("median_ms", "p99_ms"))
        places = range(len(own))
        axes.barh(places, medians, color="#1f77b4")
        axes.hlines(places, medians, tails, color="#444444", linewidth=1)
        axes.set_yticks(places, [str(row["what"]) for row in own])
        axes.set_xscale("log")
        axes.set_title(str(size))
        axes.set_xlabel("ms a frame: median, line to p99")
        axes.grid(axis="x", color="#e5e5e5")
    panels[0].invert_yaxis()
    with replacing(path) as temporary:
        figure.savefig(temporary, format="png", dpi=100)
