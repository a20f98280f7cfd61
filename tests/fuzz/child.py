"""One run of one engine on one target, in a process of its own: native code may end it.

python -m tests.fuzz.child TARGET ENGINE SECONDS WORK NUMBER
"""

import os
import resource
import sys
from pathlib import Path

from .engines import MEMORY_MIB, Tally, run_atheris, run_hypothesis


def places(work: Path, target: str) -> tuple[Path, Path, Path]:
    """Folders of a target: inputs that led on, inputs that made a fault, counts."""
    corpus, found, log = (work / part / target for part in ("corpus", "faults", "log"))
    return corpus, found, log


def tally_file(log: Path, engine: str, number: int) -> Path:
    """Where a run writes its counts."""
    return log / f"{number:04}-{engine}.json"


def main() -> None:
    """Run until the time is over."""
    target, engine, seconds, folder, number = sys.argv[1:]
    corpus, found, log = places(Path(folder), target)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    tally = Tally(tally_file(log, engine, int(number)), target, engine)
    if engine == "atheris":
        run_atheris(target, float(seconds), corpus, tally, found)
    else:
        resource.setrlimit(resource.RLIMIT_AS, (4 * MEMORY_MIB << 20, 4 * MEMORY_MIB << 20))
        run_hypothesis(target, float(seconds), tally, found)


if __name__ == "__main__":
    # What native libraries say of each input would fill a disk.
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    main()
