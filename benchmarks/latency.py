"""Time of the pipeline on one machine: `python -m lightgesture.benchmarks.latency`.

Frames are read and scaled to 640 x 480 before the clock starts. Every clip is run with each number of
threads by a pipeline of its own, after a warm-up; the numbers that were set before are restored.
"""

import argparse
import json
import os
import platform
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from time import perf_counter

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.datasets import find_data, group_samples, read_frames
from lightgesture.benchmarks.hand_bank import build_bank
from lightgesture.benchmarks.paper_chain import PaperChain
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.console import print_line, say
from lightgesture.decoding import SAMPLE
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.models import ModelError
from lightgesture.pipeline import Pipeline, StageClock
from lightgesture.sources import DEFAULT_FPS, open_source, read_picture

Image = NDArray[np.uint8]
Times = Mapping[str, Sequence[float]]
"""Milliseconds of every call, by what was called."""

FRAME = "frame, all stages"
SINGLE = "single picture"
PAPER = "paper's region selection"


@dataclass(frozen=True, slots=True)
class LatencySettings:
    """What is timed, and how often.

    size: width and height of the frames, pixels; 640 x 480 is that of the published figures.
    rounds: passes over a clip; more make the percentiles steadier.
    warm_up: frames before the clock starts, for caches and the birth of tracks.
    threads: numbers of threads to measure, of OpenCV and of NumPy's linear algebra alike.
    most_frames: frames of a clip that are used.
    sequence: the group of the data folder that is timed beside the bundled clip.
    """

    size: tuple[int, int] = (640, 480)
    rounds: int = 5
    warm_up: int = 10
    threads: tuple[int, ...] = (1, 2)
    most_frames: int = 150
    sequence: str = "hover"


class RecordingClock(StageClock):
    """A stage clock that keeps every time, in milliseconds."""

    def __init__(self) -> None:
        super().__init__()
        self.times: dict[str, list[float]] = defaultdict(list)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time one stage of the current frame."""
        start = perf_counter()
        with super().stage(name):
            yield
        self.times[name].append((perf_counter() - start) * 1e3)


class TimedPipeline(Pipeline):
    """The pipeline with a clock that keeps every time since `restart_clock`."""

    def __init__(self, model: str) -> None:
        super().__init__(model=model)
        self.restart_clock()

    def restart_clock(self) -> None:
        """Forget all times."""
        self.clock = RecordingClock()
        self._clock = self.clock


@contextmanager
def limited_threads(count: int) -> Iterator[None]:
    """Give OpenCV and the linear algebra behind NumPy so many threads, and restore what was set before.

    Where other work keeps the cores busy, the spinning threads of the latter can multiply the time of a
    small matrix product, so that one without the other would measure chance.
    """
    # It comes with scikit-learn.
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

    before = cv2.getNumThreads()
    cv2.setNumThreads(count)
    try:
        with threadpool_limits(count, user_api="blas"):
            yield
    finally:
        cv2.setNumThreads(before)


def time_calls(
    call: Callable[[Image], object], frames: Sequence[Image], settings: LatencySettings
) -> list[float]:
    """Milliseconds of `call` on every frame of every round, after the warm-up."""
    for index in range(settings.warm_up):
        call(frames[index % len(frames)])
    times = []
    for _ in range(settings.rounds):
        for frame in frames:
            start = perf_counter()
            call(frame)
            times.append((perf_counter() - start) * 1e3)
    return times


def time_pipeline(frames: Sequence[Image], model: str, settings: LatencySettings) -> Times:
    """Times of every stage and of whole frames of a stream, and of frames as single pictures."""
    pipeline = TimedPipeline(model)
    seen = 0

    def process(frame: Image) -> None:
        nonlocal seen
        if seen == settings.warm_up:
            pipeline.restart_clock()
        pipeline.process(frame, seen / DEFAULT_FPS)
        seen += 1

    whole = time_calls(process, frames, settings)
    single = time_calls(pipeline.recognize, frames, settings)
    return {**pipeline.clock.times, FRAME: whole, SINGLE: single}


def measure(
    clips: Mapping[str, Sequence[Image]],
    model: str,
    paper: Callable[[], PaperChain] | None,
    settings: LatencySettings,
) -> list[dict[str, Cell]]:
    """One row per clip, number of threads and stage; paper makes the paper's chain, None leaves it out."""
    rows = []
    for clip, frames in clips.items():
        for threads in settings.threads:
            with limited_threads(threads):
                times = dict(time_pipeline(frames, model, settings))
                if paper is not None:
                    times[PAPER] = time_calls(paper().process, frames, settings)
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


def latency_table(rows: Sequence[Mapping[str, Cell]], settings: LatencySettings) -> Table:
    """The rows as a table."""
    width, height = settings.size
    title = f"Milliseconds a call at {width} x {height}, reading and scaling of the frames not included"
    return Table("latency", title, ("clip", "threads", "stage", "calls", "median_ms", "p95_ms"), tuple(rows))


def read_clips(data: Path | None, settings: LatencySettings) -> dict[str, list[Image]]:
    """The bundled clip and, where there is a data folder, its sequence, scaled to one size."""
    clips: dict[str, list[Image]] = {}
    if SAMPLE.is_file():
        with open_source(SAMPLE) as source:
            images = [frame.image for frame, _ in zip(source, range(settings.most_frames), strict=False)]
        clips[SAMPLE.name] = [_scaled(image, settings) for image in images]
    if data is not None and (data / "frames").is_dir():
        samples = group_samples(read_frames(data)).get(settings.sequence, [])[: settings.most_frames]
        clips[settings.sequence] = [_scaled(read_picture(sample.path), settings) for sample in samples]
    clips = {name: frames for name, frames in clips.items() if frames}
    if not clips:
        raise InputError(
            f"{SAMPLE}: the bundled clip is missing; install again, or name pictures with --data"
        )
    return clips


def _scaled(image: Image, settings: LatencySettings) -> Image:
    return np.asarray(cv2.resize(image, settings.size, interpolation=cv2.INTER_AREA), dtype=np.uint8)


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
    temporary = path.with_name(path.name + ".part")
    try:
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
        temporary.replace(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another with --out") from error


def run(args: argparse.Namespace) -> None:
    """Measure, print the table, write the file."""
    settings = replace(LatencySettings(), rounds=args.rounds)
    data = _find_data(args.data)
    clips = read_clips(data, settings)
    try:
        rows = measure(clips, args.model, _paper_maker(data), settings)
    except ModelError as error:
        raise UsageError(str(error)) from error
    table = latency_table(rows, settings)
    print_line(table.to_text())
    if args.out:
        write_json(
            Path(args.out),
            {"machine": describe_machine(), "settings": asdict(settings), "rows": table.to_dicts()},
        )


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


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number of at least 1")
    return int(text)


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.latency",
        description="Milliseconds per stage on this machine.",
    )
    parser.add_argument("--data", metavar="DIR", help="folder of labelled pictures (default: ../shared/data)")
    parser.add_argument("--model", default="svm", metavar="svm|PATH", help="classifier (default: svm)")
    parser.add_argument("--out", metavar="FILE.json", help="write the figures and the machine here")
    parser.add_argument(
        "--rounds", type=_count, default=LatencySettings().rounds, metavar="N", help="passes over a clip"
    )
    try:
        run(parser.parse_args(argv))
    except InputError as error:
        say(str(error))
        return ExitStatus.SOME_FAILED
    except UsageError as error:
        say(str(error))
        return ExitStatus.USAGE
    return ExitStatus.OK


if __name__ == "__main__":
    sys.exit(main())
