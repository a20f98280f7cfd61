"""Which hands are kept from a net: whole sources, each nearly always another person and another room."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lightgesture.datasets import fold_of
from lightgesture.training.samples import LabelledHand

ORDERS = 1 << 20
"""So many places in the order in which sources are kept from the net; names hardly ever share one."""


def kept_out(hands: Sequence[LabelledHand], one_in: int) -> NDArray[np.bool_]:
    """Which hands are kept from the net, bool (n,): whole sources that hold one hand in so many together.

    Sources come in an order that their names give, so that a further one changes little; a source that is too large
    is passed over. Where sources are so few or so large that less than half of that is found, one hand in so many is
    kept, whoever's it is.
    """
    names, members, sizes = np.unique(
        [hand.source for hand in hands], return_inverse=True, return_counts=True
    )
    room = len(hands) / one_in
    kept = np.zeros(len(names), bool)
    for place in sorted(range(len(names)), key=lambda place: fold_of(str(names[place]), ORDERS)):
        kept[place] = sizes[kept].sum() + sizes[place] <= room
    if sizes[kept].sum() < 0.5 * room:
        return np.asarray(np.arange(len(hands)) % one_in == 0)
    return np.asarray(kept[members.reshape(-1)])


def keeps_whole_sources(hands: Sequence[LabelledHand], kept: NDArray[np.bool_]) -> bool:
    """Whether no source has both hands that are kept from the net and others."""
    sources = np.array([hand.source for hand in hands])
    return not np.isin(sources[kept], sources[~kept]).any()
