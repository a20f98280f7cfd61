"""The larger nets of a hand model: the first of those that taught the small one, in integers. Needs torch."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from lightgesture.errors import UsageError
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import PATCH, CnnClassifier, CnnModel, LargerNet, SecondLook, weighed
from lightgesture.training.nets.architectures import multiply_adds
from lightgesture.training.nets.hand_net import NetSettings, OutlineScale, to_integers
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.nets.teachers import teacher
from lightgesture.training.pool.kept_sources import LEAST_FITTED, HeldOut, HeldOutHands
from lightgesture.training.temperature import fit_temperature

Progress = Callable[[str], None]

SURE: Final = 0.97
"""Probability of its likeliest class from which the small net is not doubted."""


NO_OUTLINE: Final = OutlineScale(np.zeros(0, np.float32), np.zeros(0, np.float32))
"""Larger nets look at patches alone."""


def first_teacher(
    samples: HandSamples, settings: NetSettings, seed: int, folder: Path, progress: Progress
) -> IntegerNetwork:
    """The first teacher; goes on where it was left in `folder`."""
    return to_integers(
        teacher(samples, settings, seed, folder, progress), samples, NO_OUTLINE, settings, seed
    )


def with_second_look(
    model: CnnModel, network: IntegerNetwork, hands: HeldOutHands, beside: Sequence[LargerNet] = ()
) -> CnnModel:
    """The model with the larger net, its temperature fitted on hands that were kept out.

    beside: larger nets that are asked with it. Raises UsageError where the two do not read the same patches.
    """
    if dict(network.inputs) != {PATCH: (model.patch.size, model.patch.size, 3)}:
        raise UsageError("the larger net reads other patches than the small one; train both together")
    larger, truth = LargerNet(network, 1.0), hands.truth
    if len(truth) >= LEAST_FITTED:
        alone = CnnClassifier(replace(model, second=SecondLook((larger,), SURE)))
        (scores,) = alone.second_scores(hands.patches)
        temperature = fit_temperature(scores, truth)
        larger = replace(larger, temperature=temperature)
    return replace(model, second=SecondLook((*beside, larger), SURE))


def answers_of_both(model: CnnModel, hands: HeldOutHands) -> HeldOut:
    """Calibrated answers of the small net, and of both where it is in doubt."""
    classifier = CnnClassifier(model)
    first = softmax(classifier.scores(hands.patches), model.temperature)
    if model.second is None:
        return hands.answered(first)
    both = weighed(first, classifier.second_probabilities(hands.patches))
    return hands.answered(np.where(first.max(axis=1, keepdims=True) < model.second.sure, both, first))


def second_section(model: CnnModel) -> dict[str, Any] | None:
    """What the card tells of the larger nets; None without one."""
    second = model.second
    if second is None:
        return None
    return {"asked_below": second.sure, "nets": [_net_section(net) for net in second.nets]}


def _net_section(net: LargerNet) -> dict[str, Any]:
    weights = net.network.weights.values()
    return {
        "weights": int(sum(own.weights.size + own.biases.size for own in weights)),
        "multiply_adds": multiply_adds(net.network.inputs, net.network.nodes),
        "temperature": net.temperature,
    }
