"""The folder of results: one run at a time, and a manifest of what is done.

`.lightgesture.json` names for every stem the input, what its results depended on and the files. It is written anew,
whole, after every finished input, so that a killed run loses what it was at and nothing else.
"""

import json
import os
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from lightgesture.archive.fingerprint import input_fingerprint, run_fingerprint
from lightgesture.archive.tasks import Outcome, Task
from lightgesture.config.opening import make_folder
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import UsageError
from lightgesture.features.files import read_whole
from lightgesture.results.atomic import replacing
from lightgesture.results.ownership import is_ours

MANIFEST = ".lightgesture.json"
LOCK = ".lightgesture.lock"
LARGEST_MANIFEST = 64 << 20
"""Bytes; an input takes some hundreds."""
FORMAT = 1
"""Version of the manifest; one of another version is as good as none."""

_ELSEWHERE = "name another folder with --out, or move the file"

_PART = re.compile(r"\.[0-9a-f]{32}\.part")


class ArchiveFolder:
    """What a folder of results holds already."""

    def __init__(self, path: Path, run: str, entries: dict[str, dict[str, Any]]) -> None:
        self.path = path
        self._run = run
        self._entries = entries
        self._inputs: dict[int, str | None] = {}

    def look_up(self, task: Task) -> Outcome | None:
        """What needs no work: done before and nothing has changed since; or not to be done at all, because the files
        under its name are those of another input. None: it is to be decoded."""
        # Taken before decoding: a file that changes meanwhile is done again the next time.
        self._inputs[task.place] = fingerprint = input_fingerprint(task)
        entry = self._entries.get(task.stem)
        if entry is None or not self._has_all(entry):
            return None
        is_same = fingerprint is not None and entry["input"] == fingerprint
        if is_same and entry["run"] == self._run and entry["source"] == task.name:
            return Outcome(
                "done before", None, *(entry[key] for key in ("frames", "instructions", "rejected"))
            )
        if not is_same and entry["path"] != os.path.abspath(task.path):
            text = f"{task.name}: {self.path / task.stem}.* are the results of {entry['path']}; name another --out"
            return Outcome("failed", text)
        return None

    def refuse_to_replace(self, tasks: Sequence[Task], suffixes: Sequence[str]) -> None:
        """UsageError: a file of results would take the place of an input, or of a file that is not ours.

        tasks: those that are to be decoded. suffixes: of the files that each gets.
        """
        inputs = [file for task in tasks for file in task.files if os.path.isfile(file)]
        for task in tasks:
            known = self._entries.get(task.stem, {}).get("files", ())
            for path in (self.path / f"{task.stem}{suffix}" for suffix in suffixes):
                if not os.path.lexists(path):
                    continue
                if path.is_dir():
                    raise UsageError(f"{path}: cannot be written (is a folder); {_ELSEWHERE}")
                if any(os.path.exists(path) and os.path.samefile(path, file) for file in inputs):
                    raise UsageError(
                        f"{path}: is an input, and results of {task.name} would replace it; {_ELSEWHERE}"
                    )
                if path.name not in known and not is_ours(path):
                    raise UsageError(
                        f"{path}: was not written by this program and would be replaced; {_ELSEWHERE}"
                    )

    def remember(self, task: Task, outcome: Outcome) -> None:
        """Note a finished input. UsageError: the folder cannot be written."""
        fingerprint = self._inputs.get(task.place)
        self._entries.pop(task.stem, None)
        if outcome.status == "ok" and fingerprint is not None:
            self._entries[task.stem] = {
                "source": task.name,
                "path": os.path.abspath(task.path),
                "input": fingerprint,
                "run": self._run,
                "frames": outcome.frames,
                "instructions": outcome.instructions,
                "rejected": outcome.rejected,
                "files": list(outcome.files),
            }
        content = {"format": FORMAT, "inputs": dict(sorted(self._entries.items()))}
        with replacing(self.path / MANIFEST) as temporary:
            temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="ascii")

    def _has_all(self, entry: dict[str, Any]) -> bool:
        return all(os.path.isfile(self.path / name) for name in entry["files"])


@contextmanager
def open_archive_folder(settings: DecodeSettings) -> Iterator[ArchiveFolder | None]:
    """The folder that `--out` names, for this run alone; None without `--out`.

    What a killed run left half-written is removed. UsageError: the folder cannot be written, or another run is at it.
    """
    if not settings.out:
        yield None
        return
    make_folder(settings.out)
    path = Path(settings.out)
    with _locked(path):
        _sweep(path)
        try:
            yield ArchiveFolder(path, run_fingerprint(settings), _read(path / MANIFEST))
        finally:
            _sweep(path)


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    """A lock of the operating system, which lets go of it when its holder dies in whatever way."""
    import filelock

    lock = filelock.FileLock(path / LOCK, blocking=False)
    try:
        # Where nothing can be made, a lock that cannot be made must not pass for one that another run holds.
        with tempfile.TemporaryFile(dir=path):
            lock.acquire()
    except filelock.Timeout:
        raise UsageError(
            f"{path}: another run writes into this folder; wait for its end or name another --out"
        ) from None
    except OSError as error:
        raise UsageError(f"{path}: cannot be written ({error.strerror}); name another folder") from None
    try:
        yield
    finally:
        lock.release()


def _sweep(path: Path) -> None:
    """Remove what `replacing` leaves where a process is killed outright."""
    for item in path.iterdir():
        if _PART.fullmatch(item.name):
            with suppress(OSError):
                item.unlink()


def _read(path: Path) -> dict[str, dict[str, Any]]:
    """The entries of a manifest; none where it is missing, damaged or of another version: then all is done anew."""
    try:
        content = json.loads(read_whole(path, LARGEST_MANIFEST).decode("ascii"))
        if content["format"] != FORMAT:
            return {}
        return {stem: entry for stem, entry in content["inputs"].items() if _is_entry(entry)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def _is_entry(entry: Any) -> bool:
    texts: Sequence[str] = ("source", "path", "input", "run")
    numbers: Sequence[str] = ("frames", "instructions", "rejected")
    return (
        isinstance(entry, dict)
        and all(isinstance(entry.get(key), str) for key in texts)
        and all(isinstance(entry.get(key), int) for key in numbers)
        and isinstance(entry.get("files"), list)
        and all(isinstance(name, str) for name in entry["files"])
    )
