"""One table of the instructions of all dives in a folder of results, a line each."""

import csv
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path
from typing import Final

from lightgesture.errors import UsageError
from lightgesture.records import utc_text
from lightgesture.results.atomic import replacing
from lightgesture.results.ownership import is_ours
from lightgesture.results.stems import DIVES
from lightgesture.sources import natural_key

NAME: Final = f"{DIVES}.csv"

COLUMNS: Final = ("source", "start_s", "end_s", "start_utc", "end_utc", "sentence", "kind", "confidence")
"""start: of the first sign; end: when the sentence was complete. Seconds from the start of the source, and time of day
(ISO 8601), empty where the source has no clock."""


def refuse_foreign(folder: Path) -> None:
    """UsageError: a file that is none of ours has the table's name."""
    path = folder / NAME
    try:
        with path.open(encoding="utf-8", errors="replace") as stream:
            is_foreign = stream.readline().rstrip("\n") != ",".join(COLUMNS)
    except FileNotFoundError:
        return
    except OSError:
        is_foreign = True
    if is_foreign:
        raise UsageError(
            f"{path}: was not written by this program and would be replaced; name another folder with --out, or move "
            "the file"
        )


def write_dives(folder: Path) -> None:
    """Write the table from the tables of all inputs that lie in the folder, whichever run made them; without any, none.

    UsageError: it cannot be written, or one of these tables was damaged.
    """
    tables = sorted(
        (path for path in folder.glob("*.csv") if is_ours(path)), key=lambda path: natural_key(path.name)
    )
    if not tables:
        return
    with (
        replacing(folder / NAME) as temporary,
        open(temporary, "w", encoding="utf-8", errors="backslashreplace", newline="") as stream,
    ):
        table: csv.DictWriter[str] = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        table.writeheader()
        for path in tables:
            try:
                table.writerows(_rows(path))
            except (csv.Error, KeyError, TypeError, ValueError, OverflowError) as error:
                reason = " ".join(str(error).split())[:200]
                raise UsageError(
                    f"{path}: is damaged ({type(error).__name__}: {reason}); decode its input again, or move it away"
                ) from None


def _rows(path: Path) -> Iterator[dict[str, str]]:
    """The instructions of one input. Cells are safe for spreadsheets already."""
    with path.open(encoding="utf-8", errors="backslashreplace", newline="") as stream:
        for row in csv.DictReader(stream):
            if row["type"] == "instruction":
                yield {
                    "source": row["source"],
                    "start_s": row["start_time_s"],
                    "end_s": row["time_s"],
                    "start_utc": _before(row["utc"], float(row["time_s"]) - float(row["start_time_s"])),
                    "end_utc": row["utc"],
                    "sentence": row["text"],
                    "kind": row["kind"],
                    "confidence": row["confidence"],
                }


def _before(utc: str, seconds: float) -> str:
    if not utc:
        return ""
    start = datetime.fromisoformat(utc) - timedelta(seconds=seconds)
    return utc_text(start, 0.0) or ""
