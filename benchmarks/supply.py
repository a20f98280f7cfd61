"""What the package is made of, checked: locked versions with hashes, known weaknesses, licences, and a wheel that comes
out the same twice.

    python -m lightgesture.benchmarks.supply lock        # deploy/requirements.txt anew
    python -m lightgesture.benchmarks.supply audit       # known weaknesses of what is locked
    python -m lightgesture.benchmarks.supply licences    # of what is locked, as installed here
    python -m lightgesture.benchmarks.supply wheel       # two builds, one hash

Needs the tools of the extra `hold`, and a checkout.
"""

import argparse
import hashlib
import io
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

from lightgesture.console import fail, messages_shown, print_line
from lightgesture.errors import ExitStatus, InputError

LOCK: Final = Path("deploy") / "requirements.txt"
"""Versions and hashes of everything that a vehicle needs: the package's own dependencies and those of MAVLink."""

EXTRA: Final = "mavlink"
PYTHON: Final = "3.11"
"""The oldest Python that the lock must hold for; newer ones have lines of their own where they need other versions."""

ALLOWED: Final = (
    "0BSD",
    "Apache",
    "BSD",
    "CC0",
    "GNU Lesser General Public License",
    "LGPL",
    "MIT",
    "MPL",
    "PSF",
    "Python Software Foundation",
    "Zlib",
)
"""Parts of the names of licences that go with Apache 2.0 where a package is installed beside ours."""

EPOCH: Final = "SOURCE_DATE_EPOCH"
UMASK: Final = 0o022
"""For the modes of files, which a wheel keeps."""

_PINNED: Final = re.compile(r"^([A-Za-z0-9._-]+)==([^\s;]+)", re.MULTILINE)
_HEADER: Final = (
    "# Versions and hashes of all that runs on a vehicle:\n"
    "#   pip install --require-hashes -r deploy/requirements.txt && pip install --no-deps .\n"
    "# Made by: python -m lightgesture.benchmarks.supply lock\n"
)


def main(arguments: Sequence[str] | None = None) -> int:
    """0: as it should be; 1: something was found; 2: it could not be looked at."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n\n")[0])
    parser.add_argument("what", choices=COMMANDS)
    with messages_shown():
        try:
            return COMMANDS[parser.parse_args(arguments).what](Path.cwd())
        except InputError as error:
            fail(str(error))
            return ExitStatus.USAGE


def pinned(text: str) -> dict[str, str]:
    """Package to version of a lock; of several versions the first."""
    found: dict[str, str] = {}
    for name, number in _PINNED.findall(text):
        found.setdefault(name, number)
    return found


def lock(root: Path) -> int:
    """Write the lock anew by `uv`. InputError: the index cannot be reached."""
    words = ["uv", "pip", "compile", "pyproject.toml", "--extra", EXTRA, "--universal", "--generate-hashes"]
    words += ["--no-header", "--no-annotate", "--quiet", "--python-version", PYTHON]
    text = _HEADER + _output(words, root, "is the package index reachable?")
    (root / LOCK).write_text(text, encoding="utf-8")
    print_line(f"{LOCK}: {len(pinned(text))} packages, {text.count('--hash=')} hashes")
    return ExitStatus.OK


def audit(root: Path) -> int:
    """Known weaknesses of what is locked, by `pip-audit`. InputError: the advisories cannot be had: nothing is said."""
    words = [sys.executable, "-m", "pip_audit", "-r", str(LOCK), "--disable-pip", "--require-hashes"]
    done = _run([*words, "--format", "json", "--progress-spinner", "off"], root)
    try:
        found = json.loads(done.stdout)["dependencies"]
    except (ValueError, KeyError):
        reason = (done.stderr.strip() or "no answer").splitlines()[-1][:200]
        raise InputError(
            f"{LOCK}: cannot be audited ({reason}); run it where the advisories can be reached"
        ) from None
    if unknown := [one["name"] for one in found if "skip_reason" in one]:
        raise InputError(
            f"{LOCK}: {len(unknown)} of {len(found)} packages could not be audited, such as {unknown[0]}; run it where "
            "the advisories can be reached"
        )
    weak = [(one, fault) for one in found for fault in one["vulns"]]
    for one, fault in weak:
        print_line(
            f"{one['name']} {one['version']}: {fault['id']}; mended in {', '.join(fault['fix_versions'])}"
        )
    print_line(f"{LOCK}: {len(found)} packages, {len(weak)} known weaknesses")
    return ExitStatus.SOME_FAILED if weak else ExitStatus.OK


def licences(root: Path) -> int:
    """Licences of what is locked and installed here, by `pip-licenses`; 1: one is not among ALLOWED."""
    names = [name for name in pinned((root / LOCK).read_text("utf-8")) if _is_installed(name)]
    words = [sys.executable, "-m", "piplicenses", "--from=mixed", "--format=json", "--packages", *names]
    rows = json.loads(_output(words, root, "install lightgesture[hold]"))
    foreign = [row for row in rows if not is_allowed(row["License"])]
    for row in rows:
        mark = "  NOT ALLOWED" if row in foreign else ""
        print_line(f"{row['Name']:24} {row['Version']:14} {row['License']}{mark}")
    print_line(f"{len(rows)} packages, {len(foreign)} with a licence that is not allowed")
    return ExitStatus.SOME_FAILED if foreign else ExitStatus.OK


def wheel(root: Path) -> int:
    """Build what is committed twice, in two folders, and compare; 1: the wheels differ."""
    hashes = [_built(root) for _ in range(2)]
    for name, code in hashes:
        print_line(f"{code}  {name}")
    is_same = hashes[0] == hashes[1]
    print_line("two builds, one hash" if is_same else "the two builds differ")
    return ExitStatus.OK if is_same else ExitStatus.SOME_FAILED


def is_allowed(licence: str) -> bool:
    """Whether every licence of a package is one of ALLOWED."""
    parts = re.split(r";|\bAND\b", licence)
    return all(any(name in part for name in ALLOWED) for part in parts)


def _built(root: Path) -> tuple[str, str]:
    """Name and SHA-256 of the wheel of what is committed."""
    date = _output(["git", "log", "-1", "--format=%ct"], root, "run it in a checkout").strip()
    packed = subprocess.run(["git", "archive", "HEAD"], cwd=root, stdout=subprocess.PIPE, check=True)
    with tempfile.TemporaryDirectory() as place:
        with tarfile.open(fileobj=io.BytesIO(packed.stdout)) as archive:
            archive.extractall(place, filter="tar")
        words = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", "built"]
        _output(words, Path(place), "install lightgesture[hold]", {EPOCH: date})
        (file,) = (Path(place) / "built").glob("*.whl")
        return file.name, hashlib.sha256(file.read_bytes()).hexdigest()


def _is_installed(name: str) -> bool:
    try:
        version(name)
    except PackageNotFoundError:
        return False
    return True


def _output(words: Sequence[str], folder: Path, remedy: str, more: dict[str, str] | None = None) -> str:
    """What a command says. InputError: it fails."""
    done = _run(words, folder, more)
    if done.returncode:
        reason = (done.stderr.strip() or done.stdout.strip() or f"status {done.returncode}").splitlines()[-1]
        raise InputError(f"{' '.join(words[:4])}: failed ({reason[:200]}); {remedy}")
    return done.stdout


def _run(
    words: Sequence[str], folder: Path, more: dict[str, str] | None = None
) -> "subprocess.CompletedProcess[str]":
    try:
        return subprocess.run(
            words,
            cwd=folder,
            env={**os.environ, **(more or {})},
            umask=UMASK,
            capture_output=True,
            text=True,
            check=False,
        )
    except FileNotFoundError:
        raise InputError(f"{words[0]}: is not installed; install lightgesture[hold]") from None


COMMANDS: Final[dict[str, Callable[[Path], int]]] = {
    "lock": lock,
    "audit": audit,
    "licences": licences,
    "wheel": wheel,
}
"""What may be asked for."""


if __name__ == "__main__":
    sys.exit(main())
