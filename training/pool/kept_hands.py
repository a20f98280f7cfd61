"""Which hands are kept from a net, for its temperature and its scores."""

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.training.datasets import fold_of
from lightgesture.training.pool.samples import LabelledHand

ONE_IN: Final = 12
"""Of so many hands, or groups of sources, one is kept."""
ORDERS: Final = 1 << 20
"""So many places in the order in which sources are kept from the net; names hardly ever share one."""


def kept_out(hands: Sequence[LabelledHand], one_in: int = ONE_IN) -> NDArray[np.bool_]:
    """Which hands are kept from the net, bool (n,): whole sources that hold one hand in so many together.

    Sources come in an order that their names give, so that a further one changes little; a source that is too large
    or alone shows what is left of a class is passed over. Where sources are so few or so large that less than half of
    that is found, one hand in so many is kept, whoever's it is, but none that alone shows its class.
    """
    names, members, sizes = np.unique(
        [hand.source for hand in hands], return_inverse=True, return_counts=True
    )
    members = members.reshape(-1)
    tokens = np.array([hand.token for hand in hands])
    room = len(hands) / one_in
    kept = np.zeros(len(names), bool)
    for place in sorted(range(len(names)), key=lambda place: fold_of(str(names[place]), ORDERS)):
        learnt = tokens[~kept[members] & (members != place)]
        fits = sizes[kept].sum() + sizes[place] <= room
        kept[place] = fits and np.isin(tokens[members == place], learnt).all()
    if sizes[kept].sum() < 0.5 * room:
        single = np.arange(len(hands)) % one_in == 0
        return np.asarray(single & np.isin(tokens, tokens[~single]))
    return np.asarray(kept[members])
