"""What feeds a target: Atheris, led by what the inputs reach in our code, or Hypothesis, led by chance.

Either counts what it tries, notes each kind of fault once, and goes on after it.
"""

import hashlib
import json
import os
import sys
import tempfile
import time
import traceback
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

INSTRUMENTED = ("lightgesture", "tomllib", "zipfile", "csv")
"""Packages whose branches Atheris sees."""

SLOW_S = 5.0
"""Seconds for one input that count as a hang."""
MEMORY_MIB = 3072
LONGEST_INPUT = 1 << 14
NOTED_EVERY_S = 2.0
"""Seconds between two notes of the count."""
MEMORY = Path("/dev/shm")
"""A folder in memory, where the system has one: a file is written for each input."""


def last_of(target: str) -> Path:
    """The file with the input that is being tried: where a process is killed, it is what did it."""
    folder = MEMORY if os.access(MEMORY, os.W_OK) else Path(tempfile.gettempdir())
    return folder / f"lightgesture-fuzz-{target}"


@dataclass(slots=True)
class Tally:
    """What became of a run, written to `file` as it goes: a native crash leaves no time for it."""

    file: Path
    target: str
    engine: str
    inputs: int = 0
    refused: int = 0
    seconds: float = 0.0
    slowest_s: float = 0.0
    faults: dict[str, int] = field(default_factory=dict)
    start_s: float = field(default_factory=time.monotonic)

    def note(self) -> None:
        """Write what is known."""
        self.seconds = round(time.monotonic() - self.start_s, 1)
        content = {key: value for key, value in asdict(self).items() if key not in ("file", "start_s")}
        part = self.file.with_suffix(".part")  # a process that is killed meanwhile leaves the note before
        part.write_text(json.dumps(content) + "\n")
        part.replace(self.file)


class Feeder:
    """Feeds inputs to a target and notes faults.

    found: the folder for inputs that made one. limit_s: seconds after which it ends the process.
    """

    def __init__(self, target: str, tally: Tally, found: Path, limit_s: float = float("inf")) -> None:
        from .targets import TARGETS

        self._run, self._tally, self._found = TARGETS[target].run, tally, found
        self._last, self._limit_s = last_of(target), limit_s

    def __call__(self, content: bytes) -> None:
        from .scratch import feed

        tally = self._tally
        start_s = time.monotonic()
        if not tally.inputs:
            tally.start_s = start_s  # what was imported before does not count
        self._last.write_bytes(content)
        try:
            tally.refused += not feed(self._run, content)
        except Exception as error:
            self._keep(kind_of(error), content, error)
        took_s = time.monotonic() - start_s
        if took_s > SLOW_S:
            self._keep("slow", content, TimeoutError(f"took {took_s:.1f} s"))
        tally.slowest_s = max(tally.slowest_s, round(took_s, 3))
        tally.inputs += 1
        if time.monotonic() > tally.start_s + self._limit_s:
            tally.note()
            # At once: threads of native libraries may keep an orderly end from coming to an end.
            os._exit(0)
        if time.monotonic() > tally.start_s + tally.seconds + NOTED_EVERY_S or tally.inputs == 1:
            tally.note()

    def _keep(self, kind: str, content: bytes, error: BaseException) -> None:
        faults = self._tally.faults
        faults[kind] = faults.get(kind, 0) + 1
        if faults[kind] > 1:
            return
        self._found.mkdir(parents=True, exist_ok=True)
        name = hashlib.sha256(kind.encode()).hexdigest()[:12]
        (self._found / name).write_bytes(content)
        text = "".join(traceback.format_exception(error))
        (self._found / f"{name}.txt").write_text(text, errors="backslashreplace")
        print(f"{self._tally.target}: {kind}", file=sys.stderr, flush=True)


def kind_of(error: BaseException) -> str:
    """Kind of a fault: its type and the last line of ours on its way."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [
        frame for frame in frames if "site-packages" not in frame.filename and "/tests/" not in frame.filename
    ]
    last = own[-1] if own else frames[-1]
    return f"{type(error).__name__} at {Path(last.filename).name}:{last.lineno}"


def run_atheris(target: str, seconds: float, corpus: Path, tally: Tally, found: Path) -> None:
    """Never returns: libFuzzer ends the process."""
    import atheris

    with atheris.instrument_imports(include=list(INSTRUMENTED)):
        from .targets import CORPUS

        feeder = Feeder(target, tally, found, seconds)
    options = [
        "fuzz",
        f"-max_total_time={int(2 * seconds) + 1}",
        f"-max_len={LONGEST_INPUT}",
        f"-rss_limit_mb={MEMORY_MIB}",
        f"-timeout={int(4 * SLOW_S)}",
        f"-artifact_prefix={found}/native-",
        "-print_final_stats=0",
        "-verbosity=0",
    ]
    seeds = CORPUS / target
    folders = [str(corpus), *([str(seeds)] if seeds.is_dir() else [])]
    atheris.Setup([*options, *folders], feeder)
    atheris.Fuzz()


def run_hypothesis(target: str, seconds: float, tally: Tally, found: Path) -> None:
    """Examples until the time is over; faults are noted and not shrunk."""
    from hypothesis import HealthCheck, Phase, given, settings
    from hypothesis import seed as seeded

    from .changes import inputs
    from .targets import TARGETS, seeds

    feeder = Feeder(target, tally, found)
    end_s = time.monotonic() + seconds
    number = int(time.time())
    while time.monotonic() < end_s:
        number += 1

        @seeded(number)
        @settings(
            max_examples=500,
            deadline=None,
            database=None,
            phases=[Phase.generate],
            suppress_health_check=list(HealthCheck),
        )
        @given(inputs(TARGETS[target], seeds(target)))
        def examples(content: Any) -> None:
            if time.monotonic() < end_s:
                feeder(content)

        examples()
    tally.note()
