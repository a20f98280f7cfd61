"""The hands that studies of reading are made with: the pool of altered patches, and who is held out of a training."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lightgesture.benchmarks.methods import Classifier
from lightgesture.benchmarks.reading.hands import HandAnswer, classify
from lightgesture.benchmarks.reading.robustness import SEEN_SETS
from lightgesture.errors import InputError
from lightgesture.training.datasets import Label, Sample, read_hands, read_table
from lightgesture.training.nets.cnn import CnnTraining
from lightgesture.training.pool.originals import Originals, PoolSettings, read_originals
from lightgesture.training.pool.patch_pool import PatchPool, make_pool
from lightgesture.training.pool.samples import HandRow, LabelledHand, load_hand, read_rows
from lightgesture.training.samples import in_order
from lightgesture.training.time_left import tenths

LEFT_OUT = ("emre_drone",)
"""Sources of `hands/train` that no training sees: people of the frames that are reported."""

Progress = Callable[[str], None]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """data: the folder. folder: of the pool and of what is trained. rows, hands: of `hands/train`, in one order.
    subjects: of each hand, "" where unknown. pool: of copies of the hands. val: hands that nothing is trained on."""

    data: Path
    folder: Path
    rows: Sequence[HandRow]
    hands: Sequence[LabelledHand]
    subjects: Sequence[str]
    pool: PatchPool
    val: Sequence[Sample]

    @property
    def sources(self) -> NDArray[np.str_]:
        """Source of each hand, (n,)."""
        return np.array([hand.source for hand in self.hands])

    @property
    def classes(self) -> tuple[str, ...]:
        """Classes of the hands, in their usual order."""
        return in_order(hand.token for hand in self.hands)


def training_of(data: Path, **changes: object) -> CnnTraining:
    """The training of the shipped net from a data folder, with changed fields."""
    negatives, scenes = data / "negatives", data / "webcam" / "train.csv"
    divers = data / "divers" / "boxes.csv"
    training = CnnTraining(
        data=data / "hands" / "train.csv",
        backgrounds=tuple(negatives / name for name in sorted(SEEN_SETS) if (negatives / name).is_dir()),
        scenes=scenes if scenes.is_file() else None,
        divers=divers if divers.is_file() else None,
        without=LEFT_OUT,
    )
    return replace(training, **changes)  # type: ignore[arg-type]


def open_study(data: Path, folder: Path, training: CnnTraining, progress: Progress) -> Study:
    """The study in `folder`: a pool that is there is used as it is, otherwise it is drawn. Raises InputError."""
    rows, subjects = _rows_and_subjects(data, training)
    progress(f"reading {len(rows)} hands")
    made = (folder / "patches.json").is_file()
    originals = (
        Originals([load_hand(row) for row in rows])
        if made
        else read_originals(rows, training.backgrounds, training.scenes, training.divers, training.without)
    )
    pool = draw_pool(originals, training.pool, training, folder, progress)
    return Study(data, folder, rows, originals.hands, subjects, pool, read_hands(data))


def few_originals(training: CnnTraining, count: int) -> Originals:
    """At most `count` hands, evenly spread over the rows of the training's table, and all other pictures of it."""
    rows = read_rows(training.data, training.without)
    places = np.linspace(0, len(rows) - 1, min(count, len(rows))).round().astype(int)
    chosen = [rows[place] for place in places]
    return read_originals(chosen, training.backgrounds, training.scenes, training.divers, training.without)


def draw_pool(
    originals: Originals, settings: PoolSettings, training: CnnTraining, folder: Path, progress: Progress
) -> PatchPool:
    """The pool in a folder, drawn where there is none. InputError: it was drawn of other hands."""
    folder.mkdir(parents=True, exist_ok=True)
    try:
        told = tenths(lambda line: progress(f"{folder.name}: {line}"))
        pool = make_pool(originals, settings, training.seed, training.jobs, folder, told)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(
            f"{folder}: holds no pool that can be read ({error!r}); give another --pool"
        ) from error
    sources = np.array([hand.source for hand in originals.hands])
    own = pool.hands >= 0
    copied = pool.hands[own]
    if len(copied) and (copied.max() >= len(sources) or (sources[copied] != pool.sources[own]).any()):
        raise InputError(f"{folder}: holds a pool of other hands; remove it or give another --pool")
    return pool


def _rows_and_subjects(data: Path, training: CnnTraining) -> tuple[list[HandRow], list[str]]:
    rows = read_rows(training.data)
    named = [row.get("subject") or "" for row in read_table(data, "hands/train.csv")]
    kept = [place for place, row in enumerate(rows) if row.source not in training.without]
    return [rows[place] for place in kept], [named[place] for place in kept]


def rows_of_sources(pool: PatchPool, sources: NDArray[np.str_], chosen: Sequence[str]) -> Mask:
    """Rows of the chosen sources of hands, and all rows of what shows none of the people: rendered, under water."""
    return np.asarray(np.isin(pool.sources, chosen) | ~np.isin(pool.sources, np.unique(sources)))


def held_out_subjects(sources: Sequence[str], subjects: Sequence[str], one_in: int) -> Mask:
    """Hands of one in so many subjects of each source in which two or more are told apart, bool (n,).

    Of each such source at least one subject is held out and at least one is not.
    """
    known: dict[str, set[str]] = {}
    for source, subject in zip(sources, subjects, strict=True):
        if subject:
            known.setdefault(source, set()).add(subject)
    held = {
        (source, subject)
        for source, names in known.items()
        if len(names) > 1
        for subject in sorted(names)[::one_in]
    }
    return np.array([pair in held for pair in zip(sources, subjects, strict=True)])


def answers_of(classifier: Classifier, study: Study, chosen: Mask) -> list[HandAnswer]:
    """The classifier's answers for chosen hands of `hands/train`, as they are."""
    answers = []
    for place in np.flatnonzero(chosen).tolist():
        row, hand = study.rows[place], study.hands[place]
        label = Label(hand.box, hand.side, hand.token)
        sample = Sample(row.path, (label,), row.source, row.source)
        probabilities = classifier.probabilities(hand.image, [hand.box], [hand.side])[0]
        answers.append(HandAnswer(sample, label, tuple(classifier.classes), probabilities))
    return answers


def val_answers(classifier: Classifier, study: Study) -> list[HandAnswer]:
    """The classifier's answers for `hands/val`."""
    return classify(classifier, study.val)
