"""What this machine is and what is installed, without loading any of it."""

import os
import platform
import re
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from pathlib import Path

PACKAGE = "lightgesture"
LIBRARIES = (
    "numpy",
    "opencv-python-headless",
    "av",
    "ai-edge-litert",
    "pydantic",
    "threadpoolctl",
    "tqdm",
)
"""What the package itself rests on."""
_EXTRA = re.compile(r"extra\s*==\s*['\"]([\w.-]+)['\"]")
_NAME = re.compile(r"^[\w.-]+(?:\[[\w,. -]*\])?")
KIB_PER_MIB = 1024
ARM_PARTS = {
    "0xd03": "Cortex-A53",
    "0xd04": "Cortex-A35",
    "0xd05": "Cortex-A55",
    "0xd07": "Cortex-A57",
    "0xd08": "Cortex-A72",
    "0xd09": "Cortex-A73",
    "0xd0b": "Cortex-A76",
}
"""Arm's numbers of the processors of small boards (Main ID Register, part number)."""


@dataclass(frozen=True, slots=True)
class Machine:
    """python, system, processor: in words. cores: of the machine, usable_cores: that this process may use.
    memory_mib: of the machine, available_mib: free for programs; None where the system does not say.
    """

    python: str
    system: str
    processor: str
    cores: int
    usable_cores: int
    memory_mib: int | None
    available_mib: int | None


@dataclass(frozen=True, slots=True)
class Extra:
    """An extra of the package: which of its libraries are there and which are not."""

    name: str
    installed: tuple[str, ...]
    missing: tuple[str, ...]


def machine() -> Machine:
    """This machine."""
    cores = os.cpu_count() or 1
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else cores
    memory = read_memory(_text("/proc/meminfo"))
    return Machine(
        python=f"{platform.python_implementation()} {platform.python_version()}",
        system=platform.platform(),
        processor=processor(_text("/proc/cpuinfo")),
        cores=cores,
        usable_cores=usable,
        memory_mib=memory.get("MemTotal"),
        available_mib=memory.get("MemAvailable"),
    )


def processor(cpuinfo: str) -> str:
    """Name of the processor from `/proc/cpuinfo`; boards give the model of the board beside it."""
    fields: dict[str, str] = {}
    for line in cpuinfo.splitlines():
        key, _, value = line.partition(":")
        fields.setdefault(key.strip().lower(), value.strip())
    names = [
        fields[key] for key in ("model name", "model", "hardware") if fields.get(key, "").strip("0123456789")
    ]
    part = fields.get("cpu part")
    if part is not None:
        names.append(ARM_PARTS.get(part, f"Arm part {part}"))
    return ", ".join(names) or platform.machine()


def read_memory(meminfo: str) -> dict[str, int]:
    """MiB of each line of `/proc/meminfo` that counts kB."""
    found = re.findall(r"^(\w+):\s+(\d+) kB$", meminfo, flags=re.MULTILINE)
    return {name: int(kib) // KIB_PER_MIB for name, kib in found}


def versions() -> dict[str, str | None]:
    """Versions of the package and of what it rests on; None for what is not installed."""
    return {name: _version(name) for name in (PACKAGE, *LIBRARIES)}


def extras() -> list[Extra]:
    """The extras of the package by name. Without installed metadata, none."""
    try:
        names = metadata(PACKAGE).get_all("Provides-Extra") or []
    except PackageNotFoundError:
        return []
    needs = needs_of_extras(requires(PACKAGE) or [])
    return [_extra(name, needs.get(name, [])) for name in sorted(names)]


def needs_of_extras(requirements: list[str]) -> dict[str, list[str]]:
    """Libraries of each extra, from lines such as `torch>=2.4; extra == "train"`.

    An extra that is made of others (`lightgesture[dev,train]`) names none.
    """
    needs: dict[str, list[str]] = {}
    for line in requirements:
        extra, name = _EXTRA.search(line), _NAME.match(line)
        if extra and name and not name.group().startswith(PACKAGE):
            needs.setdefault(extra.group(1), []).append(name.group().split("[")[0])
    return needs


def _extra(name: str, libraries: list[str]) -> Extra:
    there = tuple(library for library in libraries if _version(library) is not None)
    return Extra(name, there, tuple(library for library in libraries if library not in there))


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _text(path: str) -> str:
    try:
        return Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
