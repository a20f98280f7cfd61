"""Rendered clips in the user's cache folder: made once, made again when damaged, bounded in size.

A clip is a folder with its video and its truth, written under a temporary name and renamed when complete. The last line
of the truth holds the digests of both, so that a half-written or damaged clip is never scored.
"""

import hashlib
import json
import multiprocessing
import os
import shutil
import time
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, Protocol

import cv2

from lightgesture._version import __version__
from lightgesture.benchmarks.suite.scenarios import Scenario
from lightgesture.benchmarks.suite.scoring import TimedWord
from lightgesture.errors import InputError, UsageError
from lightgesture.fsm import load_grammar
from lightgesture.results.atomic import replacing_folder
from lightgesture.results.writers import to_json_line
from lightgesture.synth.output import video_writer, with_truth
from lightgesture.synth.scene import SceneFrame
from lightgesture.training.datasets import Label

VIDEO, TRUTH = "clip.mp4", "truth.jsonl"


MAX_BYTES: Final = 1_500_000_000
"""What all clips together may take; the longest unused go first."""

STALE_S: Final = 86_400.0
"""Age in seconds at which what an interrupted run has left is swept away."""

HOLD: Final = 15
"""Dwell of the truth in frames, as the paper's."""


class Take(Protocol):
    """What can be rendered: a scenario with all that decides its pixels."""

    @property
    def scenario(self) -> Scenario:
        """What is shown."""
        ...

    @property
    def fps(self) -> float:
        """Frames a second."""
        ...

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        ...

    @property
    def recipe(self) -> str:
        """Text that changes whenever the pixels do."""
        ...

    def frames(self) -> Iterator[SceneFrame]:
        """Pictures with their truth."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Clip:
    """A rendered scenario. labels: hands that show a token, frame by frame. words, instructions: what a flawless
    reader of every frame accepts.
    """

    scenario: Scenario
    video: Path
    labels: tuple[tuple[Label, ...], ...]
    words: tuple[TimedWord, ...]
    instructions: tuple[str, ...]


def cache_folder() -> Path:
    """`lightgesture/suite` under the user's cache directory (XDG Base Directory Specification)."""
    named = os.environ.get("XDG_CACHE_HOME", "")
    # The specification wants relative paths ignored.
    root = Path(named) if os.path.isabs(named) else Path.home() / ".cache"
    return root / "lightgesture" / "suite"


def source_digest(paths: Iterable[Path]) -> str:
    """Digest of source files: pictures change with the code that draws them."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def fetch_clip(take: Take, folder: Path, max_bytes: int = MAX_BYTES) -> Clip:
    """The clip of a take, from `folder`, which is kept below a size, or rendered now."""
    recipe = f"{__version__} {HOLD} {take.scenario} {take.recipe}"
    place = folder / hashlib.sha256(recipe.encode()).hexdigest()[:32]
    clip = _read(take.scenario, place)
    if clip is None:
        _render(take, place)
        _sweep(folder, place, max_bytes)
        clip = _read(take.scenario, place)
        if clip is None:
            raise InputError(f"{place}: was written and cannot be read; look for a full or failing disk")
    with suppress(OSError):
        os.utime(place)
    return clip


def fetch_clips(takes: Sequence[Take], folder: Path, jobs: int = 1) -> Iterator[Clip]:
    """The clips of takes in order, rendered where needed by `jobs` processes of one thread each (1: in this one)."""
    if jobs <= 1:
        for take in takes:
            yield fetch_clip(take, folder)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, initializer=cv2.setNumThreads, initargs=(1,)) as pool:
        try:
            yield from pool.map(partial(fetch_clip, folder=folder), takes)
        except BaseException:  # an interruption must not wait for clips that nobody needs any more
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _render(take: Take, place: Path) -> None:
    try:
        # Another process may put the same clip there in between: its pixels are the same.
        with replacing_folder(place) as building:
            lines = []
            with video_writer(building / VIDEO, take.fps, take.size) as put:
                for frame, records in with_truth(take.frames(), load_grammar(), HOLD):
                    put(frame.image)
                    lines += [to_json_line(record) for record in records]
            text = "\n".join(lines) + "\n"
            end = {
                "type": "end",
                "video": _digest((building / VIDEO).read_bytes()),
                "truth": _digest(text.encode()),
            }
            (building / TRUTH).write_text(text + json.dumps(end) + "\n", encoding="utf-8")
    except UsageError as error:
        raise InputError(f"{error}: set XDG_CACHE_HOME to one that can be written") from error


def _read(scenario: Scenario, place: Path) -> Clip | None:
    """The clip of a folder, None where it is missing or damaged."""
    try:
        text = (place / TRUTH).read_text(encoding="utf-8")
        video = (place / VIDEO).read_bytes()
        body, _, last = text.rstrip("\n").rpartition("\n")
        end = json.loads(last)
    except (OSError, ValueError):
        return None
    intact = isinstance(end, dict) and (end.get("video"), end.get("truth")) == (
        _digest(video),
        _digest((body + "\n").encode()),
    )
    return (
        _clip(scenario, place / VIDEO, [json.loads(line) for line in body.splitlines()]) if intact else None
    )


def _clip(scenario: Scenario, video: Path, records: list[dict[str, Any]]) -> Clip:
    return Clip(
        scenario,
        video,
        labels=tuple(
            tuple(
                Label((box[0], box[1], box[2], box[3]), hand["side"], hand["token"])
                for hand in record["hands"]
                if hand["token"] is not None and (box := hand["box"])
            )
            for record in records
            if record["type"] == "frame"
        ),
        words=tuple(
            TimedWord(record["word"], record["time_s"]) for record in records if record["type"] == "word"
        ),
        instructions=tuple(record["text"] for record in records if record["type"] == "instruction"),
    )


def _sweep(folder: Path, kept: Path, max_bytes: int) -> None:
    """Remove the longest unused clips beyond the bound, and what interrupted runs have left."""
    used: list[tuple[float, int, Path]] = []
    for place in folder.iterdir():
        with suppress(OSError):
            age = place.stat().st_mtime
            if place.name.startswith("."):
                if time.time() - age > STALE_S:
                    shutil.rmtree(place, ignore_errors=True)
                continue
            used.append((age, sum(file.stat().st_size for file in place.iterdir()), place))
    total = 0
    for _, size, place in sorted(used, reverse=True):
        total += size
        if total > max_bytes and place != kept:
            shutil.rmtree(place, ignore_errors=True)


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
