"""Timing of calls and of the pipeline's stages, with a fixed number of threads and after a warm-up."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from time import perf_counter
from typing import Final

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.front_end import StageClock
from lightgesture.pipeline import Pipeline
from lightgesture.sources import DEFAULT_FPS

Image = NDArray[np.uint8]
Times = Mapping[str, Sequence[float]]
"""Milliseconds of every call, by what was called."""

FRAME = "frame, all stages"
SINGLE = "single picture"


SIZE: Final = (640, 480)
"""Width and height of the frames, pixels: those of the published figures."""

ROUNDS: Final = 5
"""Passes over a clip; more make the percentiles steadier."""

WARM_UP: Final = 10
"""Frames before the clock starts, for caches and the birth of tracks."""

THREADS: Final = (1, 2)
"""Numbers of threads to measure, of OpenCV and of NumPy's linear algebra alike."""


PEAK_MEMORY: Final = """
def peak_memory():
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmHWM"))
    except (OSError, StopIteration):
        return None
"""
"""For programs that run in a new process: a function of the most memory that the process had, MB of 1,048,576 bytes,
None where the system does not tell. Its own high-water mark is read: the one of `getrusage` begins at its parent's."""


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


def time_calls(call: Callable[[Image], object], frames: Sequence[Image], rounds: int) -> list[float]:
    """Milliseconds of `call` on every frame of every round, after the warm-up."""
    for index in range(WARM_UP):
        call(frames[index % len(frames)])
    times = []
    for _ in range(rounds):
        for frame in frames:
            start = perf_counter()
            call(frame)
            times.append((perf_counter() - start) * 1e3)
    return times


def time_pipeline(frames: Sequence[Image], model: str, rounds: int) -> Times:
    """Times of every stage and of whole frames of a stream, and of frames as single pictures."""
    pipeline = Pipeline(model=model, rule="frames")
    seen = 0

    def process(frame: Image) -> None:
        nonlocal seen
        if seen == WARM_UP:
            pipeline.front.clock = StageClock()
        pipeline.process(frame, seen / DEFAULT_FPS)
        seen += 1

    whole = time_calls(process, frames, rounds)
    stages = {name: list(times) for name, times in pipeline.front.clock.stages_ms.items()}
    single = time_calls(pipeline.recognize, frames, rounds)
    return {**stages, FRAME: whole, SINGLE: single}
