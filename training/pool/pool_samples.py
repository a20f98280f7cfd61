"""A pool of patches, and the hands that it was drawn from, as samples of a machine that sees each of them once."""

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import PatchSettings
from lightgesture.features.types import Box
from lightgesture.training.pool.divers import SOURCE
from lightgesture.training.pool.originals import Originals, PoolSettings
from lightgesture.training.pool.patch_kinds import MARGIN, PATCH
from lightgesture.training.pool.patch_pool import PatchPool
from lightgesture.training.samples import TrainingSample

ALTERED_WEIGHT: Final = 0.25
"""Weight of a row that is no plain hand (altered much, hidden, no hand, rendered) beside 1 of a hand as it is or hardly
altered; smaller reads plain pictures better, larger those in bad light and badly boxed ones."""


def pool_samples(
    pool: PatchPool,
    originals: Originals,
    rows: NDArray[np.bool_],
    hands: NDArray[np.bool_],
    settings: PoolSettings,
    seed: int,
) -> Iterator[TrainingSample]:
    """The chosen hands as they are, then the chosen rows of the pool, each shifted within its margin once.

    rows: bool, of the pool. hands: bool (n,), of the originals. Without any originals the rows count as such.
    """
    for place in np.flatnonzero(hands):
        hand = originals.hands[int(place)]
        yield TrainingSample(
            image=hand.image,
            box=hand.box,
            side=hand.side,
            token=hand.token,
            source=hand.source,
            hand=int(place),
        )
    size = PATCH.size
    box = _whole(PATCH)
    corners = np.random.default_rng((seed, 2)).integers(2 * MARGIN + 1, size=(len(rows), 2))
    mild = _mild_rows(pool, len(originals.hands), settings)
    for row in np.flatnonzero(rows):
        top, left = corners[row]
        yield TrainingSample(
            image=np.ascontiguousarray(pool.patches[row, top : top + size, left : left + size]),
            box=box,
            # Right hands were mirrored when the pool was drawn.
            side="left",
            token=str(pool.tokens[row]),
            source=str(pool.sources[row]),
            hand=int(pool.hands[row]),
            original=not originals.hands,
            weight=1.0 if mild[row] else ALTERED_WEIGHT,
        )


def _mild_rows(pool: PatchPool, hands: int, settings: PoolSettings) -> NDArray[np.bool_]:
    """Which rows are mild copies: of all copies, in the pool's order, those after the `copies` of every hand;
    copies of real divers' signs, which are no copies of hands, count as much."""
    copies = np.flatnonzero(pool.hands >= 0)
    mild = np.zeros(len(pool.hands), bool)
    first = hands * settings.copies
    mild[copies[first : first + hands * settings.mild_copies]] = True
    return mild | np.char.startswith(pool.sources, SOURCE)


def _whole(patch: PatchSettings) -> Box:
    """The box whose patch is the whole of a picture of the patch's size."""
    side = round(patch.size / patch.context)
    place = (patch.size - side) // 2
    return place, place, side, side
