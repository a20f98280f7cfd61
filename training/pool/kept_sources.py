"""Which hands are kept from a net: whole sources, each nearly always another person and another room."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import cut_patch
from lightgesture.models.cnn import CnnModel
from lightgesture.training.datasets import fold_of
from lightgesture.training.pool.patch_kinds import Originals
from lightgesture.training.pool.patch_pool import PatchPool
from lightgesture.training.pool.samples import LabelledHand
from lightgesture.training.svm.machine import HeldOut

ORDERS = 1 << 20
"""So many places in the order in which sources are kept from the net; names hardly ever share one."""


def kept_out(hands: Sequence[LabelledHand], one_in: int) -> NDArray[np.bool_]:
    """Which hands are kept from the net, bool (n,): whole sources that hold one hand in so many together.

    Sources come in an order that their names give, so that a further one changes little; a source that is too large
    or alone shows what is left of a class is passed over. Where sources are so few or so large that less than half of
    that is found, one hand in so many is kept, whoever's it is.
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
        return np.asarray(np.arange(len(hands)) % one_in == 0)
    return np.asarray(kept[members])


def keeps_whole_sources(hands: Sequence[LabelledHand], kept: NDArray[np.bool_]) -> bool:
    """Whether no source has both hands that are kept from the net and others."""
    sources = np.array([hand.source for hand in hands])
    return not np.isin(sources[kept], sources[~kept]).any()


@dataclass(frozen=True, slots=True, eq=False)
class HeldOutHands:
    """Hands that were kept from the net, and an altered copy of each.

    patches: uint8 (n, size, size, 3). truth: int64 (n,), index of the class. sources: (n,), names. original: bool (n,).
    """

    patches: NDArray[np.uint8]
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    original: NDArray[np.bool_]

    def answered(self, scores: NDArray[np.float32]) -> HeldOut:
        """The same with scores in the place of probabilities."""
        return HeldOut(scores, self.truth, self.sources, self.original)


def held_out_hands(
    model: CnnModel, originals: Originals, pool: PatchPool, kept: NDArray[np.bool_]
) -> HeldOutHands:
    """The hands that were kept out, as the model sees them."""
    hands = [originals.hands[int(index)] for index in np.flatnonzero(kept)]
    plain = [cut_patch(hand.image, hand.box, hand.side, model.patch) for hand in hands]
    first_copies = {int(hand): row for row, hand in reversed(list(enumerate(pool.hands))) if hand >= 0}
    rows = [first_copies[int(index)] for index in np.flatnonzero(kept)]
    margin = (pool.patches.shape[1] - model.patch.size) // 2
    inner = slice(margin, margin + model.patch.size)
    altered = [np.ascontiguousarray(pool.patches[row, inner, inner]) for row in rows]
    number = {name: index for index, name in enumerate(model.classes)}
    truth = [number[hand.token] for hand in hands] + [number[str(pool.tokens[row])] for row in rows]
    return HeldOutHands(
        np.stack([*plain, *altered]),
        np.array(truth, np.int64),
        np.array([hand.source for hand in hands] * 2),
        np.arange(2 * len(hands)) < len(hands),
    )
