"""A net for each place of real divers, trained without any dive there: what is read where nothing was learnt."""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from lightgesture.benchmarks.divers.pictures import read_divers
from lightgesture.benchmarks.divers.report import JOINED
from lightgesture.benchmarks.divers.rows import FrameRow, HandRow
from lightgesture.benchmarks.divers.scoring import DiverMethod, score_divers
from lightgesture.benchmarks.divers.tables import diver_tables
from lightgesture.benchmarks.scorer import Reading
from lightgesture.benchmarks.studies.data import Study
from lightgesture.benchmarks.studies.rows import net_of
from lightgesture.benchmarks.tables import Table
from lightgesture.errors import InputError
from lightgesture.features.types import Image
from lightgesture.models.cnn import CnnClassifier
from lightgesture.training.model_files import write_cnn_model
from lightgesture.training.nets.cnn import CnnTraining
from lightgesture.training.pool.divers import SOURCE
from lightgesture.training.pool.kept_sources import kept_out
from lightgesture.training.pool.patch_pool import rows_without


class FindsNothing:
    """Stands in the place of a selector where hands are read in given boxes alone."""

    def read(self, _image: Image) -> list[Reading]:
        """Nothing."""
        return []


def places(study: Study, training: CnnTraining, folder: Path, _args: argparse.Namespace) -> list[Table]:
    """A net for each place of real divers, without its dives, read there in given boxes.

    Each net is left in `folder` as PLACE.npz, for `evaluate divers --place PLACE --model`. InputError: the pool has no
    real divers.
    """
    frames = read_divers(study.data)
    signing = sorted({frame.place for frame in frames if any(hand.is_sign for hand in frame.hands)})
    hands: list[HandRow] = []
    rows: list[FrameRow] = []
    without_kept = rows_without(study.pool, study.sources, kept_out(study.hands))
    for place in signing:
        own = [frame for frame in frames if frame.place == place]
        seen = np.isin(study.pool.sources, [f"{SOURCE} {frame.dive}" for frame in own])
        if not seen.any():
            raise InputError(f"{study.folder}: its pool has no divers of {place}; draw it with them")
        model = net_of(study, f"without {place}", without_kept & ~seen, training, folder)
        write_cnn_model(model, folder / f"{place}.npz")
        scored = score_divers([DiverMethod(place, FindsNothing(), CnnClassifier(model))], own)
        hands += [replace(row, method=JOINED) for row in scored.hands]
        rows += [replace(row, method=JOINED) for row in scored.frames]
    return diver_tables(hands, rows)
