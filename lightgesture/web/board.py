"""What all browsers are shown: the newest picture, the newest state, the last entries; one writer, many readers.

Nothing is queued. A reader that was slow finds the newest when it looks again, so that the writer never waits for one.
"""

import json
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from lightgesture.features.types import Image
from lightgesture.records import Record
from lightgesture.sinks.answers import SHOWN_S, Mood, advance

ENTRIES = ("instruction", "rejected", "notice", "vehicle")
"""Types of records that are listed."""


ENTRIES_KEPT: Final = 200
"""Instructions, rejections and notices that are kept for who comes later."""


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture to be drawn on, and the records since the one before that was taken."""

    number: int
    image: Image
    records: tuple[Record, ...]


@dataclass(frozen=True, slots=True)
class Update:
    """What is new for one reader. state: for display; entries: those that it has not had, oldest first."""

    version: int
    state: dict[str, Any]
    entries: list[dict[str, Any]]

    def to_events(self, run: str) -> bytes:
        """As server-sent events, the state first, for it tells of a new run.

        JSON has no line feed of its own, so hostile text cannot end an event.
        """
        parts = [f"event: state\ndata: {json.dumps(self.state)}\n\n"]
        parts += [
            f"event: entry\nid: {run}-{entry['number']}\ndata: {json.dumps(entry)}\n\n"
            for entry in self.entries
        ]
        return "".join(parts).encode("ascii")


class Board:
    """The shared state; every method may be called from any thread.

    run: names this run, since numbers begin again in the next. expect: from the sentence so far and the decoder's state
    to the words that may follow; None where nobody knows. obeys: whether a vehicle says what becomes of instructions.
    """

    def __init__(self, expect: Callable[[str, str], list[str]] | None = None, obeys: bool = False) -> None:
        self._mood, self._obeys = Mood(), obeys
        self.run = uuid.uuid4().hex[:12]
        self._changed = threading.Condition()
        self._entries: deque[dict[str, Any]] = deque(maxlen=ENTRIES_KEPT)
        self._state: dict[str, Any] = {
            "state": "idle",
            "sentence": "",
            "dwell": None,
            "hands": [],
            "signs": None,
            "ended": None,
            "expected": [] if expect is None else expect("", "idle"),
        }
        self._expect = expect
        self._entry_count = 0
        self._version = 0
        self._picture: Image | None = None
        self._picture_number = 0
        self._picture_at: float | None = None
        self._undrawn: deque[Record] = deque(maxlen=ENTRIES_KEPT)
        self._jpeg, self._jpeg_number = b"", 0
        self._viewers = 0
        self._is_closed = False

    @property
    def is_closed(self) -> bool:
        """Whether everything is over."""
        return self._is_closed

    def close(self) -> None:
        """Let all who wait go."""
        with self._changed:
            self._is_closed = True
            self._changed.notify_all()

    def post(self, image: Image | None, records: Sequence[Record]) -> None:
        """Take a picture, if there is one, and records. The image is kept, not copied."""
        with self._changed:
            if image is not None:
                self._picture = image
                self._picture_number += 1
                self._picture_at = time.monotonic()
                self._undrawn.extend(records)
            for record in records:
                self._mood = advance(self._mood, record, time.monotonic(), self._obeys)
                self._note(record.to_dict())
            self._version += 1
            self._changed.notify_all()

    def put(self, name: str, value: Any) -> None:
        """Set something of the state that no record tells."""
        with self._changed:
            self._state = {**self._state, name: value}
            self._version += 1
            self._changed.notify_all()

    def update(self, version: int, entry: int, timeout_s: float) -> Update | None:
        """The newest state once it is newer than `version`, with the entries after number `entry`.

        None: nothing new in time, or closed.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._is_closed or self._version > version, timeout_s)
            if self._is_closed or self._version <= version:
                return None
            age = None if self._picture_at is None else round(time.monotonic() - self._picture_at, 1)
            state = {**self._state, "run": self.run, "picture_age_s": age, **self._shown_answer()}
            return Update(self._version, state, [item for item in self._entries if item["number"] > entry])

    def log(self) -> str:
        """The entries that are kept, oldest first, one JSON object a line; `wall_s`: when, seconds since 1970."""
        with self._changed:
            return "".join(json.dumps(entry) + "\n" for entry in self._entries)

    @contextmanager
    def viewing(self) -> Iterator[None]:
        """Within this block somebody looks at pictures, and so they are drawn."""
        self._count_viewers(1)
        try:
            yield
        finally:
            self._count_viewers(-1)

    def picture_to_draw(self) -> Picture | None:
        """Wait for a picture that is not drawn yet, while somebody looks. None: closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_closed or self._is_wanted())
            if self._is_closed or self._picture is None:
                return None
            picture = Picture(self._picture_number, self._picture, tuple(self._undrawn))
            self._undrawn.clear()
            return picture

    def post_jpeg(self, number: int, jpeg: bytes) -> None:
        """Take the drawn picture with this number."""
        with self._changed:
            self._jpeg_number, self._jpeg = number, jpeg
            self._changed.notify_all()

    def jpeg(self, number: int, timeout_s: float) -> tuple[int, bytes] | None:
        """The newest drawn picture and its number, once that is above `number`. None: none in time, or closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_closed or self._jpeg_number > number, timeout_s)
            if self._is_closed or self._jpeg_number <= number:
                return None
            return self._jpeg_number, self._jpeg

    @property
    def viewers(self) -> int:
        """How many look on."""
        return self._viewers

    def _count_viewers(self, change: int) -> None:
        with self._changed:
            self._viewers += change
            self._changed.notify_all()

    def _is_wanted(self) -> bool:
        return self._viewers > 0 and self._picture_number > self._jpeg_number

    def _shown_answer(self) -> dict[str, Any]:
        """What the diver is told: the last answer with its age and the seconds for which it is shown, and what is
        done."""
        answer, tasks = self._mood.answer, sorted(self._mood.tasks)
        age_s = round(time.monotonic() - self._mood.since_s, 2)
        shown = {"answer": answer.value, "age_s": age_s, "shown_s": SHOWN_S[answer]} if answer else None
        return {"answer": shown, "tasks": tasks}

    def _note(self, record: dict[str, Any]) -> None:
        kind = record["type"]
        self._state["source"] = record.get("source")
        self._state["time_s"] = record.get("time_s", self._state.get("time_s"))
        if kind == "frame":
            shown = {"hands": record.get("hands", []), "signs": record.get("signs")}
            self._state |= shown
        elif kind == "state":
            if self._expect is not None and record["sentence"] != self._state["sentence"]:
                self._state["expected"] = self._expect(record["sentence"], record["state"])
            self._state |= {name: record[name] for name in ("state", "sentence", "dwell")}
        elif kind == "heartbeat":
            self._state |= {name: record[name] for name in ("frames", "dropped", "ms_per_frame")}
        elif kind == "summary":
            self._state |= {"ended": record["status"], "hands": [], "signs": None, "dwell": None}
        elif kind in ENTRIES:
            self._entry_count += 1
            self._entries.append({**record, "number": self._entry_count, "wall_s": round(time.time(), 3)})
