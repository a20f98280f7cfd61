"""Altered patches of hands for a net that sees each of them many times: made once by several processes, kept in files.

Drawing a copy takes longer than a step of training takes for it, so copies are drawn once, a little larger than
the net's patch, and the net sees another part of them each time.
"""

import json
import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from lightgesture.features.contours import ContourSettings, contour_length, contour_vectors
from lightgesture.features.patch import PatchSettings, cut_patch
from lightgesture.features.types import Image
from lightgesture.models import NONE, TrainingSample
from lightgesture.results.atomic import replacing
from lightgesture.training.augment import MIRRORED_TOKENS, AugmentSettings, augment
from lightgesture.training.hidden_hands import HidingSettings, hide
from lightgesture.training.light import relight
from lightgesture.training.negatives import NegativeSettings, Scene, missed_hand, negatives
from lightgesture.training.samples import LabelledHand
from lightgesture.training.synthetic import SyntheticSettings, synthetic_hands

Progress = Callable[[str, int, int], None]
HANDS_A_TASK = 400


@dataclass(frozen=True, slots=True)
class PoolSettings:
    """How much is drawn and how.

    copies: altered copies of each hand, 1 to 100. rounds: how often regions that are no hand are drawn from each
    picture. hidden: share of the rounds in which a copy of each hand is added of which too little is seen, 0 to 1.
    patch: of the net. margin: pixels that are kept on each side of a patch, by which it is shifted in training.
    contour: numbers of the outline, which go with each patch. rendered, synthetic: number of rendered hands, and how
    they vary. augment, negative, hiding: how copies, regions and hidden hands are made.
    """

    copies: int = 24
    rounds: int = 8
    hidden: float = 0.5
    patch: PatchSettings = field(default_factory=lambda: PatchSettings(size=32, context=1.1))
    margin: int = 2
    contour: ContourSettings = field(default_factory=ContourSettings)
    rendered: int = 12000
    synthetic: SyntheticSettings = field(default_factory=SyntheticSettings)
    augment: AugmentSettings = field(
        default_factory=lambda: AugmentSettings(
            rotation=18.0, scale=0.11, shift=0.06, narrowed=0.2, background=0.6
        )
    )
    negative: NegativeSettings = field(default_factory=NegativeSettings)
    hiding: HidingSettings = field(default_factory=HidingSettings)

    @property
    def kept(self) -> PatchSettings:
        """A patch with its margin."""
        size = self.patch.size + 2 * self.margin
        return PatchSettings(size, self.patch.context * size / self.patch.size)


@dataclass(frozen=True, slots=True, eq=False)
class Originals:
    """What copies are made of. hands: labelled. backgrounds: pictures without hands. scenes: whole pictures."""

    hands: Sequence[LabelledHand]
    backgrounds: Sequence[Scene] = ()
    scenes: Sequence[Scene] = ()


@dataclass(frozen=True, slots=True, eq=False)
class PatchPool:
    """patches: uint8 (n, side, side, 3), BGR, with their margin. contours: float16 (n, c), numbers of the outline.
    tokens, sources: (n,), names. hands: int (n,), number of the hand of which a patch is a copy, -1 for none."""

    patches: NDArray[np.uint8]
    contours: NDArray[np.float16]
    tokens: NDArray[np.str_]
    sources: NDArray[np.str_]
    hands: NDArray[np.int64]


class _Task(NamedTuple):
    """kind: one of `_KINDS`. first, last: of what is drawn. turn: which time."""

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


_worker: tuple[Originals, PoolSettings, int] | None = None
"""The worker's own originals, settings and seed; None in every other process."""


def make_pool(
    originals: Originals, settings: PoolSettings, seed: int, jobs: int, folder: Path, progress: Progress
) -> PatchPool:
    """The pool in `folder`; one that is there already is used as it is.

    Every task is drawn from (seed, its own numbers), so that the number of processes changes nothing.
    """
    table = folder / "patches.json"
    if not table.exists():
        tasks = _tasks(originals, settings)
        patches, contours = [], []
        named: dict[str, list[Any]] = {"tokens": [], "sources": [], "hands": []}
        for done, rows in enumerate(_results(originals, settings, seed, jobs, tasks), 1):
            patches.append(rows.patches)
            contours.append(rows.contours)
            for name, column in named.items():
                column.extend(getattr(rows, name))
            progress("draw patches", done, len(tasks))
        for name, arrays in (("patches", patches), ("contours", contours)):
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
    )


def _tasks(originals: Originals, settings: PoolSettings) -> list[_Task]:
    def parts(kind: str, count: int, turns: int) -> list[_Task]:
        return [
            _Task(kind, first, min(first + HANDS_A_TASK, count), turn)
            for turn in range(turns)
            for first in range(0, count, HANDS_A_TASK)
        ]

    tasks = parts("hands", len(originals.hands), settings.copies)
    if not originals.hands or any(hand.token == NONE for hand in originals.hands):
        scenes = len(originals.backgrounds) + len(originals.scenes)
        tasks += parts("regions", scenes, settings.rounds)
        tasks += parts("missed", len(originals.hands), settings.rounds)
        tasks += parts("hidden", len(originals.hands), settings.rounds)
    return tasks + parts("rendered", settings.rendered, 1)


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
    random = np.random.default_rng((seed, list(_KINDS).index(task.kind), task.turn, task.first))
    size, patches, tokens, sources = settings.kept, [], [], []
    for sample in _KINDS[task.kind](originals, settings, task, random):
        patches.append(cut_patch(sample.image, sample.box, sample.side, size))
        tokens.append(sample.token)
        sources.append(sample.source)
    cut = np.array(patches, np.uint8).reshape(len(patches), size.size, size.size, 3)
    inner = slice(settings.margin, size.size - settings.margin)
    contours = np.zeros((len(cut), contour_length(settings.contour)), np.float16)
    if len(cut):
        contours[:] = contour_vectors(np.ascontiguousarray(cut[:, inner, inner]), settings.contour)
    hands = range(task.first, task.last) if task.kind == "hands" else [-1] * len(cut)
    return _Rows(cut, contours, tokens, sources, list(hands))


def _copies(
    originals: Originals, settings: PoolSettings, task: _Task, random: np.random.Generator
) -> Iterator[TrainingSample]:
    pictures = _behind(originals)
    tokens = {hand.token for hand in originals.hands}
    unmirrored = replace(settings.augment, mirror=0.0)
    for hand in originals.hands[task.first : task.last]:
        known = MIRRORED_TOKENS.get(hand.token, hand.token) in tokens
        image, box, token = augment(hand, pictures, settings.augment if known else unmirrored, random)
        yield TrainingSample(
            image=image, box=box, side=hand.side, token=token, source=hand.source, original=False
        )


def _behind(originals: Originals) -> list[Image]:
    """What may stand behind a hand: water and rooms, or where there is neither, what stands behind other hands."""
    scenes = [scene.image for scene in (*originals.backgrounds, *originals.scenes)]
    return scenes or [one.image for one in originals.hands]


def _hidden(
    originals: Originals, settings: PoolSettings, task: _Task, random: np.random.Generator
) -> Iterator[TrainingSample]:
    pictures = _behind(originals)
    for hand in originals.hands[task.first : task.last]:
        if random.random() < settings.hidden:
            image, box, _ = augment(hand, pictures, settings.augment, random)
            image, box = hide(image, box, pictures, settings.hiding, random)
            yield TrainingSample(
                image=image, box=box, side=hand.side, token=NONE, source=hand.source, original=False
            )


def _missed(
    originals: Originals, settings: PoolSettings, task: _Task, random: np.random.Generator
) -> Iterator[TrainingSample]:
    for hand in originals.hands[task.first : task.last]:
        if random.random() < settings.negative.missed:
            region = missed_hand(hand, settings.negative, random)
            if region is not None:
                yield _relit(region, settings, random)


def _regions(
    originals: Originals, settings: PoolSettings, task: _Task, random: np.random.Generator
) -> Iterator[TrainingSample]:
    scenes = [*originals.backgrounds, *originals.scenes]
    for number in range(task.first, task.last):
        for region in negatives(scenes[number : number + 1], settings.negative, random):
            if not scenes[number].hands:
                # Water differs from picture to picture as people do from source to source, and weighs like them.
                region = replace(region, source=f"{region.source} {number}")
            yield _relit(region, settings, random)


def _rendered(
    originals: Originals, settings: PoolSettings, task: _Task, random: np.random.Generator
) -> Iterator[TrainingSample]:
    seed = int(random.integers(2**31))
    tokens = {hand.token for hand in originals.hands}
    for sample in synthetic_hands(task.last - task.first, seed, settings.synthetic, settings.augment):
        if not tokens or sample.token in tokens:
            yield sample


_KINDS = {
    "hands": _copies,
    "missed": _missed,
    "regions": _regions,
    "rendered": _rendered,
    "hidden": _hidden,
}
"""What is drawn, by kind; the place in this table seeds it."""


def _relit(region: TrainingSample, settings: PoolSettings, random: np.random.Generator) -> TrainingSample:
    """A region cut out with something around it and in other light."""
    x, y, width, height = region.box
    reach = max(width, height)
    rows, columns = region.image.shape[:2]
    left, top = max(0, x - reach), max(0, y - reach)
    part = region.image[top : min(rows, y + height + reach), left : min(columns, x + width + reach)]
    scale = min(1.0, 1.5 * settings.augment.canvas / max(part.shape[:2]))
    if scale < 1.0:
        part = np.asarray(cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA), np.uint8)
    box = (
        round((x - left) * scale),
        round((y - top) * scale),
        max(2, round(width * scale)),
        max(2, round(height * scale)),
    )
    image = relight(part, None, settings.augment.light, random)
    return replace(region, image=image, box=box, original=False)
