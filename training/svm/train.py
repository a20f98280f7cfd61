"""From a manifest to a model file and its card: the training of the SVM from end to end."""

from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture._version import __version__
from lightgesture.features.vector import block_lengths
from lightgesture.models import CLASSES
from lightgesture.training.card import make_card
from lightgesture.training.model_files import write_json, write_svm_model
from lightgesture.training.nets.checkpoints import checkpoint_folder, peak_memory_mib
from lightgesture.training.nets.spent_time import SpentTime
from lightgesture.training.pool.originals import PoolSettings, read_originals
from lightgesture.training.pool.patch_pool import make_pool
from lightgesture.training.pool.pool_samples import pool_samples
from lightgesture.training.pool.samples import read_rows, rows_digest
from lightgesture.training.samples import in_order
from lightgesture.training.svm.machine import SvmSettings, train_svm
from lightgesture.training.svm.projection import Progress


@dataclass(frozen=True, slots=True)
class SvmTraining:
    """What is trained from what."""

    data: Path | None
    """Manifest, or folder with a folder a class; None to train on rendered hands alone."""
    backgrounds: tuple[Path, ...] = ()
    """Folders of pictures without hands."""
    scenes: Path | None = None
    """Table of whole pictures with boxes of hands and faces."""
    divers: Path | None = None
    """Table of pictures of real divers with their hands, see `pool.divers`."""
    without: tuple[str, ...] = ()
    """Sources of `data` and dives of `divers` that are left out."""
    seed: int = 0
    """Of everything drawn."""
    jobs: int = 1
    """Processes that draw patches."""
    pool: PoolSettings = field(default_factory=PoolSettings)
    """What is drawn."""
    svm: SvmSettings = field(default_factory=SvmSettings)
    """The machine."""


def train_svm_to_file(training: SvmTraining, out: Path, progress: Progress) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    The patches that were drawn lie in a folder beside `out` and are used when the same command runs again; it may be
    removed when the files are written. Raises InputError for unreadable data, UsageError for classes that will not do
    and ModelError for samples or files that will not do; neither file is touched before the training is done.
    """
    rows = [] if training.data is None else read_rows(training.data, training.without)
    classes = in_order(row.token for row in rows) or CLASSES
    originals = read_originals(rows, training.backgrounds, training.scenes, training.divers, training.without)
    request = {
        "training": repr(replace(training, jobs=1)),
        "rows": rows_digest(rows),
        "version": __version__,
    }
    folder = checkpoint_folder(out, request)
    spent = SpentTime(folder)
    progress = spent.kept_by(progress)
    pool = make_pool(originals, training.pool, training.seed, training.jobs, folder, progress)
    samples = pool_samples(
        pool,
        originals,
        np.ones(len(pool.tokens), bool),
        np.ones(len(originals.hands), bool),
        training.pool,
        training.seed,
    )
    model, held_out = train_svm(samples, training.svm, classes=classes, seed=training.seed, progress=progress)
    gradients, contour = block_lengths(model.features)
    card = {
        "name": "svm",
        "what": "hand patch to token: gradients and contour numbers, radial machine with learnt expansion vectors",
        **make_card(rows, originals, pool, training.without, held_out, classes),
        "training": {
            "seed": training.seed,
            "settings": {"pool": asdict(training.pool), "svm": asdict(training.svm)},
            "seconds": spent.whole_seconds,
            "peak_memory_mib": peak_memory_mib(),
        },
        "model": {
            "numbers_of_a_patch": {"gradients": gradients, "contour": contour},
            "dimensions": model.centres.shape[1],
            "vectors": len(model.centres),
            "temperature": model.temperature,
        },
    }
    write_svm_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card
