"""Trees, the contour bank and the machine as flat arrays, and what they answer to test inputs."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from lightgesture.export.files import FlatFiles
from lightgesture.features.find.bank import Bank
from lightgesture.features.find.trees import Trees, evaluate
from lightgesture.features.standardise import patch_levels
from lightgesture.features.vector import feature_vectors
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import MOST_DOUBTED, PATCH, SECOND_WEIGHT, CnnClassifier, CnnModel, SecondLook
from lightgesture.models.svm import SvmClassifier

Patches = NDArray[np.uint8]

ROWS: Final = 64
"""Test inputs of trees."""


def export_trees(files: FlatFiles, parts: Mapping[str, tuple[Trees, int]]) -> None:
    """Write trees, each with the number of columns of its rows, as trees.json and trees.bin."""
    content = {}
    for name, (trees, columns) in parts.items():
        rows = _test_rows(trees, columns)
        kinds = ("feature", "threshold", "left", "right", "value")
        content[name] = {
            "base": trees.base,
            "depth": trees.depth,
            "columns": columns,
            "arrays": {
                kind: files.add_array("trees", f"{name}/{kind}", getattr(trees, kind)) for kind in kinds
            },
            "vectors": {
                "rows": files.add_array("vectors", f"{name}/rows", rows),
                "leaves": files.add_array("vectors", f"{name}/leaves", leaves(trees, rows)),
                "values": files.add_array("vectors", f"{name}/values", evaluate(trees, rows)),
            },
        }
    files.add_json("trees.json", content)


def export_bank(files: FlatFiles, bank: Bank) -> None:
    """Write the outlines of the classical choice as bank.json and bank.bin."""
    arrays = {
        "centres": files.add_array("bank", "centres", bank.centres),
        "owner": files.add_array("bank", "owner", bank.owner),
    }
    files.add_json("bank.json", {"classes": list(bank.classes), **asdict(bank.settings), "arrays": arrays})


def export_svm(files: FlatFiles, classifier: SvmClassifier, patches: Patches) -> None:
    """Write the machine as svm.json and svm.bin; patches: uint8 (n, size, size, 3), cut as it wants them."""
    model = classifier.model
    vectors = feature_vectors(patches, model.features)
    scores = classifier.scores(vectors)
    steps: dict[str, NDArray[Any]] = {
        "patches": patches,
        "features": vectors,
        "projected": classifier.project(vectors),
        "scores": scores,
        "probabilities": softmax(scores.copy(), model.temperature),
    }
    kinds = ("mean", "projection", "centres", "weights", "bias")
    content = {
        "classes": list(model.classes),
        "features": asdict(model.features),
        "gamma": model.gamma,
        "temperature": model.temperature,
        "smallest_hand": model.smallest_hand,
        "arrays": {kind: files.add_array("svm", kind, getattr(model, kind)) for kind in kinds},
        "vectors": {step: files.add_array("vectors", f"svm/{step}", array) for step, array in steps.items()},
    }
    files.add_json("svm.json", content)


def cnn_constants(files: FlatFiles, model: CnnModel, patches: Patches) -> dict[str, Any]:
    """What surrounds a hand net: how patches are cut and standardised, calibration, and patches with their answers."""
    classifier = CnnClassifier(model, "numpy")
    scores = classifier.scores(patches)
    steps: dict[str, NDArray[Any]] = {
        "patches": patches,
        "levels": patch_levels(patches, model.network.quantisation[PATCH]),
        "scores": scores,
        "probabilities": softmax(scores.copy(), model.temperature),
    }
    content: dict[str, Any] = {
        "classes": list(model.classes),
        "patch": asdict(model.patch),
        "temperature": model.temperature,
        "smallest_hand": model.smallest_hand,
        "contour": None,
        "hands": {
            step: files.add_array("vectors", f"cnn/hands/{step}", array) for step, array in steps.items()
        },
    }
    if model.contour is not None:
        content["contour"] = {
            **asdict(model.contour),
            "mean": files.add_array("cnn", "contour_mean", model.contour_mean),
            "deviation": files.add_array("cnn", "contour_deviation", model.contour_deviation),
        }
    return content


def second_constants(second: SecondLook, number: int) -> dict[str, Any]:
    """When the larger nets are asked, and how the mean of their answers is weighed; of one of them its temperature."""
    return {
        "temperature": second.nets[number].temperature,
        "nets": len(second.nets),
        "sure": second.sure,
        "weight": SECOND_WEIGHT,
        "most_doubted": MOST_DOUBTED,
    }


def leaves(trees: Trees, rows: NDArray[np.float32]) -> NDArray[np.int16]:
    """Number of the node in which each row ends in each tree, (n, trees)."""
    found = [[_leaf(trees, tree, row) for tree in range(len(trees.feature))] for row in rows]
    return np.array(found, np.int16)


def _leaf(trees: Trees, tree: int, row: NDArray[np.float32]) -> int:
    node = 0
    for _ in range(trees.depth):
        goes_right = row[trees.feature[tree, node]] > trees.threshold[tree, node]
        node = int((trees.right if goes_right else trees.left)[tree, node])
    return node


def _test_rows(trees: Trees, columns: int) -> NDArray[np.float32]:
    """float32 (ROWS, columns), about the thresholds that each column meets, some of them exactly there."""
    rng = np.random.default_rng(11)
    rows = np.zeros((ROWS, columns), np.float32)
    inner = trees.left != np.arange(trees.left.shape[1])
    for column in range(columns):
        met = trees.threshold[inner & (trees.feature == column)]
        if len(met):
            rows[:, column] = rng.choice(met, ROWS)
            rows[ROWS // 4 :, column] += rng.normal(0.0, met.std() + 0.1, ROWS - ROWS // 4)
    return rows
