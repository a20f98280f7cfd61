"""What runs on this machine, how fast, and what to do about what does not.

The heavy libraries are loaded in processes of their own (`doctor.probe`), so the doctor lives whatever they do, and
what it measures is what a user waits for: from the start of the interpreter to the first record.
"""

import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import IO, Any, cast

from lightgesture.doctor.facts import Extra, Machine, extras, machine, versions
from lightgesture.doctor.probe import FIRST, ONLY_FIRST

SAMPLE_TEXT = "STOP HOVER 50 GO"
"""What the diver in the bundled clip signs."""

PROBE_TIMEOUT_S = 600.0
"""Longest time for the clip: a board that needs more is of no use."""

NEEDED = {
    "numpy": "numpy",
    "cv2": "opencv-python-headless",
    "pydantic": "pydantic",
    "threadpoolctl": "threadpoolctl",
}
"""Modules without which nothing is decoded, and the packages that bring them."""


@dataclass(frozen=True, slots=True)
class Problem:
    """Something that is needed and broken: what, why, what to do."""

    what: str
    reason: str
    remedy: str


@dataclass(frozen=True, slots=True)
class Report:
    """All that the doctor found.

    start_s: seconds from the start of a fresh process to its first record; "first" before anything else was loaded, as
        far as the system had not kept the files from before, "again" right after. None where it failed.
    findings: of the clip, see `doctor.probe`; empty where that failed.
    """

    machine: Machine
    versions: dict[str, str | None]
    extras: list[Extra]
    start_s: dict[str, float | None]
    findings: dict[str, Any]
    problems: list[Problem] = field(default_factory=list)

    def to_dict(self) -> dict[str, Any]:
        """The object that `--json` prints."""
        content = asdict(self)
        return {**content, "status": "broken" if self.problems else "ok"}


@dataclass(frozen=True, slots=True)
class Probe:
    """How a probe went: seconds to its first record, its findings, and why it failed."""

    first_s: float | None
    findings: dict[str, Any]
    failure: str | None


Run = Callable[[Sequence[str]], Probe]


def examine(run: Run | None = None) -> Report:
    """Examine this machine; `run` starts a probe with arguments."""
    run = run or run_probe
    first = run([ONLY_FIRST])
    whole = run([]) if first.failure is None else first
    problems = _problems(whole)
    return Report(
        machine=machine(),
        versions=versions(),
        extras=extras(),
        start_s={"first": first.first_s, "again": whole.first_s if first.failure is None else None},
        findings=whole.findings,
        problems=problems,
    )


def run_probe(arguments: Sequence[str], timeout_s: float = PROBE_TIMEOUT_S) -> Probe:
    """Run the probe in a fresh interpreter and time its first record."""
    command = [sys.executable, "-m", "lightgesture.doctor.probe", *arguments]
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as errors:
        start = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors, text=True)
        timer = threading.Timer(timeout_s, process.kill)
        timer.start()
        with process:
            output = cast(IO[str], process.stdout)
            line = output.readline()
            first_s = round(time.monotonic() - start, 3) if _parse(line) == FIRST else None
            rest = output.read()
            status = process.wait()
            timer.cancel()
        if status and time.monotonic() - start >= timeout_s:
            return Probe(first_s, {}, f"not done after {timeout_s:g} s")
        if status:
            errors.seek(0)
            return Probe(first_s, {}, _why(status, errors.read()))
    findings = _parse(rest)
    return Probe(first_s, findings if isinstance(findings, dict) else {}, None)


def why_not_imported(module: str) -> str | None:
    """Why a fresh interpreter cannot import a module; None if it can."""
    done = subprocess.run(
        [sys.executable, "-c", f"import {module}"], capture_output=True, text=True, check=False
    )
    return _why(done.returncode, done.stderr) if done.returncode else None


def _problems(probe: Probe) -> list[Problem]:
    if probe.failure is not None:
        return _causes(probe.failure)
    texts = probe.findings.get("instructions", [])
    if texts != [SAMPLE_TEXT]:
        found = "; ".join(texts) or "nothing"
        return [
            Problem(
                "the bundled clip",
                f"gives {found}, not {SAMPLE_TEXT}",
                "install lightgesture again; if that does not help, report it with the output of "
                "lightgesture doctor --json, and do not let this machine command a vehicle",
            )
        ]
    return []


def _causes(failure: str) -> list[Problem]:
    """The libraries that cannot be imported; the failure itself where all can."""
    broken = [
        Problem(
            module,
            reason,
            f"{sys.executable} -m pip install --force-reinstall {package}",
        )
        for module, package in NEEDED.items()
        if (reason := why_not_imported(module)) is not None
    ]
    return broken or [Problem("decoding", failure, "install lightgesture again in a new virtual environment")]


def _why(status: int, errors: str) -> str:
    """The last line of an error; the signal where a library killed the process."""
    lines = [line.strip() for line in errors.splitlines() if line.strip()]
    if status < 0:
        return f"ended by signal {-status}: a library does not fit this processor"
    return lines[-1] if lines else f"exit status {status}"


def _parse(line: str) -> Any:
    try:
        return json.loads(line)
    except ValueError:
        return None
