"""Fuzzing of everything that reads.

    python -m tests.fuzz --list
    python -m tests.fuzz grammar --seconds 60                        # one target, coverage-guided
    python -m tests.fuzz --seconds 3600 --engine hypothesis          # all targets, the time parted among them
    python -m tests.fuzz --table                                     # what was tried so far
    python -m tests.fuzz grammar --keep                              # a small corpus -> the repository

Needs Atheris, which is in the extra `hold`. Inputs that led on, faults and counts stay in the folder `--work`.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .child import places, tally_file
from .engines import last_of
from .keeping import keep
from .targets import TARGETS

ENGINES = ("atheris", "hypothesis")
SHORTEST_S = 1.0
"""Seconds below which a run is not worth its start."""
SPARE_S = 900.0
"""Seconds after its time in which a run must end, its imports included, which others on the machine slow down."""
WORK = Path(tempfile.gettempdir()) / "lightgesture-fuzz"


def main() -> int:
    """0: no fault was found."""
    parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="all without any")
    parser.add_argument("--seconds", type=float, default=60.0, help="for all targets together (default: 60)")
    parser.add_argument("--engine", choices=ENGINES, default="atheris")
    parser.add_argument("--work", type=Path, default=WORK, help=f"folder (default: {WORK})")
    parser.add_argument("--list", action="store_true", help="name the targets")
    parser.add_argument("--table", action="store_true", help="print what was tried, by target and engine")
    parser.add_argument("--keep", action="store_true", help="write a small corpus into the repository")
    args = parser.parse_args()
    unknown = [name for name in args.targets if name not in TARGETS]
    if unknown:
        parser.error(f"{unknown[0]}: no target; --list names them")
    names = args.targets or list(TARGETS)
    if args.list:
        print("\n".join(f"{name:12} {TARGETS[name].reads}" for name in names))
        return 0
    if args.table:
        return _table(args.work, names)
    if args.keep:
        for name in names:
            print(f"{name}: {keep(name, args.work / 'corpus' / name)} inputs more")
        return 0
    share_s = args.seconds / len(names)
    return max(_fuzz(name, args.engine, share_s, args.work) for name in names)


def _fuzz(name: str, engine: str, seconds: float, work: Path) -> int:
    """One target in a process of its own, begun again where native code ends it. 1: there are faults."""
    _, found, log = folders = places(work, name)
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    end_s = time.monotonic() + seconds
    while (left_s := end_s - time.monotonic()) > SHORTEST_S:
        number = len(list(log.iterdir()))
        words = [
            sys.executable,
            "-m",
            "tests.fuzz.child",
            name,
            engine,
            f"{left_s:.1f}",
            str(work),
            str(number),
        ]
        with open(found.with_suffix(".err"), "ab") as messages:
            try:
                done = subprocess.run(words, stderr=messages, timeout=left_s + SPARE_S, check=False)
                status = done.returncode
            except subprocess.TimeoutExpired:
                status = -9
        if status and not _note_end(tally_file(log, engine, number), status):
            print(f"{name}: does not begin; see {messages.name}", file=sys.stderr)
            return 1
        if status:
            shutil.copy(last_of(name), found / f"native-{number:04}")
    last_of(name).unlink(missing_ok=True)
    return int(any(found.iterdir()))


def _note_end(file: Path, status: int) -> bool:
    """Add to a run's counts how it ended; False: it has none."""
    if not file.exists():
        return False
    file.write_text(json.dumps({**json.loads(file.read_text()), "ended": status}) + "\n")
    return True


def _table(work: Path, names: list[str]) -> int:
    """Inputs, refusals, minutes and faults of each target and engine, as Markdown."""
    print("| target | what is read | engine | minutes | inputs | refused | slowest, ms | kinds of faults |")
    print("|---|---|---|---:|---:|---:|---:|---:|")
    for name in names:
        for engine in ENGINES:
            runs = [json.loads(file.read_text()) for file in (work / "log" / name).glob(f"*-{engine}.json")]
            runs = [run for run in runs if run.get("inputs")]
            if not runs:
                continue
            kinds = {kind for run in runs for kind in run["faults"]}
            kinds |= {f"ended with {run['ended']}" for run in runs if run.get("ended")}
            inputs, refused = (sum(run[key] for run in runs) for key in ("inputs", "refused"))
            minutes = sum(run["seconds"] for run in runs) / 60
            slowest = 1000 * max(run["slowest_s"] for run in runs)
            print(
                f"| {name} | {TARGETS[name].reads} | {engine} | {minutes:.1f} | {inputs:,} | {refused:,} "
                f"| {slowest:.0f} | {len(kinds)} |"
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
