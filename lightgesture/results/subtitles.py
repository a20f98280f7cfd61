"""Instructions as WebVTT subtitles, which players show under the video.

Written here and not by a library: the format is a header and cues, and what matters in it, harmless texts, the
well-kept `webvtt-py` leaves to its caller: it writes `<` as it stands and refuses `-->`. The tests read our files with
it.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from lightgesture.console import one_line
from lightgesture.fsm import Instruction, Rejected
from lightgesture.records import Record
from lightgesture.results.atomic import replacing

SHOWN_S = 4.0
"""Seconds that a cue stays, unless another takes its place: enough to read it twice."""

LEAST_S = 1.0
"""Seconds that a cue stays even so; then both are seen for a while."""

_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;"})


@dataclass(frozen=True, slots=True)
class _Cue:
    start_s: float
    text: str


class SubtitleWriter:
    """A cue for each instruction and rejection, from the moment it was accepted or rejected."""

    def __init__(self, stream: TextIO, name: str) -> None:
        self._stream = stream
        self._pending: _Cue | None = None
        self._stream.write(f"WEBVTT\n\nNOTE Instructions read from {_harmless(name)}\n")

    def write(self, record: Record) -> None:
        """Append a record, if it is one of the two."""
        match record:
            case Instruction():
                self._begin(record.time_s, _harmless(record.text))
            case Rejected():
                detail = f" ({_harmless(record.detail)})" if record.detail else ""
                self._begin(record.time_s, f"<i>rejected:</i> {_harmless(record.text)}{detail}")
            case _:
                pass

    def finish(self) -> None:
        """Write the last cue."""
        if self._pending is not None:
            self._end(self._pending.start_s + SHOWN_S)

    def _begin(self, time_s: float, text: str) -> None:
        # The starts of cues must not run back, whatever the container's clock does.
        start_s = max(time_s, 0.0)
        if self._pending is not None:
            start_s = max(start_s, self._pending.start_s)
            earliest_s, latest_s = self._pending.start_s + LEAST_S, self._pending.start_s + SHOWN_S
            self._end(min(max(start_s, earliest_s), latest_s))
        self._pending = _Cue(start_s, text)

    def _end(self, end_s: float) -> None:
        if self._pending is not None:
            self._stream.write(
                f"\n{_clock(self._pending.start_s)} --> {_clock(end_s)}\n{self._pending.text}\n"
            )
        self._pending = None


@contextmanager
def open_subtitles(path: Path, name: str) -> Iterator[SubtitleWriter]:
    """Write a `.vtt` file, UTF-8, that appears under its name when the block ends well; name: of the video."""
    with replacing(path) as temporary, open(temporary, "w", encoding="utf-8", newline="\n") as stream:
        writer = SubtitleWriter(stream, name)
        yield writer
        writer.finish()


def _clock(time_s: float) -> str:
    milliseconds = round(time_s * 1000)
    minutes, milliseconds = divmod(milliseconds, 60_000)
    hours, minutes = divmod(minutes, 60)
    return f"{hours:02d}:{minutes:02d}:{milliseconds / 1000:06.3f}"


def _harmless(text: str) -> str:
    """One line without markup; what is not printable, line feeds and stray bytes of names, is escaped."""
    return one_line(text).translate(_ESCAPES)
