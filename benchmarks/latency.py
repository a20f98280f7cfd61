"""Time of the pipeline on one machine: `python -m lightgesture.benchmarks.latency`.

Frames are read and scaled before the clock starts. First all ways stand side by side: each takes a few frames in turn,
so that other work on the machine slows all alike. Then every clip is run at 640 x 480 with each number of threads by a
pipeline of its own, after a warm-up; the numbers that were set before are restored.
"""

import argparse
import json
import os
import platform
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from lightgesture.actions.decode import SAMPLE
from lightgesture.benchmarks.finding.latency import STARTS, finding_times, fresh_starts
from lightgesture.benchmarks.paper.bank import build_bank
from lightgesture.benchmarks.paper.chain import PaperChain
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.side_by_side import FRAMES, SIZES, draw, side_by_side, two_videos
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.benchmarks.timing import (
    ROUNDS,
    SIZE,
    THREADS,
    WARM_UP,
    Image,
    limited_threads,
    time_calls,
    time_pipeline,
)
from lightgesture.cli import exit_status
from lightgesture.config.parsers import positive
from lightgesture.console import print_line, say
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.models import ModelError
from lightgesture.results.atomic import replacing
from lightgesture.sources import open_source, read_picture
from lightgesture.training.datasets import find_data, group_samples, read_frames

QUICK_FRAMES: Final = 30
"""Frames of a quick run."""

MOST_FRAMES: Final = 150
"""Frames of a clip that are used."""

SEQUENCE: Final = "hover"
"""The group of the data folder that is timed beside the bundled clip."""

PAPER = "paper's region selection"
"""Row of the baseline's chain."""


def measure(
    clips: Mapping[str, Sequence[Image]],
    model: str,
    paper: Callable[[], PaperChain] | None,
    rounds: int,
) -> list[dict[str, Cell]]:
    """One row per clip, number of threads and stage; paper makes the paper's chain, None leaves it out."""
    rows = []
    for clip, frames in clips.items():
        for threads in THREADS:
            with limited_threads(threads):
                times = dict(time_pipeline(frames, model, rounds))
                if paper is not None:
                    times[PAPER] = time_calls(paper().process, frames, rounds)
            rows += [_row(clip, threads, stage, values) for stage, values in times.items()]
    return rows


def _row(clip: str, threads: int, stage: str, times: Sequence[float]) -> dict[str, Cell]:
    return {
        "clip": clip,
        "threads": threads,
        "stage": stage,
        "calls": len(times),
        "median_ms": percentile(times, 50),
        "p95_ms": percentile(times, 95),
    }


def latency_table(rows: Sequence[Mapping[str, Cell]]) -> Table:
    """The rows as a table."""
    width, height = SIZE
    title = f"Milliseconds a call at {width} x {height}, reading and scaling of the frames not included"
    return Table("latency", title, ("clip", "threads", "stage", "calls", "median_ms", "p95_ms"), tuple(rows))


def read_clips(data: Path | None) -> dict[str, list[Image]]:
    """The bundled clip and, where there is a data folder, its sequence, scaled to one size."""
    clips: dict[str, list[Image]] = {}
    if SAMPLE.is_file():
        with open_source(SAMPLE) as source:
            images = [frame.image for frame, _ in zip(source, range(MOST_FRAMES), strict=False)]
        clips[SAMPLE.name] = [_scaled(image) for image in images]
    if data is not None and (data / "frames").is_dir():
        samples = group_samples(read_frames(data)).get(SEQUENCE, [])[:MOST_FRAMES]
        clips[SEQUENCE] = [_scaled(read_picture(sample.path)) for sample in samples]
    clips = {name: frames for name, frames in clips.items() if frames}
    if not clips:
        raise InputError(
            f"{SAMPLE}: the bundled clip is missing; install again, or name pictures with --data"
        )
    return clips


def _scaled(image: Image) -> Image:
    return np.asarray(cv2.resize(image, SIZE, interpolation=cv2.INTER_AREA), dtype=np.uint8)


def describe_machine() -> dict[str, str | int | None]:
    """What the times depend on."""
    return {
        "machine": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "opencv": cv2.__version__,
        "numpy": np.__version__,
        "cores": os.cpu_count(),
    }


def write_json(path: Path, content: object) -> None:
    """Write a JSON file, whole or not at all. UsageError: it cannot be written."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def run(args: argparse.Namespace) -> int:
    """Measure, print the table, write the file; 0 when all was done."""
    data = None if args.quick else _find_data(args.data)
    clips = read_clips(data)
    shown = next(iter(clips.values()))[-FRAMES:]
    if args.quick:
        tables = [*side_by_side(shown[:QUICK_FRAMES], SIZES[:1], 1), fresh_starts(1)]
    else:
        tables = [*side_by_side(shown), *_by_threads(clips, data, args), fresh_starts()]
    if SAMPLE.is_file() and (videos := two_videos(SAMPLE, rounds=1 if args.quick else 3)):
        tables.append(videos)
    print_line(to_text(tables))
    if args.picture:
        draw(tables[0].to_dicts(), Path(args.picture))
    if args.out:
        found = [row for table in tables for row in table.to_dicts()]
        content = {"machine": describe_machine(), "settings": _told(args.rounds), "rows": found}
        write_json(Path(args.out), content)
    return ExitStatus.OK


def _by_threads(
    clips: Mapping[str, Sequence[Image]], data: Path | None, args: argparse.Namespace
) -> list[Table]:
    """Every clip with each number of threads, and finding alone."""
    try:
        rows = measure(clips, args.model, _paper_maker(data), args.rounds)
    except ModelError as error:
        raise UsageError(str(error)) from error
    return [latency_table(rows), finding_times(clips, args.rounds)]


def _told(rounds: int) -> dict[str, object]:
    """What is timed, and how often, for the file."""
    return {
        "size": SIZE,
        "rounds": rounds,
        "warm_up": WARM_UP,
        "threads": THREADS,
        "most_frames": MOST_FRAMES,
        "sequence": SEQUENCE,
        "starts": STARTS,
    }


def _paper_maker(data: Path | None) -> Callable[[], PaperChain] | None:
    """What makes the paper's chain, None where the pictures for its bank are not there."""
    if data is None or not (data / "hands" / "train.csv").is_file():
        return None
    return partial(PaperChain, build_bank(data))


def _find_data(folder: str | None) -> Path | None:
    """The data folder; None where none was named and none is there, the bundled clip being enough."""
    try:
        return find_data(folder)
    except InputError as error:
        if folder is not None:
            raise
        say(f"{error}; timing the bundled clip alone")
        return None


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.latency",
        description="Milliseconds per stage on this machine.",
    )
    parser.add_argument("--data", metavar="DIR", help="folder of labelled pictures (default: ../shared/data)")
    parser.add_argument("--model", default="cnn", metavar="cnn|svm|PATH", help="classifier (default: cnn)")
    parser.add_argument(
        "--json", "--out", dest="out", metavar="FILE.json", help="write the figures and the machine here"
    )
    parser.add_argument("--picture", metavar="FILE.png", help="draw the times side by side (extra plots)")
    parser.add_argument(
        "--quick", action="store_true", help="one size, few frames and no threads; under a minute"
    )
    parser.add_argument("--rounds", type=positive, default=ROUNDS, metavar="N", help="passes over a clip")
    args = parser.parse_args(argv)
    return exit_status(lambda: run(args), "nothing was written")


if __name__ == "__main__":
    sys.exit(main())
