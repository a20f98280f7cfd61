"""What a process takes, over time, and whether it is flat."""

import csv
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from statistics import median
from typing import Final

from lightgesture.benchmarks.tables import Cell, Table

PARTS: Final = 10
"""Parts of the time that are told; the first one, in which models are loaded and buffers grow, is not judged."""

MEMORY_MIB: Final = 6.0
"""Growth of memory from the second to the last part that counts as none: what an allocator gains and loses."""

SPEED: Final = 0.85
"""Frames a second of the processor in the last part, of those in the second, that count as the same."""

TICKS_A_SECOND: Final = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True, slots=True)
class Sample:
    """One look at a process. wall_s: since the start. memory_mib: resident. processor_s: used so far. frames: done."""

    wall_s: float
    memory_mib: float
    handles: int
    threads: int
    processor_s: float
    frames: int


@dataclass(frozen=True, slots=True)
class Pace:
    """every_s: seconds from one look to the next. most_s: seconds after which `live` is asked to end, done or not."""

    every_s: float
    most_s: float


def look(number: int, wall_s: float, frames: int) -> Sample | None:
    """A look at a process (Linux); None where it is gone."""
    place = Path(f"/proc/{number}")
    with suppress(OSError, StopIteration):
        lines = (place / "status").read_text().splitlines()
        memory_mib = next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS:"))
        numbers = (place / "stat").read_text().rpartition(")")[2].split()
        spent_s = (int(numbers[11]) + int(numbers[12])) / TICKS_A_SECOND
        handles, threads = len(os.listdir(place / "fd")), len(os.listdir(place / "task"))
        return Sample(wall_s, memory_mib, handles, threads, spent_s, frames)
    return None


def save(samples: Sequence[Sample], name: str, folder: Path | None) -> None:
    """Write the looks as a table, `<name>.csv`, where a folder is named."""
    if folder is None:
        return
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / f"{name}.csv", "w", encoding="ascii", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(field.name for field in fields(Sample))
        writer.writerows(astuple(one) for one in samples)


def together(some: Sequence[Sample], frames: int) -> Sample:
    """Several processes at one time as one; frames: those of all."""
    return Sample(
        some[0].wall_s,
        sum(one.memory_mib for one in some),
        sum(one.handles for one in some),
        sum(one.threads for one in some),
        sum(one.processor_s for one in some),
        frames,
    )


def children(number: int) -> list[int]:
    """The processes that a process has started and that still run (Linux)."""
    found: list[int] = []
    with suppress(OSError):
        for task in os.listdir(f"/proc/{number}/task"):
            found += map(int, Path(f"/proc/{number}/task/{task}/children").read_text().split())
    return found


def parts(samples: Sequence[Sample]) -> list[dict[str, Cell]]:
    """What was taken in each of PARTS parts of the time: medians, and the rate of frames by clock and by processor."""
    rows: list[dict[str, Cell]] = []
    for part in range(PARTS):
        start, end = part * len(samples) // PARTS, (part + 1) * len(samples) // PARTS
        some = samples[start : max(end, start + 1)]
        first, last = samples[max(start - 1, 0)], some[-1]
        frames = last.frames - first.frames
        rows.append(
            {
                "part": part + 1,
                "minutes": round(last.wall_s / 60, 1),
                "memory_mib": round(median(one.memory_mib for one in some), 1),
                "handles": round(median(one.handles for one in some)),
                "threads": round(median(one.threads for one in some)),
                "frames": last.frames,
                "a_second": _rate(frames, last.wall_s - first.wall_s),
                "a_processor_second": _rate(frames, last.processor_s - first.processor_s),
            }
        )
    return rows


def _rate(frames: int, seconds: float) -> Cell:
    return round(frames / seconds, 1) if seconds > 0 and frames > 0 else None


def table(name: str, rows: Sequence[dict[str, Cell]]) -> Table:
    """The parts of one process."""
    columns = (
        "part",
        "minutes",
        "memory_mib",
        "handles",
        "threads",
        "frames",
        "a_second",
        "a_processor_second",
    )
    return Table(f"soak_{name}", name, columns, tuple(rows))


def wrong(name: str, rows: Sequence[dict[str, Cell]]) -> list[str]:
    """What is not flat, in words, from the second part to the last."""
    first, last = rows[1], rows[-1]
    checks: dict[str, Callable[[float, float], bool]] = {
        "memory_mib": lambda before, after: after <= before + MEMORY_MIB,
        "handles": lambda before, after: after <= before,
        "threads": lambda before, after: after <= before,
        "a_processor_second": lambda before, after: after >= SPEED * before,
    }
    found = []
    for column, is_flat in checks.items():
        before, after = first[column], last[column]
        if isinstance(before, int | float) and isinstance(after, int | float) and not is_flat(before, after):
            found.append(f"{name}: {column} went from {before:g} to {after:g}")
    return found
