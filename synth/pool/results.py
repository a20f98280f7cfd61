"""The table of the trials: CSV, JSON and text."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from statistics import median

from lightgesture.results.atomic import replacing
from lightgesture.synth.pool.verdict import Verdict

COLUMNS = tuple(field.name for field in fields(Verdict))


def write_tables(rows: Sequence[Verdict], folder: Path) -> None:
    """Write pool.csv and pool.json."""
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(row) for row in rows)
    content = json.dumps([asdict(row) for row in rows], indent=1) + "\n"
    for name, what in (("pool.csv", text.getvalue()), ("pool.json", content)):
        with replacing(folder / name, Path(name).suffix) as partial:
            Path(partial).write_text(what, encoding="utf-8")


def describe(rows: Sequence[Verdict]) -> Iterator[str]:
    """The table in words, and its sums."""
    width = max(len(row.sentence) for row in rows)
    yield f"{'trial':<6}{'sentence':<{width}}  issued accepted done  as meant  s     detail"
    for row in rows:
        marks = [_mark(value) for value in (row.issued, row.accepted, row.done, row.as_meant)]
        effect = "-" if row.first_effect_s is None else f"{row.first_effect_s:.1f}"
        line = f"{row.trial:<6}{row.sentence:<{width}}  {marks[0]:<7}{marks[1]:<9}{marks[2]:<6}{marks[3]:<9}"
        yield f"{line} {effect:<5} {row.detail}"
    issued = [row for row in rows if row.issued]
    times = [row.first_effect_s for row in rows if row.first_effect_s is not None]
    yield (
        f"{len(rows)} sentences: {len(issued)} issued, {sum(row.accepted for row in rows)} accepted, "
        f"{sum(row.as_meant for row in rows)} done as meant; "
        f"{median(times) if times else float('nan'):.1f} s from the first sign to the first effect (median)"
    )


def _mark(value: bool | None) -> str:
    return "open" if value is None else "yes" if value else "no"
