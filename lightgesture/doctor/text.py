"""The doctor's report in plain words."""

from collections.abc import Iterator
from typing import Any

from lightgesture.doctor.examination import Report
from lightgesture.doctor.facts import PACKAGE, Extra, Machine

_WIDTH = 13
"""Characters of the left column."""


def lines_of(report: Report) -> Iterator[str]:
    """The lines to print."""
    known = report.versions
    yield _line(PACKAGE, known[PACKAGE] or "not installed")
    yield from _machine(report.machine)
    yield _line(
        "libraries", ", ".join(f"{name} {known[name] or 'missing'}" for name in known if name != PACKAGE)
    )
    for extra in report.extras:
        if extra.installed or extra.missing:
            yield _line(f"[{extra.name}]", _extra(extra))
    if report.findings:
        yield from _findings(report.findings)
    yield _line("start", _start(report.start_s))
    for problem in report.problems:
        yield _line("broken", f"{problem.what}: {problem.reason}")
        yield _line("remedy", problem.remedy)
    if not report.problems:
        yield _line("verdict", "all that is needed works")


def _machine(machine: Machine) -> Iterator[str]:
    yield _line("machine", f"{machine.system}, {machine.python}")
    cores = f"{machine.cores} cores" if machine.cores != 1 else "1 core"
    usable = "" if machine.usable_cores == machine.cores else f", {machine.usable_cores} usable"
    yield _line("processor", f"{machine.processor}, {cores}{usable}")
    if machine.memory_mib is not None:
        yield _line("memory", f"{machine.memory_mib} MiB, {machine.available_mib} MiB available")


def _extra(extra: Extra) -> str:
    if not extra.missing:
        return f"installed ({', '.join(extra.installed)})"
    have = f"; has {', '.join(extra.installed)}" if extra.installed else ""
    return f"not installed (lacks {', '.join(extra.missing)}{have})"


def _findings(found: dict[str, Any]) -> Iterator[str]:
    able = ", ".join(f"{name} {'yes' if there else 'no'}" for name, there in found["video"].items())
    yield _line("video", f"files and network streams by PyAV; cameras and pipelines by OpenCV with: {able}")
    for name, reason in found["classifiers"].items():
        yield _line(f"model {name}", "works" if reason is None else reason)
    slower = (
        "" if found["nets"] == "LiteRT" else " (slower; pip install ai-edge-litert, where it has a wheel)"
    )
    yield _line("nets", f"run by {found['nets']}{slower}")
    speed = found["ms_per_frame"]
    yield _line(
        "speed",
        f"{found['frames_per_second']:g} frames a second on the bundled clip, reading included "
        f"({speed['median']:g} ms a frame, 95 % below {speed['p95']:g})",
    )
    if found["peak_mib"] is not None:
        yield _line("peak", f"{found['peak_mib']:g} MiB of memory while decoding")
    yield _line("clip", "; ".join(found["instructions"]) or "no instruction")


def _start(start_s: dict[str, float | None]) -> str:
    first, again = start_s["first"], start_s["again"]
    if first is None:
        return "fails before the first record"
    text = f"{first:g} s from a fresh process to its first record"
    return text if again is None else f"{text}, {again:g} s when done again"


def _line(name: str, text: str) -> str:
    return f"{name:<{_WIDTH}}{text}"
