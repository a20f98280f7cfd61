"""Composed pictures for training, made once by several processes and kept in a file that is mapped into memory."""

import json
import multiprocessing
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from lightgesture.results.atomic import replacing
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.composites import SIZE, Background, Composite
from lightgesture.training.pictures.cutouts import Cutout
from lightgesture.training.pictures.diver_composites import DiverComposer

PICTURES_A_TASK = 8
_worker: tuple[DiverComposer, int] | None = None
"""The worker's own composer and seed; None in every other process."""


@dataclass(frozen=True, slots=True, eq=False)
class Ingredients:
    """What a composer is made of; see `DiverComposer`. size: (width, height) of its pictures."""

    hands: Sequence[Cutout]
    waters: Sequence[Background]
    rooms: Sequence[Background]
    size: tuple[int, int] = SIZE

    def composer(self, seed: int) -> DiverComposer:
        """One that draws from these."""
        return DiverComposer(self.hands, self.waters, self.rooms, self.size, seed)


def compose_pool(
    ingredients: Ingredients, count: int, seed: int, jobs: int, path: Path
) -> list[BoxedPicture]:
    """`count` pictures in `path` (.npy), mapped; a file that is there already is used as it is.

    Picture `index` is drawn from (seed, index) alone, so that the number of processes changes nothing.
    """
    table = path.with_suffix(".json")
    if not (table.exists() and path.exists()):
        width, height = ingredients.size
        rows = []
        with replacing(path) as temporary:
            images = np.lib.format.open_memmap(
                temporary, mode="w+", dtype=np.uint8, shape=(count, height, width, 3)
            )
            for index, composite in enumerate(_composites(ingredients, count, seed, jobs)):
                images[index] = composite.image
                rows.append([composite.boxes, composite.faces, sorted(composite.sources)])
            images.flush()
        with replacing(table) as temporary:
            temporary.write_text(json.dumps(rows, default=int), encoding="utf-8")
    return _read(path, table)


def _read(path: Path, table: Path) -> list[BoxedPicture]:
    images = np.load(path, mmap_mode="r")
    rows = json.loads(table.read_text(encoding="utf-8"))
    return [
        BoxedPicture(image, tuple(map(tuple, boxes)), tuple(map(tuple, faces)), False, frozenset(sources))
        for image, (boxes, faces, sources) in zip(images, rows, strict=True)
    ]


def _composites(ingredients: Ingredients, count: int, seed: int, jobs: int) -> Iterator[Composite]:
    if jobs <= 1:
        composer = ingredients.composer(seed)
        yield from (composer.compose(np.random.default_rng((seed, index))) for index in range(count))
        return
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(jobs, context, _start, (ingredients, seed)) as pool:
        yield from pool.map(_compose, range(count), chunksize=PICTURES_A_TASK)


def _start(ingredients: Ingredients, seed: int) -> None:
    global _worker
    cv2.setNumThreads(1)
    _worker = ingredients.composer(seed), seed


def _compose(index: int) -> Composite:
    if _worker is None:
        raise RuntimeError("the worker has no composer; call compose_pool")
    composer, seed = _worker
    return composer.compose(np.random.default_rng((seed, index)))
