"""From a manifest to a model file and its card: the training of the SVM from end to end."""

import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture._version import __version__
from lightgesture.features.vector import block_lengths
from lightgesture.models import CLASSES
from lightgesture.models.projection import Progress
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.card import LIMITS, data_section, held_out_section, operating_points
from lightgesture.training.model_files import write_json, write_svm_model
from lightgesture.training.nets.checkpoints import checkpoint_folder, peak_memory_mib
from lightgesture.training.pool.originals import read_originals
from lightgesture.training.pool.patch_kinds import Originals, PoolSettings
from lightgesture.training.pool.patch_pool import make_pool
from lightgesture.training.pool.pool_samples import PoolSampling, pool_samples
from lightgesture.training.pool.samples import HandRow, read_rows
from lightgesture.training.svm.machine import HeldOut, SvmSettings, train_svm


@dataclass(frozen=True, slots=True)
class SvmTraining:
    """What is trained from what.

    data: manifest, or folder with a folder a class, or None to train on rendered hands alone. backgrounds: folders of
    pictures without hands. scenes: table of whole pictures with boxes of hands and faces, or None. without: sources of
    `data` that are left out. seed: of everything drawn. jobs: processes that draw patches. pool: what is drawn.
    sampling: what it weighs. svm: of the machine; raises ValueError if it reads another patch than is drawn.
    """

    data: Path | None
    backgrounds: tuple[Path, ...] = ()
    scenes: Path | None = None
    without: tuple[str, ...] = ()
    seed: int = 0
    jobs: int = 1
    pool: PoolSettings = field(default_factory=PoolSettings)
    sampling: PoolSampling = field(default_factory=PoolSampling)
    svm: SvmSettings = field(default_factory=SvmSettings)

    def __post_init__(self) -> None:
        if self.svm.features.patch != self.pool.patch:
            raise ValueError(
                f"the machine reads {self.svm.features.patch}, the pool holds {self.pool.patch}; give both the same"
            )


def train_svm_to_file(training: SvmTraining, out: Path, progress: Progress) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    The patches that were drawn lie in a folder beside `out` and are used when the same command runs again; it may be
    removed when the files are written. Raises InputError for unreadable data and ModelError for samples or files that
    will not do; neither file is touched before the training is done.
    """
    started = time.monotonic()
    every_row = [] if training.data is None else read_rows(training.data)
    rows = [row for row in every_row if row.source not in training.without]
    originals = read_originals(training, rows)
    request = {"training": repr(replace(training, jobs=1)), "rows": len(rows), "version": __version__}
    folder = checkpoint_folder(out, request)
    pool = make_pool(originals, training.pool, training.seed, training.jobs, folder, progress)
    samples = pool_samples(
        pool,
        originals,
        np.ones(len(pool.tokens), bool),
        np.ones(len(originals.hands), bool),
        training.pool,
        training.sampling,
        training.seed,
    )
    present = {row.token for row in rows} or set(CLASSES)
    classes = [name for name in CLASSES if name in present]
    model, held_out = train_svm(samples, training.svm, classes=classes, seed=training.seed, progress=progress)
    card = make_card(training, rows, originals, model, held_out)
    card["training"]["rows"] = len(pool.tokens)
    card["training"]["seconds"] = round(time.monotonic() - started)
    card["training"]["peak_memory_mib"] = peak_memory_mib()
    write_svm_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card


def make_card(
    training: SvmTraining,
    rows: Sequence[HandRow],
    originals: Originals,
    model: SvmModel,
    held_out: HeldOut,
) -> dict[str, Any]:
    """The card of a trained model, ready for JSON."""
    gradients, contour = block_lengths(model.features)
    settings = training.svm
    return {
        "name": "svm",
        "version": __version__,
        "what": "hand patch to token: gradients and contour numbers, radial machine with learnt expansion vectors",
        "classes": list(model.classes),
        "use": "bare hands of a diver facing the camera, in boxes of lightgesture's selector",
        "limits": list(LIMITS),
        "data": data_section(rows, originals, training.without, training.pool.rendered),
        "training": {
            "seed": training.seed,
            "settings": {
                "pool": asdict(training.pool),
                "sampling": asdict(training.sampling),
                "svm": asdict(settings),
            },
            "kept_from_the_machine": f"one of {settings.one_in} groups of sources of like size, for the temperature "
            "and the scores below",
        },
        "model": {
            "numbers_of_a_patch": {"gradients": gradients, "contour": contour},
            "dimensions": model.centres.shape[1],
            "vectors": len(model.centres),
            "temperature": model.temperature,
        },
        "held_out_sources": held_out_section(held_out, model.classes),
        "operating_points": operating_points(held_out, model.classes),
    }
