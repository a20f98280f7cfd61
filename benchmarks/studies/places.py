"""Second looks for places of real divers that nothing was learnt of: what is read where a model has never been."""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np

from lightgesture.benchmarks.divers.pictures import DiverFrame, read_divers
from lightgesture.benchmarks.divers.report import JOINED
from lightgesture.benchmarks.divers.rows import FrameRow, HandRow
from lightgesture.benchmarks.divers.scoring import DiverMethod, score_divers
from lightgesture.benchmarks.divers.tables import diver_tables
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.studies.data import Mask, Study
from lightgesture.benchmarks.tables import Table
from lightgesture.console import say
from lightgesture.errors import InputError
from lightgesture.features.types import Image
from lightgesture.models import load_classifier
from lightgesture.models.cnn import CnnClassifier, CnnModel
from lightgesture.training.model_files import write_cnn_model
from lightgesture.training.nets.cnn import CnnTraining, net_settings
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.pool.divers import SOURCE
from lightgesture.training.pool.kept_hands import kept_out
from lightgesture.training.pool.kept_sources import held_out_hands
from lightgesture.training.pool.originals import Originals
from lightgesture.training.pool.patch_kinds import MARGIN
from lightgesture.training.pool.patch_pool import rows_without


class FindsNothing:
    """Stands in the place of a selector where hands are read in given boxes alone."""

    def read(self, image: Image) -> list[Reading]:
        """Nothing, whatever the picture shows."""
        del image
        return []


def places(study: Study, training: CnnTraining, folder: Path, args: argparse.Namespace) -> list[Table]:
    """The small net of a model with a larger one for its second look, trained without some places, and read there in
    given boxes.

    Each model is left in `folder`, named after its places, for `evaluate divers --place PLACE --model`. InputError:
    the pool has no divers of a place.
    """
    first = load_classifier(args.first)
    if not isinstance(first, CnnClassifier):
        raise InputError(f"{args.first}: is no net; --first takes one")
    frames = read_divers(study.data)
    signing = sorted({frame.place for frame in frames if any(hand.is_sign for hand in frame.hands)})
    hands: list[HandRow] = []
    rows: list[FrameRow] = []
    for group in args.group or signing:
        names = group.split(",")
        own = [frame for frame in frames if frame.place in names]
        model = second_look_without(study, first.model, own, training, folder)
        write_cnn_model(model, folder / f"{'_'.join(names)}.npz")
        scored = score_divers([DiverMethod(group, FindsNothing(), CnnClassifier(model))], own)
        hands += [replace(row, method=JOINED) for row in scored.hands]
        rows += [replace(row, method=JOINED) for row in scored.frames]
    return diver_tables(hands, rows)


def second_look_without(
    study: Study, first: CnnModel, frames: Sequence[DiverFrame], training: CnnTraining, folder: Path
) -> CnnModel:
    """The small net of `first` with a larger one that has learnt nothing of the dives of these frames.

    What is done lies in `folder`. InputError: the pool has none of these dives.
    """
    from lightgesture.training.nets.checkpoints import checkpoint_folder
    from lightgesture.training.nets.second_look import first_teacher, with_second_look

    kept = kept_out(study.hands)
    rows = rows_without(study.pool, study.sources, kept) & ~_of_dives(study, frames)
    request = {
        "training": repr(replace(training, jobs=1)),
        "rows": sha256(np.packbits(rows).tobytes()).hexdigest(),
    }
    digest = sha256(repr(request).encode()).hexdigest()[:12]
    parts = checkpoint_folder(folder / digest, request)
    samples = HandSamples(study.pool, rows, study.classes, MARGIN)
    settings = net_settings(training)
    larger = first_teacher(samples, settings, training.seed, parts, say)
    hands = held_out_hands(first, Originals(study.hands), study.pool, kept)
    return with_second_look(first, larger, hands)


def _of_dives(study: Study, frames: Sequence[DiverFrame]) -> Mask:
    seen = np.isin(study.pool.sources, [f"{SOURCE} {frame.dive}" for frame in frames])
    if not seen.any():
        raise InputError(f"{study.folder}: its pool has none of these dives; draw it with them")
    return np.asarray(seen)
