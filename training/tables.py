"""Tables of comma-separated values as people have them: written by scripts, by Excel, under Windows.

A byte order mark, UTF-16, semicolons or tabs in place of commas, a first line `sep=;`, spaces and capitals in the
header, empty rows, rows without their last cells, and backslashes in paths are read for what is meant. What cannot be
is told with the number of the line.
"""

import codecs
import csv
import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from lightgesture.errors import InputError
from lightgesture.features.files import read_whole

SEPARATORS: Final = ",;\t"
"""What may stand between cells; the one that is most frequent in the header does."""

LARGEST_TABLE: Final = 256 << 20
"""Bytes; a million rows take a hundred million."""

_DECLARED = re.compile(r"sep=(.)\r?\n", re.IGNORECASE)
"""First line by which Excel is told the separator."""


def table_rows(path: Path, columns: Sequence[str], remedy: str) -> Iterator[tuple[int, dict[str, str]]]:
    """Rows of a table as the number of the line and column to text, empty where a row has no such cell.

    columns: those that each row must fill. remedy: what to do where it is no table. InputError: it cannot be read, has
    no such column, or a row is wrong.
    """
    text, skipped, separator = _open(path, remedy)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
    names: list[str] | None = None
    try:
        for cells in reader:
            line = reader.line_num + skipped
            if not any(cell.strip() for cell in cells):
                continue
            if names is None:
                names = _header(path, cells, columns)
            else:
                yield line, _row(f"{path}, line {line}", names, cells, columns)
    except csv.Error as error:
        line = reader.line_num + skipped
        raise InputError(f"{path}, line {line}: is no row of a CSV table ({error}); {remedy}") from None
    if names is None:
        raise InputError(f"{path}: holds nothing, has no column {', '.join(columns)}; {remedy}")


def picture_path(folder: Path, text: str) -> Path:
    """The picture that a cell names, from the table's folder; backslashes part folders where no file has them."""
    path = folder / text
    return folder / text.replace("\\", "/") if "\\" in text and not path.is_file() else path


def _open(path: Path, remedy: str) -> tuple[str, int, str]:
    """The text, the lines left out at its start, and what stands between the cells."""
    text = _decode(path, _read(path, remedy), remedy)
    if declared := _DECLARED.match(text):
        return text[declared.end() :], 1, declared[1]
    header = text.lstrip().partition("\n")[0]
    return text, 0, max(SEPARATORS, key=header.count)


def _read(path: Path, remedy: str) -> bytes:
    try:
        return read_whole(path, LARGEST_TABLE)
    except OSError as error:
        raise InputError(f"{path}: cannot be read as a CSV table ({error.strerror}); {remedy}") from None


def _decode(path: Path, content: bytes, remedy: str) -> str:
    is_wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    encoding = "utf-16" if is_wide else "utf-8-sig"
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        if b"\0" in content:
            raise InputError(f"{path}: cannot be read as a CSV table (is no text); {remedy}") from None
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}, line {line}: cannot be read as a CSV table (is not UTF-8); save it as 'CSV UTF-8'"
        ) from None
    return text


def _header(path: Path, cells: Sequence[str], columns: Sequence[str]) -> list[str]:
    names = [cell.strip().lower() for cell in cells]
    if lacking := sorted(set(columns) - set(names)):
        shown = ", ".join(name for name in names if name)
        raise InputError(
            f"{path}: has no column {', '.join(lacking)}; add it to the header, which has {shown[:80]}"
        )
    return names


def _row(place: str, names: Sequence[str], cells: Sequence[str], columns: Sequence[str]) -> dict[str, str]:
    if any(cell.strip() for cell in cells[len(names) :]):
        raise InputError(
            f"{place}: has {len(cells)} cells, the header {len(names)}; quote cells that hold the separator"
        )
    row = dict.fromkeys(names, "") | {name: cell.strip() for name, cell in zip(names, cells, strict=False)}
    if empty := [name for name in columns if not row[name]]:
        raise InputError(f"{place}: column {', '.join(empty)} is empty; fill it or delete the row")
    return row
