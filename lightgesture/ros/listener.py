"""Records to topics: what is published under which name, the same in ROS 1 and 2."""

import json
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol

import cv2

from lightgesture.features.types import Image
from lightgesture.fsm import Instruction, State
from lightgesture.records import FrameRecord, HeartbeatRecord, Record
from lightgesture.results.overlay import Overlay
from lightgesture.ros.source import TopicSource

INSTRUCTION, EVENT, STATE = "instruction", "event", "state"
TEXT, ACTION, NUMBER, CHANGE = "text", "action", "number", "change"
TEXTS: Final = (INSTRUCTION, EVENT, STATE, TEXT, ACTION, CHANGE)
"""Topics of std_msgs/String, below the node's name."""
ANNOTATED: Final = "annotated/compressed"
"""Topic of sensor_msgs/CompressedImage, below the node's name."""
DIAGNOSTICS: Final = "/diagnostics"

NO_NUMBER: Final = -1
"""In `number`, where the instruction has none."""

PICTURES_PER_S: Final = 15.0
"""Most annotated pictures a second: each is drawn and encoded, and only while somebody subscribes."""
JPEG_QUALITY: Final = 80
"""Of annotated pictures, 1 to 100."""

OK, WARN, STALE = 0, 1, 3
"""Levels of diagnostic_msgs/DiagnosticStatus."""
QUIET_S: Final = 2.0
"""Seconds without a picture after which the node's diagnostics say STALE."""


class Wire(Protocol):
    """What a node publishes by; every method may be called from any thread and is quick. Names are those above."""

    @property
    def is_watched(self) -> bool:
        """Whether somebody subscribes to the annotated pictures."""
        ...

    def text(self, name: str, value: str) -> None: ...

    def number(self, name: str, value: int) -> None: ...

    def picture(self, jpeg: bytes, header: Any) -> None:
        """header: of the message that the picture came in; None where it is not known."""
        ...

    def diagnostics(self, level: int, message: str, values: dict[str, str]) -> None: ...


class RosListener:
    """Publishes what the live loop shows it, by `wire`; `start` it before and `stop` it after."""

    def __init__(self, wire: Wire, source: TopicSource, clock: Callable[[], float] = time.monotonic) -> None:
        self._wire, self._source, self._clock = wire, source, clock
        self._changed = threading.Condition()
        self._waiting: tuple[Image, int | None] | None = None
        self._undrawn: list[Record] = []
        self._is_stopping = False
        self._seen_s: float | None = None
        self._counts = (0, 0)
        self._thread = threading.Thread(target=self._draw, name="annotated pictures", daemon=True)

    def start(self) -> None:
        """Begin to draw pictures for those who subscribe."""
        self._thread.start()

    def stop(self) -> None:
        """Draw no more."""
        with self._changed:
            self._is_stopping = True
            self._changed.notify()
        self._thread.join()

    def show(self, image_bgr: Image | None, records: Sequence[Record]) -> None:
        """Publish the records, and leave the picture for the thread that draws."""
        for record in records:
            self._publish(record)
        if image_bgr is None:
            return
        self._seen_s = self._clock()
        if not self._wire.is_watched:
            return
        frame = next((record.frame for record in records if isinstance(record, FrameRecord)), None)
        with self._changed:
            self._waiting = image_bgr, frame
            self._undrawn.extend(records)
            self._changed.notify()

    def _publish(self, record: Record) -> None:
        match record:
            case FrameRecord():
                return
            case HeartbeatRecord():
                self._tell_health(record)
            case State():
                self._wire.text(STATE, self._json_of(record))
            case Instruction():
                self._publish_instruction(record)
            case _:
                self._wire.text(EVENT, self._json_of(record))

    def _publish_instruction(self, record: Instruction) -> None:
        numbers = (record.duration_s, record.program, record.parameter)
        number = next((value for value in numbers if value is not None), NO_NUMBER)
        self._wire.number(NUMBER, number)
        self._wire.text(CHANGE, record.change or "")
        self._wire.text(ACTION, record.action)
        self._wire.text(TEXT, record.text)
        self._wire.text(INSTRUCTION, self._json_of(record))

    def _json_of(self, record: Record) -> str:
        """The record as `--json` prints it, with stamp (seconds, nanoseconds) and frame_id of its picture's message."""
        content = record.to_dict()
        header = self._source.header_of(content.get("frame"))
        content["stamp"] = None if header is None else stamp_of(header)
        content["frame_id"] = None if header is None else header.frame_id
        return json.dumps(content)

    def _tell_health(self, beat: HeartbeatRecord) -> None:
        frames, dropped = beat.frames - self._counts[0], beat.dropped - self._counts[1]
        self._counts = beat.frames, beat.dropped
        level, message = OK, beat.state
        if self._seen_s is None or self._clock() - self._seen_s > QUIET_S:
            level, message = STALE, "no pictures"
        elif dropped > frames:
            level, message = WARN, "most pictures are passed over; the machine is too slow or busy"
        values = {
            "pictures": str(beat.frames),
            "passed over": str(beat.dropped),
            "pictures in the last second": str(frames),
            "ms per picture": f"{beat.ms_per_frame:.2f}",
            "state": beat.state,
        }
        self._wire.diagnostics(level, message, values)

    def _draw(self) -> None:
        overlay = Overlay()
        while (work := self._next()) is not None:
            start_s = time.monotonic()
            image, frame, records = work
            drawn = overlay.draw(image, records)
            jpeg = cv2.imencode(".jpg", drawn, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])[1].tobytes()
            self._wire.picture(jpeg, self._source.header_of(frame))
            time.sleep(max(1.0 / PICTURES_PER_S - (time.monotonic() - start_s), 0.0))

    def _next(self) -> tuple[Image, int | None, list[Record]] | None:
        """The newest picture with all records since the last that was drawn; None at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting is not None or self._is_stopping)
            if self._is_stopping or self._waiting is None:
                return None
            (image, frame), self._waiting = self._waiting, None
            records, self._undrawn = self._undrawn, []
            return image, frame, records


def stamp_of(header: Any) -> tuple[int, int]:
    """Seconds and nanoseconds of a header of ROS 2 or ROS 1."""
    stamp = header.stamp
    return (stamp.sec, stamp.nanosec) if hasattr(stamp, "nanosec") else (stamp.secs, stamp.nsecs)
