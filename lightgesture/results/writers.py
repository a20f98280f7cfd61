"""Writers of record files, one a format, and the table of them."""

import json
import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Protocol

from lightgesture.records import Record
from lightgesture.results.atomic import replacing
from lightgesture.results.spreadsheet import open_spreadsheet
from lightgesture.results.subtitles import open_subtitles

_SEPARATORS = (",", ":")


class Writer(Protocol):
    """Takes the records of one input, in order."""

    def write(self, record: Record) -> None: ...


def to_json_line(record: Record, encoding: str = "utf-8") -> str:
    """One JSON object on one line, without the line feed; escaped where `encoding` lacks a character."""
    content = record.to_dict()
    text = json.dumps(content, ensure_ascii=False, separators=_SEPARATORS)
    try:
        text.encode(encoding)
    except UnicodeEncodeError:  # a narrow terminal, or a file name that is no UTF-8
        return json.dumps(content, separators=_SEPARATORS)
    return text


class JsonPrinter:
    """Gives one JSON object a line to `print_line`; encoding: that of the stream."""

    def __init__(self, print_line: Callable[[str], object], encoding: str = "utf-8") -> None:
        self._print_line = print_line
        self._encoding = encoding

    def write(self, record: Record) -> None:
        """Print a record."""
        self._print_line(to_json_line(record, self._encoding))


@contextmanager
def open_json_lines(path: Path) -> Iterator[Writer]:
    """Write a `.jsonl` file that appears under its name when the block ends well."""
    with replacing(path) as temporary, open(temporary, "w", encoding="utf-8", newline="\n") as stream:
        yield JsonPrinter(lambda line: stream.write(line + "\n"))


WRITERS: dict[str, Callable[[Path, str], AbstractContextManager[Writer]]] = {
    ".jsonl": lambda path, name: open_json_lines(path),  # noqa: ARG005 - every record has the name already
    ".csv": lambda path, name: open_spreadsheet(path),  # noqa: ARG005 - likewise
    ".vtt": open_subtitles,
}
"""Suffix of a record file to what opens it for writing, given its path and the name of the input."""


def open_writer(path: str | os.PathLike[str], name: str) -> AbstractContextManager[Writer]:
    """Open the writer that belongs to the suffix of `path`; ValueError: there is none. name: of the input."""
    place = Path(path)
    if place.suffix not in WRITERS:
        raise ValueError(f"{place}: no writer for {place.suffix!r}; known are {', '.join(WRITERS)}")
    return WRITERS[place.suffix](place, name)
