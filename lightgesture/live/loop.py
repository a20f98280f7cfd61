"""The loop of live decoding: newest picture, pipeline, records out, a heartbeat each second."""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from statistics import median
from typing import Final, Protocol

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import InputError
from lightgesture.fsm import State
from lightgesture.live.reader import Mailbox, Report, Snapshot
from lightgesture.pipeline import Pipeline
from lightgesture.records import (
    FrameRecord,
    HeartbeatRecord,
    Record,
    SummaryRecord,
    VehicleRecord,
    utc_text,
)
from lightgesture.results import DebugPictures
from lightgesture.sources import to_image
from lightgesture.watch import Watch

HEARTBEAT_S: Final = 1.0
"""Seconds from one heartbeat record to the next."""

POLL_S: Final = 0.1
"""Longest wait for a picture, seconds, and so how late a request to stop is heeded."""

BREATH_S: Final = 0.001
"""Pause before each picture, seconds, in which the other threads get the core; without it records are some milliseconds
older where the core is busy."""

SILENCE_S: Final = 5.0
"""Seconds without a picture after which one message says so."""


class Outlet(Protocol):
    """Where records go; it never blocks. `is_gone`: nobody takes them any more."""

    @property
    def is_gone(self) -> bool: ...

    def put(self, record: Record) -> None: ...


class Listener(Protocol):
    """Is shown every processed picture; a page for a browser is one."""

    def show(self, image_bgr: NDArray[np.uint8] | None, records: Sequence[Record]) -> None:
        """Take note of a picture and its records, at once: the decoder waits for this call. `vehicle` records come
        from another thread than the rest.

        image_bgr: uint8 (height, width, 3), BGR; it may be kept, but not changed. None for records that belong to no
        picture: heartbeats, and at the end what was pending and the summary. records: the frame record first, given
        also where the user wants none in the results, then what the picture led to.
        """
        ...


class LiveLoop:
    """Takes the newest picture from `mailbox` whenever the last one is done.

    source: the name in the heartbeats. pipeline: must give frame records, which listeners need. frames: whether they
    go to the outlets too. clock: seconds since the start, the same as that of the reader. report: takes messages.
    heartbeat_s: seconds from one heartbeat record to the next. start_utc: the moment at which `clock` was 0.
    """

    def __init__(
        self,
        source: str,
        mailbox: Mailbox,
        pipeline: Pipeline,
        outlets: Sequence[Outlet],
        *,
        clock: Callable[[], float],
        report: Report,
        listeners: Sequence[Listener] = (),
        frames: bool = False,
        debug: DebugPictures | None = None,
        heartbeat_s: float = HEARTBEAT_S,
        start_utc: datetime | None = None,
    ) -> None:
        self._source, self._mailbox, self._pipeline, self._outlets = source, mailbox, pipeline, outlets
        self._clock, self._report, self._listeners = clock, report, listeners
        self._frames, self._debug, self._heartbeat_s = frames, debug, heartbeat_s
        self._processed = self._unreadable = 0
        self._watch = Watch()
        self._start_utc = pipeline.start_utc = start_utc
        self._spent_ms: list[float] = []
        self._state = "idle"
        self._seen_s = clock()
        self._is_silent = False

    def run(self, stopping: threading.Event) -> None:
        """Decode until `stopping` is set, the stream ends for good, or nobody takes the records any more."""
        beat_s = self._clock() + self._heartbeat_s
        while not stopping.is_set() and not self._is_unheard():
            # The thread that reads and those that send come first, so that the next picture is the newest there is and
            # the last record is out: on one core they would else wait until this thread's turn is over.
            time.sleep(BREATH_S)
            wait_s = min(POLL_S, max(0.0, beat_s - self._clock()))
            snapshot = self._mailbox.take(wait_s)
            if snapshot is not None:
                self.take_in(snapshot)
            elif self._mailbox.is_closed:
                break
            now_s = self._clock()
            if now_s >= beat_s:
                self.beat(now_s)
                # After a stall one beat makes up for those that were missed.
                beat_s = max(beat_s + self._heartbeat_s, now_s)
        self._publish(None, self._finish())

    def tell(self, record: VehicleRecord) -> None:
        """Publish what a vehicle did; from any thread, also while a picture is decoded."""
        utc = utc_text(self._start_utc, record.time_s)
        self._publish(None, [replace(record, source=self._source, utc=utc)])

    @property
    def processed(self) -> int:
        """Pictures that went through the pipeline."""
        return self._processed

    def _finish(self) -> list[Record]:
        records = self._pipeline.finish()
        if self._watch.is_blank and isinstance(records[-1], SummaryRecord):
            records[-1] = replace(records[-1], status="failed")
        return records

    def _is_unheard(self) -> bool:
        return not self._listeners and bool(self._outlets) and all(outlet.is_gone for outlet in self._outlets)

    def take_in(self, snapshot: Snapshot) -> None:
        """Decode a picture and publish what comes of it; one that cannot be read is passed over."""
        start = time.perf_counter()
        try:
            image = to_image(snapshot.content)
        except InputError as error:
            self._unreadable += 1
            if self._unreadable == 1:
                self._report(
                    f"{self._source}: picture {snapshot.index} {error}; such pictures are passed over"
                )
            return
        if self._debug is not None:
            self._debug.select(snapshot.time_s)
        records: list[Record] = []
        if (hole := self._watch.look(image, snapshot.time_s)) is not None:
            records += self._pipeline.interrupt(hole, snapshot.time_s, snapshot.index)
        records += self._pipeline.process(image, snapshot.time_s, snapshot.index)
        self._spent_ms.append((time.perf_counter() - start) * 1e3)
        self._processed += 1
        self._seen_s, self._is_silent = snapshot.time_s, False
        self._publish(image, records)

    def beat(self, now_s: float) -> None:
        """Publish a sign of life, at `now_s` seconds."""
        spent_ms = round(median(self._spent_ms), 3) if self._spent_ms else 0.0
        self._spent_ms.clear()
        beat = HeartbeatRecord(
            source=self._source,
            time_s=round(now_s, 3),
            utc=utc_text(self._start_utc, now_s),
            frames=self._processed,
            dropped=self._mailbox.dropped,
            ms_per_frame=spent_ms,
            state=self._state,
        )
        self._publish(None, [beat])
        if now_s - self._seen_s > SILENCE_S and not self._is_silent:
            self._is_silent = True
            self._report(f"{self._source}: no picture for {now_s - self._seen_s:.0f} s")

    def _publish(self, image: NDArray[np.uint8] | None, records: Sequence[Record]) -> None:
        for record in records:
            if isinstance(record, State):
                self._state = record.state
            if isinstance(record, FrameRecord) and not self._frames:
                continue
            for outlet in self._outlets:
                outlet.put(record)
        for listener in self._listeners:
            listener.show(image, records)
