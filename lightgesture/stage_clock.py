"""How long each stage takes, for the summary at the end of a stream."""

import time
from collections import defaultdict, deque
from collections.abc import Iterator
from contextlib import contextmanager
from statistics import median, quantiles

STAGES = ("colour", "regions", "tracks", "classify", "decode")
KEPT_TIMES = 2_000
"""Frames whose times make the summary's medians, the last ones: a camera that runs for days needs no more memory."""


class StageClock:
    """Milliseconds of each stage and of each frame, kept for the summary."""

    def __init__(self) -> None:
        self._stages: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=KEPT_TIMES))
        self._frames: deque[float] = deque(maxlen=KEPT_TIMES)
        self._current = 0.0

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time one stage of the current frame."""
        start = time.perf_counter()
        yield
        spent = (time.perf_counter() - start) * 1e3
        self._stages[name].append(spent)
        self._current += spent

    def end_frame(self) -> None:
        """Close the current frame: its time is the sum of its stages."""
        self._frames.append(self._current)
        self._current = 0.0

    def per_frame(self) -> dict[str, float]:
        """Median and 95th percentile, milliseconds a frame; zeros before the first."""
        if not self._frames:
            return {"median": 0.0, "p95": 0.0}
        p95 = quantiles(self._frames, n=20)[-1] if len(self._frames) > 1 else self._frames[0]
        return {"median": round(median(self._frames), 3), "p95": round(p95, 3)}

    def per_stage(self) -> dict[str, float]:
        """Median milliseconds of each stage in the order of the pipeline."""
        return {name: round(median(self._stages[name]), 4) for name in STAGES if self._stages[name]}
