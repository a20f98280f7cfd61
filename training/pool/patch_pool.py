"""Altered patches of hands for a net that sees each of them many times: made once by several processes, kept in files.

Drawing a copy takes longer than a step of training takes for it, so copies are drawn once, a little larger than
the net's patch, and the net sees another part of them each time.
"""

import json
import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lightgesture.errors import UsageError
from lightgesture.features.outline.contours import contour_length, contour_vectors
from lightgesture.features.patch import cut_patch
from lightgesture.models import NONE
from lightgesture.results.atomic import replacing
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.patch_kinds import (
    CONTOUR,
    COPIED,
    KEPT,
    KINDS,
    MARGIN,
)
from lightgesture.training.pool.patch_landmarks import COORDINATES, patch_landmarks

Progress = Callable[[str, int, int], None]
HANDS_A_TASK = 400


@dataclass(frozen=True, slots=True, eq=False)
class PatchPool:
    """patches: uint8 (n, side, side, 3), BGR, with their margin. contours: float16 (n, c), numbers of the outline.
    tokens, sources: (n,), names. hands: int (n,), number of the hand of which a patch is a copy, -1 for none.
    landmarks: float16 (n, 42), x and y of each in sides of a patch with its margin, NaN where unknown, see
    `patch_landmarks`; None for a pool that was drawn without."""

    patches: NDArray[np.uint8]
    contours: NDArray[np.float16]
    tokens: NDArray[np.str_]
    sources: NDArray[np.str_]
    hands: NDArray[np.int64]
    landmarks: NDArray[np.float16] | None = None


class _Task(NamedTuple):
    """kind: one of `KINDS`. first, last: of what is drawn. turn: which time."""

    kind: str
    first: int
    last: int
    turn: int


class _Rows(NamedTuple):
    """A part of the pool; see `PatchPool`."""

    patches: NDArray[np.uint8]
    contours: NDArray[np.float16]
    tokens: list[str]
    sources: list[str]
    hands: list[int]
    landmarks: NDArray[np.float16]


_worker: tuple[Originals, PoolSettings, int] | None = None
"""The worker's own originals, settings and seed; None in every other process."""


def make_pool(
    originals: Originals, settings: PoolSettings, seed: int, jobs: int, folder: Path, progress: Progress
) -> PatchPool:
    """The pool in `folder`; one that is there already is used as it is.

    Every task is drawn from (seed, its own numbers), so that the number of processes changes nothing. A pool may lack
    the file of landmarks. Raises UsageError where that file is of another pool.
    """
    table = folder / "patches.json"
    if not table.exists():
        tasks = _tasks(originals, settings)
        patches, contours, landmarks = [], [], []
        named: dict[str, list[Any]] = {"tokens": [], "sources": [], "hands": []}
        for done, rows in enumerate(_results(originals, settings, seed, jobs, tasks), 1):
            patches.append(rows.patches)
            contours.append(rows.contours)
            landmarks.append(rows.landmarks)
            for name, column in named.items():
                column.extend(getattr(rows, name))
            progress("draw patches", done, len(tasks))
        for name, arrays in (("patches", patches), ("contours", contours), ("landmarks", landmarks)):
            with replacing(folder / f"{name}.npy") as temporary, temporary.open("wb") as stream:
                np.save(stream, np.concatenate(arrays))
        with replacing(table) as temporary:
            temporary.write_text(json.dumps(named), encoding="utf-8")
    names = json.loads(table.read_text(encoding="utf-8"))
    return PatchPool(
        np.load(folder / "patches.npy", mmap_mode="r"),
        np.load(folder / "contours.npy", mmap_mode="r"),
        np.array(names["tokens"]),
        np.array(names["sources"]),
        np.array(names["hands"], np.int64),
        _landmarks_of(folder, len(names["tokens"])),
    )


def _landmarks_of(folder: Path, count: int) -> NDArray[np.float16] | None:
    """Those of a pool of `count` patches, None where it was drawn without."""
    path = folder / "landmarks.npy"
    if not path.exists():
        return None
    landmarks = np.asarray(np.load(path), np.float16)
    if landmarks.shape != (count, COORDINATES):
        raise UsageError(f"{path}: holds landmarks of other patches; copy it from where the patches are from")
    return landmarks


def rows_without(
    pool: PatchPool, sources: NDArray[np.str_], held_out: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Rows of the pool for a training that sees nothing of the held-out hands, bool (rows,).

    sources, held_out: of the hands. Of a source with a held-out hand, no region without a hand is kept either, unless
    every source has one.
    """
    touched = np.unique(sources[held_out])
    if len(touched) == len(np.unique(sources)):
        touched = touched[:0]
    return np.where(pool.hands >= 0, ~held_out[pool.hands], ~np.isin(pool.sources, touched))


def _tasks(originals: Originals, settings: PoolSettings) -> list[_Task]:
    def parts(kind: str, count: int, turns: int) -> list[_Task]:
        return [
            _Task(kind, first, min(first + HANDS_A_TASK, count), turn)
            for turn in range(turns)
            for first in range(0, count, HANDS_A_TASK)
        ]

    divers = originals.divers
    tasks = parts("hands", len(originals.hands), settings.copies)
    if not originals.hands or any(hand.token == NONE for hand in originals.hands):
        scenes = len(originals.backgrounds) + len(originals.scenes) + len(divers.scenes)
        tasks += parts("regions", scenes, settings.rounds)
        tasks += parts("missed", len(originals.hands), settings.rounds)
        tasks += parts("hidden", len(originals.hands), settings.rounds)
        tasks += parts("resting", len(divers.resting), settings.resting_copies)
    tasks += parts("mild", len(originals.hands), settings.mild_copies)
    tasks += parts("sea", len(originals.hands) if divers.looks else 0, settings.sea_copies)
    tasks += parts("shown", len(divers.shown), settings.shown_copies)
    tasks += parts("rendered", settings.rendered if originals.rendered_classes else 0, 1)
    return tasks + parts("posed", settings.posed if len(originals.poses) else 0, 1)


def _results(
    originals: Originals, settings: PoolSettings, seed: int, jobs: int, tasks: Sequence[_Task]
) -> Iterator[_Rows]:
    if jobs <= 1:
        _start(originals, settings, seed)
        yield from map(_draw, tasks)
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, _start, (originals, settings, seed)) as pool:
        yield from pool.map(_draw, tasks)


def _start(originals: Originals, settings: PoolSettings, seed: int) -> None:
    global _worker
    _worker = originals, settings, seed


def _draw(task: _Task) -> _Rows:
    if _worker is None:
        raise RuntimeError("the worker has nothing to draw from; call make_pool")
    originals, settings, seed = _worker
    random = np.random.default_rng((seed, list(KINDS).index(task.kind), task.turn, task.first))
    patches, tokens, sources, landmarks = [], [], [], []
    for sample in KINDS[task.kind](originals, settings, task.first, task.last, random):
        patches.append(cut_patch(sample.image, sample.box, sample.side, KEPT))
        landmarks.append(patch_landmarks(sample, KEPT))
        tokens.append(sample.token)
        sources.append(sample.source)
    cut = np.array(patches, np.uint8).reshape(len(patches), KEPT.size, KEPT.size, 3)
    inner = slice(MARGIN, KEPT.size - MARGIN)
    contours = np.zeros((len(cut), contour_length(CONTOUR)), np.float16)
    if len(cut):
        contours[:] = contour_vectors(np.ascontiguousarray(cut[:, inner, inner]), CONTOUR)
    hands = range(task.first, task.last) if task.kind in COPIED else [-1] * len(cut)
    places = np.array(landmarks, np.float16).reshape(len(cut), COORDINATES)
    return _Rows(cut, contours, tokens, sources, list(hands), places)
