"""The training of a second look alone: a model keeps its small net, and the larger one is learnt anew.

So a model that reads dry hands well learns to read those of a dive where it was in doubt, and nothing else of it
changes.
"""

import hashlib
import time
from collections.abc import Callable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from lightgesture._version import __version__
from lightgesture.errors import UsageError
from lightgesture.models import load_classifier
from lightgesture.models.cnn import CnnClassifier
from lightgesture.training.card import make_card
from lightgesture.training.model_files import write_cnn_model, write_json
from lightgesture.training.nets.checkpoints import checkpoint_folder, need_torch, peak_memory_mib
from lightgesture.training.nets.cnn import CnnTraining, net_settings
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.kept_sources import held_out_hands, kept_out
from lightgesture.training.pool.originals import read_originals
from lightgesture.training.pool.patch_kinds import MARGIN
from lightgesture.training.pool.patch_pool import make_pool, rows_without
from lightgesture.training.pool.samples import read_rows, rows_digest
from lightgesture.training.samples import in_order
from lightgesture.training.time_left import tenths


def train_look_to_file(
    training: CnnTraining, first: Path, out: Path, progress: Callable[[str], None]
) -> dict[str, Any]:
    """Train, write `out` and the card beside it (suffix .json), and return the card.

    training: its teachers' steps are those of the larger net. first: model file of a net. What is done lies in a folder
    beside `out`, as in `train_cnn_to_file`. Raises InputError, ModelError, UsageError.
    """
    need_torch()
    from lightgesture.training.nets.second_look import (
        answers_of_both,
        first_teacher,
        second_section,
        with_second_look,
    )

    started = time.monotonic()
    rows = read_rows(training.data, training.without)
    classes = in_order(row.token for row in rows)
    known = load_classifier(first)
    if not isinstance(known, CnnClassifier) or known.classes != classes:
        raise UsageError(f"{first}: is no net of the classes {', '.join(classes)}; train one with train cnn")
    origin = hashlib.sha256(first.read_bytes()).hexdigest()
    told = {"training": repr(replace(training, jobs=1)), "first": origin, "rows": rows_digest(rows)}
    folder = checkpoint_folder(out, {**told, "version": __version__})
    progress(f"reading {len(rows)} hands")
    originals = read_originals(rows, training.backgrounds, training.scenes, training.divers, training.without)
    pool = make_pool(originals, training.pool, training.seed, training.jobs, folder, tenths(progress))
    kept = kept_out(originals.hands)
    sources = np.array([hand.source for hand in originals.hands])
    samples = HandSamples(pool, rows_without(pool, sources, kept), classes, MARGIN)
    how = replace(net_settings(training), steps=training.teacher_steps)
    larger = first_teacher(samples, how, training.seed, folder, progress)
    hands = held_out_hands(known.model, originals, pool, kept)
    model = with_second_look(known.model, larger, hands)
    card = {
        "name": "cnn",
        "what": "hand patch to token: a small net that was trained before, and a larger one for what it doubts",
        "small_net": {
            "of_the_file_with_sha256": origin,
            "trained_on": "an earlier table of hands/train: 12,278 hands, 5 of them under GPL-3.0, none of a real diver"
            if first.is_relative_to(Path(__file__).resolve().parents[2])
            else "see its own card",
        },
        **make_card(rows, originals, pool, training.without, answers_of_both(model, hands), classes),
        "training": {
            "seed": training.seed,
            "steps": {"larger_net": training.teacher_steps},
            "settings": {"pool": asdict(training.pool), "net": asdict(how)},
            "seconds": round(time.monotonic() - started),
            "peak_memory_mib": peak_memory_mib(),
        },
        "model": {"temperature": model.temperature, "second_look": second_section(model)},
    }
    write_cnn_model(model, out)
    write_json(card, out.with_suffix(".json"))
    return card
