"""All pictures that a classifier is trained on, read once."""

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from lightgesture.training.pool.negatives import read_backgrounds, read_scenes
from lightgesture.training.pool.patch_kinds import Originals, PoolSettings
from lightgesture.training.pool.samples import HandRow, load_hand


class NamesPictures(Protocol):
    """What a training says of its pictures beside the hands."""

    @property
    def backgrounds(self) -> tuple[Path, ...]:
        """Folders of pictures without hands."""
        ...

    @property
    def scenes(self) -> Path | None:
        """Table of whole pictures with boxes of hands and faces, or None."""
        ...

    @property
    def pool(self) -> PoolSettings:
        """What is drawn."""
        ...


def read_originals(training: NamesPictures, rows: Sequence[HandRow]) -> Originals:
    """All pictures. Raises InputError."""
    negative = training.pool.negative
    return Originals(
        [load_hand(row) for row in rows],
        [scene for folder in training.backgrounds for scene in read_backgrounds(folder, negative)],
        read_scenes(training.scenes, negative) if training.scenes else (),
    )
