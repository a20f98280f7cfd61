"""Which hands are kept from a model, for its temperature and its scores: whole sources, each nearly always another
person and another room. Where there are too few of them, single hands with all their copies."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.patch import cut_patch
from lightgesture.models.cnn import CnnModel
from lightgesture.training.pool.kept_hands import ONE_IN
from lightgesture.training.pool.originals import Originals
from lightgesture.training.pool.patch_pool import PatchPool

LEAST_FITTED: Final = 30
"""Hands or copies that a temperature is fitted on; of fewer it would say little."""


@dataclass(frozen=True, slots=True, eq=False)
class HeldOut:
    """Answers of a model for samples that it did not see.

    probabilities: float32 (n, classes). truth: int (n,), index of the class. sources: (n,), names. original: bool
    (n,), False for altered copies.
    """

    probabilities: NDArray[np.float32]
    truth: NDArray[np.int64]
    sources: NDArray[np.str_]
    original: NDArray[np.bool_]


def kept_samples(
    truth: NDArray[np.int64], sources: NDArray[np.str_], hands: NDArray[np.int64]
) -> NDArray[np.bool_]:
    """Which samples are kept from the machine, bool (n,): one of `ONE_IN` folds of the sources, less those that alone
    show a class. Where these are all, single hands. Of too few hands none is kept.

    hands: int (n,), numbers of the hands, -1 for samples of no hand.
    """
    for folds in (assign_folds(sources, hands, ONE_IN), _dealt(hands, ONE_IN)):
        kept = folds == ONE_IN - 1
        kept &= np.isin(truth, truth[~kept])
        if kept.any():
            break
    return np.asarray(kept)


def assign_folds(sources: NDArray[np.str_], hands: NDArray[np.int64], folds: int) -> NDArray[np.int64]:
    """Fold of each sample, int (n,): whole sources, the largest first into the emptiest fold.

    With fewer sources of hands than folds, hands are dealt out in turn instead, each with its copies.
    """
    names, members, sizes = np.unique(sources, return_inverse=True, return_counts=True)
    shown = sources[hands >= 0] if (hands >= 0).any() else sources
    if len(np.unique(shown)) < folds:
        return _dealt(hands, folds)
    fold_of_source = np.zeros(len(names), np.int64)
    filled = np.zeros(folds)
    for source in np.argsort(-sizes, kind="stable"):
        fold_of_source[source] = filled.argmin()
        filled[fold_of_source[source]] += sizes[source]
    return np.asarray(fold_of_source[members.reshape(-1)])


def _dealt(hands: NDArray[np.int64], folds: int) -> NDArray[np.int64]:
    """Hands in turn; samples of no hand come into the first fold, or where there are no hands, in turn themselves."""
    if (hands < 0).all():
        return np.arange(len(hands)) % folds
    return np.where(hands < 0, 0, hands % folds)


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
        np.array([*plain, *altered], np.uint8).reshape(-1, model.patch.size, model.patch.size, 3),
        np.array(truth, np.int64),
        np.array([hand.source for hand in hands] * 2, np.str_),
        np.arange(2 * len(hands)) < len(hands),
    )
