"""The file of a hand net: its integers (`features.net.file`), how patches are cut, and its temperature."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.net.file import network_from
from lightgesture.features.net.network import IntegerNetwork, Shape
from lightgesture.features.outline.contours import ContourSettings, contour_length
from lightgesture.features.patch import PatchSettings
from lightgesture.models.archive import check_kind, positive, settings_from
from lightgesture.models.cnn import CONTOUR, PATCH, SCORES, CnnModel, LargerNet, SecondLook
from lightgesture.models.errors import ModelError

KIND: Final = "cnn"
FORMAT: Final = 3
"""Version of the file; raised whenever an older reader would misread a newer file."""
OLDER: Final = 2
"""Version that holds one larger net at most."""

NET: Final = "net"
SECOND: Final = "second"
"""Beginnings of the names of the members of the first net and of the first of the larger ones."""
MOST_LARGER: Final = 4
"""Larger nets that a model may have."""


def larger_name(number: int) -> str:
    """Beginning of the names of the members of a larger net, which are counted from 0."""
    return SECOND if number == 0 else f"{SECOND}{number + 1}"


def cnn_model_from(path: Path, header: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> CnnModel:
    """The model of a file's content; raises ModelError naming the file."""
    check_kind(path, header, KIND, FORMAT, OLDER)
    try:
        contour = header["contour"]
        model = CnnModel(
            classes=tuple(str(name) for name in header["classes"]),
            patch=settings_from(PatchSettings, header["patch"]),
            network=network_from(arrays, NET),
            temperature=positive(header, "temperature"),
            smallest_hand=int(header["smallest_hand"]),
            contour=None if contour is None else settings_from(ContourSettings, contour),
            contour_mean=np.asarray(arrays["contour_mean"], np.float32),
            contour_deviation=np.asarray(arrays["contour_deviation"], np.float32),
            second=_second_from(header.get("second"), arrays),
        )
        _check(model)
    except (KeyError, TypeError, ValueError) as error:
        raise ModelError(f"{path}: is damaged ({error}); restore it or train it again") from error
    return model


def _second_from(content: dict[str, Any] | None, arrays: dict[str, NDArray[Any]]) -> SecondLook | None:
    if content is None:
        return None
    sure = float(content["sure"])
    if not 0.0 <= sure <= 1.0:
        raise ValueError(f"sure is {sure}, must be 0 to 1")
    # A file of before has one, and what is said of it beside the share.
    told = content.get("nets", [content])
    if not isinstance(told, list) or not 1 <= len(told) <= MOST_LARGER:
        raise ValueError(f"the larger nets must be 1 to {MOST_LARGER}")
    nets = (
        LargerNet(network_from(arrays, larger_name(number)), positive(net, "temperature"))
        for number, net in enumerate(told)
    )
    return SecondLook(tuple(nets), sure)


def _check(model: CnnModel) -> None:
    """Refuse parts that do not go together. Raises ValueError."""
    inputs: dict[str, Shape] = {PATCH: (model.patch.size, model.patch.size, 3)}
    length = 0 if model.contour is None else contour_length(model.contour)
    if length:
        inputs[CONTOUR] = (1, 1, length)
    _check_network(model.network, inputs, model.classes)
    for net in () if model.second is None else model.second.nets:
        _check_network(net.network, {PATCH: inputs[PATCH]}, model.classes)
    for name in ("contour_mean", "contour_deviation"):
        values = getattr(model, name)
        if values.shape != (length,) or not np.isfinite(values).all():
            raise ValueError(f"{name} must be {length} finite numbers")
    if not (model.contour_deviation > 0.0).all():
        raise ValueError("contour_deviation must be above 0")


def _check_network(network: IntegerNetwork, inputs: Mapping[str, Shape], classes: Sequence[str]) -> None:
    if dict(network.inputs) != inputs:
        raise ValueError(f"the net's inputs are {dict(network.inputs)}, must be {dict(inputs)}")
    last = {node.name: node for node in network.nodes}.get(SCORES)
    if network.outputs != (SCORES,) or last is None or last.op != "dense":
        raise ValueError(f"the net's one output must be the dense layer {SCORES}")
    if last.channels != len(classes) or len(set(classes)) != len(classes):
        raise ValueError(f"{last.channels} scores for the classes {', '.join(classes)}")
