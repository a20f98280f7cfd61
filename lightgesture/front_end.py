"""The seam between pictures and the decoder: whatever reads signs from pictures is a front end, with a clock for its
stages."""

import time
from abc import ABC, abstractmethod
from collections import defaultdict, deque
from collections.abc import Iterator
from copy import copy
from statistics import median, quantiles
from typing import Any, Self

from lightgesture.features.types import Image
from lightgesture.fsm import Signs

KEPT_TIMES = 2_000
"""Frames whose times make the summary's medians, the last ones: a camera that runs for days needs no more memory."""


class StageClock:
    """Milliseconds of each stage and of each frame, kept for the summary."""

    def __init__(self) -> None:
        self._stages: dict[str, deque[float]] = defaultdict(lambda: deque(maxlen=KEPT_TIMES))
        self._frames: deque[float] = deque(maxlen=KEPT_TIMES)
        self._frame: dict[str, float] = {}
        self._started = self._lapped = 0.0

    def start(self) -> None:
        """A frame begins, and with it its first stage."""
        self._started = self._lapped = time.perf_counter()

    def lap(self, stage: str) -> None:
        """The stage that ran until now ends; one that runs again in the same frame adds to its time."""
        now = time.perf_counter()
        self._frame[stage] = self._frame.get(stage, 0.0) + (now - self._lapped) * 1e3
        self._lapped = now

    def end_frame(self) -> None:
        """The frame ends with its last stage."""
        for stage, spent_ms in self._frame.items():
            self._stages[stage].append(spent_ms)
        self._frame.clear()
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


class FrontEnd(ABC):
    """Reads the diver's signs from the frames of one stream: hands, cards, a recording, a test.

    A front end needs `process` alone. What it remembers of a stream must be forgotten by `for_stream`. It may call
    `clock.lap(name)` after each of its stages, so that the summary tells their times.
    """

    clock: StageClock
    tokens: tuple[str, ...] | None = None
    """What it can read, for the grammar to be checked against; None: any word."""

    def __init__(self) -> None:
        self.clock = StageClock()

    @abstractmethod
    def process(self, image: Image, time_s: float) -> Signs:
        """The signs in the next frame. image: uint8 (height, width, 3), BGR. time_s: seconds since the start."""

    def recognize(self, image: Image) -> Signs:
        """The signs of a picture on its own, without memory; what `shown` and `pictures` tell is of it."""
        return self.process(image, 0.0)

    def for_stream(self) -> Self:
        """Another front end for another stream, with what this one has loaded and a clock of its own."""
        other = copy(self)
        other.clock = StageClock()
        return other

    def shown(self) -> dict[str, tuple[Any, ...]]:
        """What the frame record of the last frame shows: fields of `records.FrameRecord`, such as `hands`."""
        return {}

    def pictures(self) -> Iterator[tuple[str, Image]]:
        """Name and picture, uint8 (h, w, 3) BGR, of what each stage made of the last frame."""
        return iter(())
