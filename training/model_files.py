"""Writes the files that the application reads: models and the selector, each one archive, whole or not at all."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lightgesture.features.archive import HEADER, read_archive
from lightgesture.features.find import selector_file
from lightgesture.features.find.bank import Bank
from lightgesture.features.find.selector_file import ClassicalParts, LearnedParts
from lightgesture.features.find.trees import Trees
from lightgesture.features.net.flatbuffer import network_arrays
from lightgesture.features.net.network import IntegerNetwork
from lightgesture.models import cnn_file, svm_file
from lightgesture.models.cnn import CnnModel
from lightgesture.models.svm_file import SvmModel
from lightgesture.results.atomic import replacing


def write_cnn_model(model: CnnModel, path: Path) -> None:
    """Write the file of a hand net. Raises UsageError where the place cannot be written."""
    second = model.second
    header = {
        "format": cnn_file.FORMAT,
        "kind": cnn_file.KIND,
        "classes": list(model.classes),
        "patch": asdict(model.patch),
        "contour": None if model.contour is None else asdict(model.contour),
        "temperature": model.temperature,
        "smallest_hand": model.smallest_hand,
        "second": None
        if second is None
        else {"sure": second.sure, "nets": [{"temperature": net.temperature} for net in second.nets]},
    }
    arrays = {"contour_mean": model.contour_mean, "contour_deviation": model.contour_deviation}
    arrays |= network_arrays(cnn_file.NET, model.network)
    for number, net in enumerate(() if second is None else second.nets):
        arrays |= network_arrays(cnn_file.larger_name(number), net.network)
    _write(path, header, arrays)


def write_svm_model(model: SvmModel, path: Path) -> None:
    """Write the file of a support vector machine. Raises UsageError where the place cannot be written."""
    header = {
        "format": svm_file.FORMAT,
        "kind": svm_file.KIND,
        "classes": list(model.classes),
        "features": asdict(model.features),
        "gamma": model.gamma,
        "temperature": model.temperature,
        "smallest_hand": model.smallest_hand,
    }
    arrays = {name: getattr(model, name).astype(kind) for name, kind in svm_file.ARRAYS.items()}
    _write(path, header, arrays)


def write_selector(classical: ClassicalParts, learned: LearnedParts, path: Path) -> None:
    """Write the selector's file, which serves either choice. Raises UsageError where the place cannot be written."""
    arrays = {
        **_classical_arrays(classical),
        **_tree_arrays("places", learned.places),
        **_tree_arrays("place_pairs", learned.pairs),
        **network_arrays(selector_file.LOCATOR, learned.locator),
        **network_arrays(selector_file.REFINER, learned.refiner),
    }
    if learned.verifier is not None:
        arrays |= network_arrays(selector_file.VERIFIER, learned.verifier)
    _write(path, {"format": selector_file.FORMAT, "kind": selector_file.KIND}, arrays)


def write_classical(classical: ClassicalParts, origin: Path, path: Path) -> None:
    """Write a selector's file in which the learned choice is that of the file `origin`, byte for byte. Raises
    ArchiveError, UsageError."""
    header, arrays = read_archive(origin, lambda name: name.startswith(selector_file.LEARNED_PARTS))
    _write(path, header, {**_classical_arrays(classical), **arrays})


def _classical_arrays(classical: ClassicalParts) -> dict[str, NDArray[Any]]:
    return {
        **_tree_arrays("glance", classical.glance),
        **_tree_arrays("extents", classical.regions),
        **_tree_arrays("extent_pairs", classical.pairs),
        **bank_arrays("bank", classical.bank),
    }


def write_networks(networks: Mapping[str, IntegerNetwork], path: Path) -> None:
    """Write nets by the beginnings of the names of their arrays, for a training that goes on. Raises UsageError."""
    arrays = {
        name: array
        for part, network in networks.items()
        for name, array in network_arrays(part, network).items()
    }
    _write(path, {}, arrays)


def write_json(content: Mapping[str, Any], path: Path) -> None:
    """Write a model's card. Raises UsageError where the place cannot be written."""
    with replacing(path) as temporary:
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def _tree_arrays(part: str, trees: Trees) -> dict[str, NDArray[Any]]:
    names = (*selector_file.TREE_ARRAYS, *selector_file.TREE_NUMBERS)
    return {f"{part}_{name}": np.asarray(getattr(trees, name)) for name in names}


def bank_arrays(prefix: str, bank: Bank) -> dict[str, NDArray[Any]]:
    """All that a bank holds, under names that begin with `prefix`."""
    return {
        f"{prefix}_classes": np.array(bank.classes, np.str_),
        f"{prefix}_centres": bank.centres.astype(np.float32),
        f"{prefix}_owner": bank.owner.astype(np.int16),
        f"{prefix}_points": np.array(bank.settings.points, np.int32),
        f"{prefix}_harmonics": np.array(bank.settings.harmonics, np.int32),
    }


def _write(path: Path, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
    every: dict[str, Any] = {HEADER: np.frombuffer(json.dumps(header).encode(), np.uint8), **arrays}
    with replacing(path) as temporary, temporary.open("wb") as stream:
        np.savez_compressed(stream, **every)
