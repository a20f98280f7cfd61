"""Instructions and rejections as a table that any spreadsheet opens."""

import csv
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from lightgesture.fsm import Instruction, Rejected
from lightgesture.records import Record
from lightgesture.results.atomic import replacing

COLUMNS: tuple[str, ...] = (
    "type",
    "source",
    "frame",
    "time_s",
    "utc",
    "start_frame",
    "start_time_s",
    "text",
    "kind",
    "action",
    "duration_s",
    "program",
    "parameter",
    "change",
    "confidence",
    "words",
    "reason",
    "detail",
)
"""The fields of both records, named as in JSON; a field that a record lacks is empty."""

_FORMULA = tuple("=+-@\t\r\n\uff1d\uff0b\uff0d\uff20")
"""Signs that begin a formula; some programs take the wide forms of the first four for them too."""


class SpreadsheetWriter:
    """One line for each instruction and rejection, under one line of names."""

    def __init__(self, stream: Any) -> None:
        self._table = csv.DictWriter(stream, COLUMNS, lineterminator="\n", extrasaction="ignore")
        self._table.writeheader()

    def write(self, record: Record) -> None:
        """Append a record, if it is one of the two."""
        if isinstance(record, Instruction | Rejected):
            self._table.writerow({key: _cell(value) for key, value in record.to_dict().items()})


@contextmanager
def open_spreadsheet(path: Path) -> Iterator[SpreadsheetWriter]:
    """Write a `.csv` file, UTF-8, that appears under its name when the block ends well."""
    with (
        replacing(path) as temporary,
        open(temporary, "w", encoding="utf-8", errors="backslashreplace", newline="") as stream,
    ):
        yield SpreadsheetWriter(stream)


def _cell(value: Any) -> Any:
    """A value that no spreadsheet runs: texts that look like a formula, which a file name may, get an apostrophe."""
    text = " ".join(value) if isinstance(value, list) else value
    return f"'{text}" if isinstance(text, str) and text.startswith(_FORMULA) else text
