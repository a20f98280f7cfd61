"""One training as a row: a net or what a card tells, scored on hands that it did not see and on `hands/val`."""

from collections.abc import Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np

from lightgesture.benchmarks.reading.hands import HandAnswer, summary_cells
from lightgesture.benchmarks.studies.data import Mask, Study, answers_of, val_answers
from lightgesture.benchmarks.tables import Cell
from lightgesture.console import say
from lightgesture.models.cnn import CnnModel
from lightgesture.training.nets.cnn import CnnTraining, in_integers, learn

PARTS = ("hands", "accuracy", "macro_token", "worst_token", "worst_accuracy", "none_auroc")
"""Figures of a group of hands; see `hands.summary_table`."""
COLUMNS = ("row", "sources", *(f"held_{name}" for name in PARTS), *(f"val_{name}" for name in PARTS))
NOTE = (
    "accuracy: argmax over the ten tokens, nothing refused; held: hands of `hands/train` that the row's model did not "
    "see;\nval: `hands/val`. Nets in integers, one seed."
)
Rows = list[dict[str, Cell]]


def net_of(study: Study, name: str, rows: Mask, training: CnnTraining, folder: Path) -> CnnModel:
    """A net trained on rows of the pool.

    folder: of all trainings from this pool; each has one of its own there, so that rows of several studies that are the
    same training are trained once.
    """
    from lightgesture.training.nets.checkpoints import checkpoint_folder

    chosen = sha256(np.packbits(rows).tobytes()).hexdigest()
    request = {"training": repr(replace(training, jobs=1)), "rows": chosen}
    digest = sha256(repr(request).encode()).hexdigest()[:12]
    parts = checkpoint_folder(folder / digest, request)
    learnt = learn(study.pool, rows, study.classes, training, parts, lambda text: say(f"{name}: {text}"))
    return in_integers(learnt, training)


def fit_row(
    study: Study, name: str, rows: Mask, held: Mask, training: CnnTraining, folder: Path
) -> dict[str, Cell]:
    """Train a net on rows of the pool and score it on the held-out hands and on val; folder: see `net_of`."""
    from lightgesture.models.cnn import CnnClassifier
    from lightgesture.training.nets.architectures import multiply_adds

    model = net_of(study, name, rows, training, folder)
    classifier = CnnClassifier(model)
    seen = np.unique(study.pool.sources[rows])
    row: dict[str, Cell] = {
        "row": name,
        "sources": int(np.isin(np.unique(study.sources), seen).sum()),
        **scored_cells("held", answers_of(classifier, study, held)),
        **scored_cells("val", val_answers(classifier, study)),
        "multiply_adds": multiply_adds(model.network.inputs, model.network.nodes),
        "weights": sum(own.weights.size + own.biases.size for own in model.network.weights.values()),
    }
    say(f"{name}: held {row.get('held_accuracy')}, val {row.get('val_accuracy')}")
    return row


def scored_cells(part: str, answers: Sequence[HandAnswer]) -> dict[str, Cell]:
    """Figures of one part, their names beginning with it."""
    cells = summary_cells(part, answers) if answers else {}
    return {f"{part}_{name}": cells.get(name) for name in PARTS}


def mean_and_worst(model: str, rows: Rows) -> Rows:
    """Mean and lowest accuracy of the folds of a model."""
    found = [value for row in rows if isinstance(value := row["held_accuracy"], float)]
    hands = sum(value for row in rows if isinstance(value := row["held_hands"], int))
    if not found:
        return []
    mean: dict[str, Cell] = {
        "row": f"{model} mean",
        "held_hands": hands,
        "held_accuracy": float(np.mean(found)),
    }
    return [mean, {"row": f"{model} worst fold", "held_accuracy": min(found)}]
