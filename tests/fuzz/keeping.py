"""From the many inputs that a fuzzer found to a few that reach as much of our code, for the repository."""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from .targets import CORPUS

MOST_BYTES = 6144
"""Of the inputs of one target together."""
LARGEST = 3072
"""Bytes of one input that is kept besides those that are there."""


def keep(name: str, found: Path) -> int:
    """Put into the repository those of the found inputs that reach more than what is there, the smallest first."""
    own = CORPUS / name
    own.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place:
        merged = Path(place) / "merged"
        merged.mkdir()
        for file in own.iterdir():
            shutil.copy(file, merged)
        script = (
            "import atheris, sys\n"
            "from tests.fuzz.engines import INSTRUMENTED\n"
            "with atheris.instrument_imports(include=list(INSTRUMENTED)):\n"
            "    from tests.fuzz.targets import TARGETS\n"
            "    from tests.fuzz.scratch import feed\n"
            f"run = TARGETS[{name!r}].run\n"
            "atheris.Setup(sys.argv, lambda content: feed(run, content))\n"
            "atheris.Fuzz()\n"
        )
        command = [sys.executable, "-c", script, "-merge=1", "-verbosity=0", str(merged), str(found)]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
        room = MOST_BYTES - sum(file.stat().st_size for file in own.iterdir())
        for file in sorted(merged.iterdir(), key=lambda file: (file.stat().st_size, file.name)):
            size = file.stat().st_size
            if (own / file.name).exists() or size > min(room, LARGEST):
                continue
            shutil.copy(file, own / file.name[:12])
            room -= size
    return done.returncode
