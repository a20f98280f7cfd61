"""How much code a frame goes through, and how much there is: `python -m lightgesture.benchmarks.census`.

The goals are what the house was rebuilt for.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from typing import Final

from lightgesture.benchmarks.census.frame import FRAMES, FrameCounts, frame_counts
from lightgesture.benchmarks.census.sources import box_holders, count_lines, import_closure, settings_fields
from lightgesture.benchmarks.tables import Cell, Table, to_text
from lightgesture.cli import exit_status
from lightgesture.console import native_messages_muted, print_line
from lightgesture.errors import ExitStatus

DECODING: Final = tuple(f"lightgesture.commands.{name}" for name in ("decode", "live", "recognize"))
"""What the decoding closure is imported from."""


def tables(frame: FrameCounts) -> list[Table]:
    """All figures, then the types of a box and the settings behind two of them."""
    closure = set(import_closure(DECODING).values())
    holders, settings = box_holders(closure), settings_fields()
    rows: list[tuple[str, int, int | None]] = [
        ("files a frame", frame.files, 22),
        ("functions a frame", frame.functions, 110),
        ("functions a frame, without comprehensions and lambdas", frame.named_functions, None),
        ("calls a frame", frame.calls, 280),
        ("calls a frame, without comprehensions and lambdas", frame.named_calls, None),
        ("calls of generated constructors besides", frame.generated_calls, None),
        ("filter predictions a frame, two hands of four coordinates", frame.predictions, 8),
        ("files of the decoding closure", len(closure), None),
        ("lines of the decoding closure", count_lines(closure), 12500),
        ("settings fields", sum(len(one.fields) for one in settings), 200),
        ("settings classes", len(settings), None),
        ("types a box lives in", len(holders), 4),
    ]
    figures: list[dict[str, Cell]] = [
        {"what": what, "count": count, "goal": goal} for what, count, goal in rows
    ]
    types: list[dict[str, Cell]] = [
        {"type": one.name, "file": one.file, "fields": ", ".join(one.fields)} for one in holders
    ]
    classes: list[dict[str, Cell]] = [
        {"class": one.name, "file": one.file, "fields": len(one.fields)}
        for one in sorted(settings, key=lambda one: -len(one.fields))
    ]
    note = f"a frame: median of frames {FRAMES.start} to {FRAMES.stop - 1} of the bundled clip."
    return [
        Table("census", "The house in figures", ("what", "count", "goal"), tuple(figures), note),
        Table("box_types", "Types a box lives in", ("type", "file", "fields"), tuple(types)),
        Table("settings", "Settings fields", ("class", "file", "fields"), tuple(classes)),
    ]


def run(args: argparse.Namespace) -> int:
    """Count and print; 0 when all was done."""
    with native_messages_muted():
        found = tables(frame_counts())
    if args.json:
        for row in (row for table in found for row in table.to_dicts()):
            print_line(json.dumps(row, ensure_ascii=False))
    else:
        print_line(to_text(found))
    return ExitStatus.OK


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m lightgesture.benchmarks.census",
        description="How much code a frame goes through, and how much there is.",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object per table row on stdout")
    args = parser.parse_args(argv)
    return exit_status(lambda: run(args), "nothing was printed")


if __name__ == "__main__":
    sys.exit(main())
