"""Time of finding hands alone, with either selector and either run-time of the nets, and what a fresh start costs."""

import json
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Final

import numpy as np

from lightgesture.benchmarks.finding.pipelines import Stages, finding_pipeline
from lightgesture.benchmarks.scorer import percentile
from lightgesture.benchmarks.tables import Cell, Table
from lightgesture.benchmarks.timing import PEAK_MEMORY, SIZE, WARM_UP, Image, limited_threads
from lightgesture.features.colour import ColourMap
from lightgesture.features.find.classical import ClassicalSelector
from lightgesture.features.find.selector import SELECTORS, SelectorName, load_selector
from lightgesture.features.find.selector_file import load_classical
from lightgesture.features.types import Box, Candidates
from lightgesture.front_end import StageClock
from lightgesture.hands import Finder
from lightgesture.sources import DEFAULT_FPS

LITERT = "ai_edge_litert"
"""Module of the run-time; without it the nets run by NumPy."""
NUMBA = "numba"
"""Module of the compiler of the classical choice; without it NumPy loops."""

STARTS: Final = 5
"""New processes whose start is timed."""

SEARCHED, FOLLOWED = "frame, searched", "frame, followed"
PARTS = ("colour", "regions", "tracks")
"""Stages of the pipeline that find hands."""

TIMES_NOTE = (
    "frame: colour, regions and tracks together, in one thread; searched: the whole picture, also after a look at the "
    "predicted\nboxes that was not enough; followed: that look was enough; share: of the clip's frames. The classical "
    "choice only searches."
)
STARTS_NOTE = (
    "seconds from the start of a new Python to the records of its first frame, everything loaded from warm disks; "
    "peak_mb: its\nlargest resident memory, with the classifier, in units of 1,048,576 bytes."
)


@dataclass(frozen=True, slots=True)
class Engine:
    """A selector with what runs its nets or its loops. is_plain: NumPy, as where there is no LiteRT or no numba."""

    selector: SelectorName
    is_plain: bool = False

    @property
    def name(self) -> str:
        """Name of the run-time."""
        quick = "numba" if self.selector == "classical" else "LiteRT"
        return "NumPy" if self.is_plain else quick

    @property
    def hides(self) -> str:
        """The module that is hidden from a process in which this one is timed, empty for none."""
        return (NUMBA if self.selector == "classical" else LITERT) if self.is_plain else ""


def engines() -> list[Engine]:
    """What can be timed here."""
    modules = {"learned": LITERT, "classical": NUMBA}
    found = []
    for selector in SELECTORS:
        found += [Engine(selector)] if find_spec(modules[selector]) is not None else []
        found.append(Engine(selector, is_plain=True))
    return found


@contextmanager
def without_litert() -> Iterator[None]:
    """As on a machine on which the run-time is not installed."""
    hidden = {name: module for name, module in sys.modules.items() if name.split(".")[0] == LITERT}
    for name in hidden:
        del sys.modules[name]
    sys.modules[LITERT] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        del sys.modules[LITERT]
        sys.modules.update(hidden)


class WatchedRegions:
    """A region stage that tells of each frame whether it was searched as a whole."""

    def __init__(self, stage: Finder) -> None:
        self._stage = stage
        self.settings = stage.settings
        self.searches = 0

    def process(self, colour: ColourMap) -> Candidates:
        """Search one frame."""
        self.searches += 1
        return self._stage.process(colour)

    def follow(self, image: Image, boxes: Sequence[Box]) -> Candidates | None:
        """Look at predicted boxes."""
        return self._stage.follow(image, boxes)


def open_stage(engine: Engine) -> Finder:
    """The bundled selector with its run-time."""
    if engine == Engine("classical", is_plain=True):
        return ClassicalSelector(load_classical())
    if not engine.is_plain:
        return load_selector(engine.selector)
    with without_litert():
        return load_selector(engine.selector)


def time_finding(frames: Sequence[Image], engine: Engine, rounds: int) -> list[dict[str, Cell]]:
    """Rows of one clip: whole frames that were searched and followed, then their stages."""
    regions = WatchedRegions(open_stage(engine))
    pipeline = finding_pipeline(Stages(regions=lambda: regions))
    is_searched: list[bool] = []
    shown = [frames[index % len(frames)] for index in range(WARM_UP)] + [*frames] * rounds
    for index, frame in enumerate(shown):
        if index == WARM_UP:
            pipeline.front.clock = StageClock()
            is_searched.clear()
        before = regions.searches
        pipeline.process(frame, index / DEFAULT_FPS)
        is_searched.append(regions.searches > before)
    searched = np.array(is_searched)
    times = pipeline.front.clock.stages_ms
    parts = {name: np.array(times[name]) for name in PARTS}
    whole = np.sum(list(parts.values()), axis=0)
    rows = []
    for name, chosen in ((SEARCHED, searched), (FOLLOWED, ~searched)):
        word = name.split()[-1]
        kinds = {name: whole, **{f"{part}, {word}": times for part, times in parts.items()}}
        rows += [_row(kind, times[chosen], len(searched)) for kind, times in kinds.items() if chosen.any()]
    return [{"selector": engine.selector, "nets": engine.name, **row} for row in rows]


def _row(stage: str, times: Iterable[float], frames: int) -> dict[str, Cell]:
    values = [float(value) for value in times]
    return {
        "stage": stage,
        "share": len(values) / frames,
        "median_ms": percentile(values, 50),
        "p95_ms": percentile(values, 95),
    }


def finding_times(clips: Mapping[str, Sequence[Image]], rounds: int) -> Table:
    """Every clip with every engine, in one thread."""
    rows: list[dict[str, Cell]] = []
    with limited_threads(1):
        for clip, frames in clips.items():
            for engine in engines():
                rows += [{"clip": clip, **row} for row in time_finding(frames, engine, rounds)]
    width, height = SIZE
    columns = ("clip", "selector", "nets", "stage", "share", "median_ms", "p95_ms")
    return Table("finding", f"Finding hands at {width} x {height}", columns, tuple(rows), TIMES_NOTE)


FRESH_START = """
import json, sys, time
if "{hides}":
    sys.modules["{hides}"] = None
import cv2
cv2.setNumThreads(1)
import numpy
from lightgesture.pipeline import Pipeline
pipeline = Pipeline(selector="{selector}", rule="frames")
pipeline.process(numpy.random.default_rng(0).integers(0, 255, ({height}, {width}, 3), numpy.uint8), 0.0)
print(json.dumps([time.time(), peak_memory()]))
"""
"""What a new process runs, after PEAK_MEMORY."""


def fresh_start(engine: Engine) -> tuple[float, float | None]:
    """Seconds to the first frame and peak memory (MB, None where the system does not tell) of a new process.

    Raises subprocess.CalledProcessError where it fails.
    """
    width, height = SIZE
    code = PEAK_MEMORY + FRESH_START.format(
        hides=engine.hides, selector=engine.selector, width=width, height=height
    )
    start = time.time()
    command = [sys.executable, "-c", code]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)
    ready, peak = json.loads(answer.stdout.splitlines()[-1])
    return ready - start, peak


def fresh_starts(count: int = STARTS) -> Table:
    """Median of so many starts of each engine."""
    rows: list[dict[str, Cell]] = []
    for engine in engines():
        starts = [fresh_start(engine) for _ in range(count)]
        peaks = [peak for _, peak in starts if peak is not None]
        rows.append(
            {
                "selector": engine.selector,
                "nets": engine.name,
                "starts": len(starts),
                "seconds": percentile([seconds for seconds, _ in starts], 50),
                "peak_mb": percentile(peaks, 50) if peaks else None,
            }
        )
    columns = ("selector", "nets", "starts", "seconds", "peak_mb")
    return Table("starts", "Start of the pipeline in a new process", columns, tuple(rows), STARTS_NOTE)
