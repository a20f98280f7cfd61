"""Boxes that another program found on the same pictures, read from JSON Lines and scored like ours.

One line a picture: `{"method": "mediapipe lite", "mode": "single", "file": "frames/a.jpg", "hands": [{"box": [x, y,
width, height], "side": "left"}]}`. file is relative to the data folder; mode is `single` or `sequence`; side is the
diver's own or null. Other keys are ignored.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lightgesture.benchmarks.finding.regions import SEQUENCE, SINGLE, Run, make_answer
from lightgesture.benchmarks.scorer import Reading
from lightgesture.errors import InputError
from lightgesture.training.datasets import Sample, group_samples, is_sequence

Recorded = dict[tuple[str, str], dict[str, tuple[Reading, ...]]]
"""Readings by method and mode, then by file."""


def read_recorded(path: Path) -> Recorded:
    """Read such a file. Raises InputError, naming the line."""
    recorded: Recorded = {}
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: cannot be read ({reason}); name a file of boxes") from error
    for number, line in enumerate(lines, 1):
        try:
            row = json.loads(line)
            if row["mode"] not in (SINGLE, SEQUENCE):
                raise ValueError(f"mode {row['mode']!r} is neither {SINGLE} nor {SEQUENCE}")
            hands = tuple(_reading(hand) for hand in row["hands"])
            recorded.setdefault((str(row["method"]), row["mode"]), {})[str(row["file"])] = hands
        except (ValueError, KeyError, TypeError, OverflowError) as error:
            raise InputError(
                f"{path}: line {number} is no row of boxes ({error}); make the file again"
            ) from None
    return recorded


def _reading(hand: dict[str, Any]) -> Reading:
    x, y, width, height = (round(float(value)) for value in hand["box"])
    side = hand["side"]
    if side not in ("left", "right", None):
        raise ValueError(f"side {side!r}")
    return Reading((x, y, width, height), side, None)


def recorded_runs(recorded: Recorded, samples: Sequence[Sample], data: Path) -> list[Run]:
    """A run for each method, group and mode of which every frame was recorded."""
    runs = []
    for group, members in group_samples(samples).items():
        files = [sample.path.relative_to(data).as_posix() for sample in members]
        for (method, mode), boxes in recorded.items():
            fits = mode == SINGLE or is_sequence(members)
            if fits and all(file in boxes for file in files):
                answers = [
                    make_answer(sample, boxes[file]) for sample, file in zip(members, files, strict=True)
                ]
                runs.append(Run(method, group, mode, None, tuple(answers), None, seen="?"))
    return runs
