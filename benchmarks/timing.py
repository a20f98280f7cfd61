"""Timing of calls and of the pipeline's stages, with a fixed number of threads and after a warm-up."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.pipeline import Pipeline
from lightgesture.sources import DEFAULT_FPS
from lightgesture.stage_clock import StageClock

Image = NDArray[np.uint8]
Times = Mapping[str, Sequence[float]]
"""Milliseconds of every call, by what was called."""

FRAME = "frame, all stages"
SINGLE = "single picture"


@dataclass(frozen=True, slots=True)
class LatencySettings:
    """What is timed, and how often.

    size: width and height of the frames, pixels; 640 x 480 is that of the published figures.
    rounds: passes over a clip; more make the percentiles steadier.
    warm_up: frames before the clock starts, for caches and the birth of tracks.
    threads: numbers of threads to measure, of OpenCV and of NumPy's linear algebra alike.
    most_frames: frames of a clip that are used.
    sequence: the group of the data folder that is timed beside the bundled clip.
    starts: new processes whose start is timed, 1 to 20.
    """

    size: tuple[int, int] = (640, 480)
    rounds: int = 5
    warm_up: int = 10
    threads: tuple[int, ...] = (1, 2)
    most_frames: int = 150
    sequence: str = "hover"
    starts: int = 5


@contextmanager
def limited_threads(count: int) -> Iterator[None]:
    """Give OpenCV and the linear algebra behind NumPy so many threads, and restore what was set before.

    Where other work keeps the cores busy, the spinning threads of the latter can multiply the time of a
    small matrix product, so that one without the other would measure chance.
    """
    # It comes with scikit-learn.
    from threadpoolctl import threadpool_limits

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
    pipeline = Pipeline(model=model)
    seen = 0

    def process(frame: Image) -> None:
        nonlocal seen
        if seen == settings.warm_up:
            pipeline.front.clock = StageClock()
        pipeline.process(frame, seen / DEFAULT_FPS)
        seen += 1

    whole = time_calls(process, frames, settings)
    stages = {name: list(times) for name, times in pipeline.front.clock.stages_ms.items()}
    single = time_calls(pipeline.recognize, frames, settings)
    return {**stages, FRAME: whole, SINGLE: single}
