"""The larger net of a hand model: the first of those that taught the small one, in integers. Needs torch."""

from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from lightgesture.features.net.network import IntegerNetwork
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import CnnClassifier, CnnModel, SecondLook, weighed
from lightgesture.training.nets.architectures import multiply_adds
from lightgesture.training.nets.hand_net import NetSettings, OutlineScale, to_integers
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.nets.teachers import teacher
from lightgesture.training.pool.kept_sources import LEAST_FITTED, HeldOut, HeldOutHands
from lightgesture.training.temperature import fit_temperature

SURE: Final = 0.9
"""Probability of its likeliest class from which the small net is not doubted."""


def first_teacher(
    samples: HandSamples, scale: OutlineScale, settings: NetSettings, seed: int, folder: Path
) -> IntegerNetwork:
    """The first teacher, which lies trained in `folder`. scale: of the small net's outline, which no teacher sees."""
    return to_integers(teacher(samples, settings, seed, folder), samples, scale, settings, seed)


def with_second_look(
    model: CnnModel, network: IntegerNetwork, hands: HeldOutHands, first: HeldOut
) -> tuple[CnnModel, HeldOut]:
    """The model with the larger net, its temperature fitted on hands that were kept out, and both nets' answers.

    first: answers of the small net, calibrated.
    """
    model = replace(model, second=SecondLook(network, 1.0, SURE))
    scores = CnnClassifier(model).second_scores(hands.patches)
    temperature = fit_temperature(scores, first.truth) if len(first.truth) >= LEAST_FITTED else 1.0
    both = weighed(first.probabilities, softmax(scores, temperature))
    doubted = first.probabilities.max(axis=1, keepdims=True) < SURE
    return (
        replace(model, second=SecondLook(network, temperature, SURE)),
        replace(first, probabilities=np.where(doubted, both, first.probabilities)),
    )


def second_section(model: CnnModel) -> dict[str, Any] | None:
    """What the card tells of the larger net; None without one."""
    second = model.second
    if second is None:
        return None
    weights = second.network.weights.values()
    return {
        "weights": int(sum(own.weights.size + own.biases.size for own in weights)),
        "multiply_adds": multiply_adds(second.network.inputs, second.network.nodes),
        "asked_below": second.sure,
        "temperature": second.temperature,
    }
