"""The executor's thread: a tick and a sign of life to the watchdog, twenty times a second."""

import threading
import time
from collections.abc import Callable, Sequence
from typing import Final

from lightgesture.features.types import Image
from lightgesture.records import Record
from lightgesture.vehicle.executor import Executor
from lightgesture.vehicle.mavlink_vehicle import MavlinkVehicle
from lightgesture.vehicle.motion import Word
from lightgesture.vehicle.profile import Profile
from lightgesture.vehicle.watchdog import Watchdog

TICK_S: Final = 0.05
"""Seconds from one tick to the next: how late a fault is seen at most. Less takes more of a small board's time."""

SETTLE_S: Final = 0.3
"""Seconds for which the middle of the sticks is repeated at the end."""

JOIN_S: Final = 1.0
"""Seconds that the end waits for the thread, which a link that is being opened may hold up."""


class Runner:
    """Runs an executor from `start` to `stop`; a listener of the live loop, too.

    report: takes a line for the user. clock: that of the executor and of the vehicle. ending: set where the program is
    asked to end, which is heeded even if nobody gets as far as `stop`.
    """

    def __init__(
        self,
        executor: Executor,
        vehicle: MavlinkVehicle,
        profile: Profile,
        report: Callable[[str], None],
        clock: Callable[[], float],
        ending: threading.Event | None = None,
    ) -> None:
        self._executor, self._vehicle, self._profile = executor, vehicle, profile
        self._report, self._clock = report, clock
        self._watchdog = Watchdog()
        self._stopping = threading.Event()
        self._ending = ending or self._stopping
        self._words: list[Word] = []
        self._thread = threading.Thread(target=self._run, name="executor", daemon=True)

    @property
    def vehicle(self) -> MavlinkVehicle:
        """Who is told."""
        return self._vehicle

    @property
    def watchdog_pid(self) -> int | None:
        """Number of the watchdog's process, None where there is none."""
        return self._watchdog.pid

    def start(self) -> None:
        """Begin to obey."""
        self._thread.start()

    def stop(self) -> None:
        """Sticks to the middle, and no more obedience."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join(JOIN_S)

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Take note of a picture and its records; from any thread, at once."""
        self._executor.show(image_bgr, records)
        for record in records:
            self._vehicle.note(record)

    def answer(self, word: Word) -> None:
        """Have the vehicle nod or shake at the next tick; from any thread, at once."""
        self._words.append(word)

    def _run(self) -> None:
        try:
            while not self._stopping.is_set() and not self._ending.is_set():
                start_s = time.monotonic()
                self._tick()
                self._stopping.wait(max(0.0, TICK_S - (time.monotonic() - start_s)))
            self._executor.close("the decoder ends")
            self._settle()
        except Exception as error:
            self._report(f"the executor gives up, which is a defect ({type(error).__name__}: {error})")
            self._executor.close("a defect of the executor")
        finally:
            self._watchdog.close()
            self._vehicle.close()

    def _tick(self) -> None:
        while self._words:
            self._executor.answer(self._words.pop(0))
        self._executor.tick(self._clock(), is_watched=self._watchdog.is_ready)
        self._watchdog.sign(self._vehicle.wire(), self._packets())

    def _settle(self) -> None:
        """The last words: the middle of the sticks some times more, and a text for the pilot."""
        end_s = time.monotonic() + SETTLE_S
        while True:
            now_s = self._clock()
            self._vehicle.poll(now_s)
            if not self._executor.holds_sticks or time.monotonic() >= end_s:
                return
            self._executor.settle(now_s)
            time.sleep(TICK_S)

    def _packets(self) -> list[bytes]:
        """What the watchdog sends if we die now: nothing while nothing is done, for the vehicle is its pilot's then."""
        packets = [self._vehicle.neutral_packet()] if self._executor.holds_sticks else []
        if self._executor.goes_on:
            # The last is the one that needs least, and it is sent more than once: two in turn would be a to and fro.
            packets += [self._vehicle.mode_packet(name) for name in self._profile.safety.fault_modes[-1:]]
        return packets
