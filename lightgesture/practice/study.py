"""The table of a group of people who signed the paper's six instructions, one file a person."""

import csv
import io
import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean
from typing import Any, Final

from lightgesture.errors import UsageError
from lightgesture.features.files import read_whole
from lightgesture.practice.tasks import STUDY

LEVELS: Final = ("beginner", "medium", "expert")
PREFIX: Final = "person-"
TABLE: Final = "study.csv"
LARGEST_FILE: Final = 1 << 20
"""Bytes of a person's results; they take some thousands."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,39}")


@dataclass(frozen=True, slots=True)
class Row:
    """One kind of instructions and one level: people, their mean mistakes and seconds over the kind, and sentences that
    were given up; seconds None where nobody signed all of the kind."""

    kind: str
    instructions: int
    gestures: int
    level: str
    people: int
    mistakes: float
    slips: float
    seconds: float | None
    given_up: int


def person_file(folder: str, person: str) -> Path:
    """Where a person's results lie. UsageError: the name makes no file name."""
    if not _NAME.fullmatch(person):
        raise UsageError(
            f"--person {person[:40]!r}: use letters, digits, - and _, 40 at most; a code need not tell a name"
        )
    return Path(folder) / f"{PREFIX}{person}.json"


def read_people(folder: str) -> list[dict[str, Any]]:
    """The results of all people in a folder. UsageError: a file is no such result."""
    people = []
    for path in sorted(Path(folder).glob(f"{PREFIX}*.json")):
        try:
            content = json.loads(read_whole(path, LARGEST_FILE).decode("utf-8"))
            kinds = {
                (item["kind"], item["mistakes"], item["slips"], item["done"]) for item in content["sentences"]
            }
            if content["level"] not in LEVELS or not kinds:
                raise ValueError("it has no level")
            tabulate([content])
        except (OSError, ValueError, LookupError, TypeError, ArithmeticError, RecursionError) as error:
            raise UsageError(f"{path}: is no result of a study ({error}); move it away") from None
        people.append(content)
    return people


def tabulate(people: Iterable[dict[str, Any]]) -> list[Row]:
    """A row for each kind and level that somebody has."""
    by_level = {level: [person for person in people if person["level"] == level] for level in LEVELS}
    kinds = dict.fromkeys(kind for _, kind, _ in STUDY)
    return [_row(kind, level, group) for kind in kinds for level, group in by_level.items() if group]


def _row(kind: str, level: str, group: Sequence[dict[str, Any]]) -> Row:
    each = [[item for item in person["sentences"] if item["kind"] == kind] for person in group]
    whole = [sum(item["seconds"] for item in items) for items in each if all(item["done"] for item in items)]
    return Row(
        kind=kind,
        instructions=sum(other == kind for _, other, _ in STUDY),
        gestures=sum(len(item["signs"]) for item in each[0]),
        level=level,
        people=len(group),
        mistakes=round(fmean(sum(item["mistakes"] for item in items) for items in each), 2),
        slips=round(fmean(sum(item["slips"] for item in items) for items in each), 2),
        seconds=round(fmean(whole), 1) if whole else None,
        given_up=sum(not item["done"] for items in each for item in items),
    )


def to_csv(rows: Sequence[Row]) -> str:
    """The table as CSV."""
    stream = io.StringIO()
    names = Row.__slots__
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(
        [["" if (value := getattr(row, name)) is None else value for name in names] for row in rows]
    )
    return stream.getvalue()


def tell_table(rows: Sequence[Row]) -> list[str]:
    """The table in lines: mean mistakes before success, mean seconds, of each kind and level."""
    lines = [f"  {'kind (instructions, gestures)':<30}{'level':<10}people  mistakes  slips  seconds"]
    for row in rows:
        kind = f"{row.kind} ({row.instructions}, {row.gestures})"
        seconds = "-" if row.seconds is None else f"{row.seconds:.1f}"
        lines.append(
            f"  {kind:<30}{row.level:<10}{row.people:>6}{row.mistakes:>10.2f}{row.slips:>7.2f}{seconds:>9}"
            + (f"  {row.given_up} given up" if row.given_up else "")
        )
    return lines
