"""How long each stage takes, for the summary at the end of a stream."""

import time
from collections import defaultdict, deque
from statistics import median, quantiles

KEPT_TIMES = 2_000
"""Frames whose times make the summary's medians, the last ones: a camera that runs for days needs no more memory."""


class StageClock:
    """Milliseconds of each stage and of each frame, kept for the summary."""

    def __init__(self) -> None:
        self._stages: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=KEPT_TIMES))
        self._frames: deque[float] = deque(maxlen=KEPT_TIMES)
        self._started = self._lapped = 0.0

    def start(self) -> None:
        """A frame begins, and with it its first stage."""
        self._started = self._lapped = time.perf_counter()

    def lap(self, stage: str) -> None:
        """The stage that ran until now ends."""
        now = time.perf_counter()
        self._stages[stage].append((now - self._lapped) * 1e3)
        self._lapped = now

    def end_frame(self) -> None:
        """The frame ends with its last stage."""
        self._frames.append((self._lapped - self._started) * 1e3)

    @property
    def frames_ms(self) -> tuple[float, ...]:
        """Milliseconds of each of the last frames, at most KEPT_TIMES."""
        return tuple(self._frames)

    @property
    def stages_ms(self) -> dict[str, tuple[float, ...]]:
        """Stage -> milliseconds in each of the last frames, at most KEPT_TIMES."""
        return {name: tuple(times) for name, times in self._stages.items()}

    def per_frame(self) -> dict[str, float]:
        """Median and 95th percentile, milliseconds a frame; zeros before the first."""
        if not self._frames:
            return {"median": 0.0, "p95": 0.0}
        p95 = quantiles(self._frames, n=20)[-1] if len(self._frames) > 1 else self._frames[0]
        return {"median": round(median(self._frames), 3), "p95": round(p95, 3)}

    def per_stage(self) -> dict[str, float]:
        """Median milliseconds of each stage, in the order in which they run."""
        return {name: round(median(times), 4) for name, times in self._stages.items()}
