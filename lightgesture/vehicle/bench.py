"""What the steps of a task work with."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from lightgesture.features.types import Image
from lightgesture.fsm import Instruction
from lightgesture.vehicle.interface import Status, Vehicle
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.sticks import Sticks


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture as the decoder saw it: uint8 (height, width, 3), BGR. time_s: the steady clock's, when it was shown."""

    image: Image
    time_s: float


class Helper:
    """One thread for what may take its time, such as writing to a card or running another program; made when needed."""

    def __init__(self) -> None:
        self._pool: ThreadPoolExecutor | None = None

    def start(self, work: Callable[[], str]) -> "Future[str]":
        """Have it done, after what was asked before."""
        if self._pool is None:
            self._pool = ThreadPoolExecutor(1, thread_name_prefix="vehicle helper")
        return self._pool.submit(work)

    def close(self) -> None:
        """What has not begun is left undone."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)


@dataclass(slots=True)
class Bench:
    """Made once by the executor; `status` and `frame` are those of the present tick.

    cap: the furthest that a stick goes, 0 to 1. interval_s: seconds between pictures; None: as the profile says.
    Both are parameters that a diver may change.
    """

    vehicle: Vehicle
    profile: Profile
    sticks: Sticks
    cap: float
    interval_s: float | None = None
    status: Status = field(default_factory=Status)
    frame: Frame | None = None
    helper: Helper = field(default_factory=Helper)


def seconds_of(value: Any, missing: Any, record: Instruction) -> Any:
    """Seconds that a step lasts: a number, or those of the instruction, or what the profile says where it has none."""
    if value != "duration_s":
        return value
    return missing if record.duration_s is None else float(record.duration_s)
