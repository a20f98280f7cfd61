"""The seam between pictures and the decoder: whatever reads signs from pictures is a front end."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from copy import copy
from typing import Any, Self

from lightgesture.features.types import Image
from lightgesture.fsm import Signs
from lightgesture.stage_clock import StageClock


class FrontEnd(ABC):
    """Reads the diver's signs from the frames of one stream: hands, cards, a recording, a test.

    A front end needs `process` alone. What it remembers of a stream must be forgotten by `for_stream`. It may call
    `clock.lap(name)` after each of its stages, so that the summary tells their times.
    """

    clock: StageClock

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
