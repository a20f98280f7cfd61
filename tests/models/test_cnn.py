"""The hand net: the same answers from both run-times; its file comes back whole or is refused."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lightgesture.features.net.file import check_network
from lightgesture.features.net.flatbuffer import with_litert
from lightgesture.features.net.network import (
    WEIGHTED,
    IntegerNetwork,
    Node,
    Quantisation,
    Shape,
    Weights,
    infer_shapes,
    weight_shape,
)
from lightgesture.features.outline.contours import ContourSettings, contour_length
from lightgesture.features.patch import PatchSettings
from lightgesture.models import ModelError, load_classifier
from lightgesture.models.archive import read_model
from lightgesture.models.cnn import CONTOUR, PATCH, SCORES, CnnClassifier, CnnModel
from lightgesture.models.cnn_file import cnn_model_from
from lightgesture.training.model_files import write_cnn_model

SIZE = 16
OUTLINE = ContourSettings(size=16, directions=8)


def random_model(seed: int, has_outline: bool) -> CnnModel:
    """A net with random integers, with or without the outline's numbers."""
    rng = np.random.default_rng(seed)
    length = contour_length(OUTLINE) if has_outline else 0
    inputs: dict[str, Shape] = {PATCH: (SIZE, SIZE, 3)}
    nodes = [
        Node("seen", "conv", (PATCH,), 8, 3, 2, "relu6"),
        Node("whole", "dense", ("seen",), 8, activation="none" if has_outline else "relu6"),
    ]
    if has_outline:
        inputs[CONTOUR] = (1, 1, length)
        nodes += [Node("outline", "dense", (CONTOUR,), 8), Node("both", "add", ("whole", "outline"))]
    nodes.append(Node(SCORES, "dense", (nodes[-1].name,), 3))
    shapes = infer_shapes(inputs, nodes)
    scales, weights = dict.fromkeys(inputs, Quantisation(6 / 255, 0)), {}
    for node in nodes:
        scales[node.name] = (
            Quantisation(6 / 255, -128) if node.activation == "relu6" else Quantisation(0.05, 3)
        )
        if node.op in WEIGHTED:
            size, channels = weight_shape(node, shapes[node.inputs[0]]), shapes[node.name][2]
            levels = rng.integers(-127, 128, size).astype(np.int8)
            spread = 3 / (np.sqrt(levels.size / channels) * 70 * 1.5)
            weights[node.name] = Weights(
                levels,
                rng.integers(-900, 900, channels).astype(np.int32),
                np.full(channels, spread, np.float32),
            )
    network = IntegerNetwork(inputs, tuple(nodes), (SCORES,), weights, scales)
    check_network(network)
    network = with_litert(network)
    mean = rng.normal(0, 1, length).astype(np.float32)
    deviation = rng.uniform(0.5, 2, length).astype(np.float32)
    contour = OUTLINE if has_outline else None
    return CnnModel(("1", "5", "none"), PatchSettings(SIZE, 1.1), network, 0.8, 12, contour, mean, deviation)


@pytest.fixture(params=[False, True], ids=["patch", "outline"])
def model(request: pytest.FixtureRequest) -> CnnModel:
    return random_model(3, request.param)


@pytest.fixture
def path(model: CnnModel, tmp_path: Path) -> Path:
    write_cnn_model(model, tmp_path / "model.npz")
    return tmp_path / "model.npz"


def patches(count: int) -> np.ndarray:
    return np.random.default_rng(5).integers(0, 256, (count, SIZE, SIZE, 3)).astype(np.uint8)


def test_both_run_times_agree(model: CnnModel) -> None:
    pytest.importorskip("ai_edge_litert")
    fast, slow = (CnnClassifier(model, backend).scores(patches(20)) for backend in ("litert", "numpy"))
    assert np.ptp(fast) > 1.0
    # A tie of one layer may fall to the other side, and the next layers carry it on.
    assert np.abs(fast - slow).max() <= 2.1 * model.network.quantisation[SCORES].scale


def test_many_hands_read_as_one_by_one(model: CnnModel) -> None:
    classifier = CnnClassifier(model, "numpy")
    together = classifier.scores(patches(4))
    alone = [classifier.scores(patch[None])[0] for patch in patches(4)]
    np.testing.assert_array_equal(together, np.stack(alone))


def test_a_cast_and_another_exposure_change_nothing_much(model: CnnModel) -> None:
    model = replace(model, contour=None) if model.contour is None else model
    classifier = CnnClassifier(model, "numpy")
    bright = patches(3) // 2 + 100
    # The square root of a value times a factor is that of the value times its root: standardising divides it out.
    tinted = np.clip(bright * np.array([0.9, 0.8, 0.6]), 0, 255).round().astype(np.uint8)
    assert np.abs(classifier.scores(bright) - classifier.scores(tinted)).max() < 0.5


def test_a_written_model_reads_back_the_same(model: CnnModel, path: Path) -> None:
    back = cnn_model_from(path, *read_model(path))
    assert (back.classes, back.patch, back.contour) == (model.classes, model.patch, model.contour)
    assert (back.temperature, back.smallest_hand) == (model.temperature, model.smallest_hand)
    ours, theirs = (CnnClassifier(one, "numpy").scores(patches(5)) for one in (model, back))
    np.testing.assert_array_equal(ours, theirs)
    assert load_classifier(path).classes == model.classes


def test_a_file_of_the_first_format_is_told_to_be_trained_again(
    path: Path, changed: Callable[..., Path]
) -> None:
    with pytest.raises(ModelError, match="has format 1, this version reads 3; train it again"):
        load_classifier(changed(path, lambda header, arrays: header.update(format=1)))


def test_every_cut_is_refused(path: Path) -> None:
    whole = path.read_bytes()
    for length in range(0, len(whole), max(1, len(whole) // 40)):
        path.write_bytes(whole[:length])
        with pytest.raises(ModelError) as refusal:
            load_classifier(path)
        assert str(path) in str(refusal.value)
        assert "\n" not in str(refusal.value)


def change_layout(arrays: dict[str, np.ndarray], **changes: Any) -> None:
    layout = {**json.loads(arrays["net_layout"].tobytes()), **changes}
    arrays["net_layout"] = np.frombuffer(json.dumps(layout).encode(), np.uint8)


def flip_a_bit(_: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    arrays["net_tflite"] = arrays["net_tflite"].copy()
    arrays["net_tflite"][700] ^= 1


def forge(_: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    """Another file with its right digest."""
    content = arrays["net_tflite"].copy()
    content[:64] = 7
    arrays["net_tflite"] = content
    change_layout(arrays, sha256=hashlib.sha256(content.tobytes()).hexdigest())


@pytest.mark.parametrize(
    "change",
    [
        lambda header, arrays: header.update(format=99),
        lambda header, arrays: header.update(kind="forest"),
        lambda header, arrays: header.pop("temperature"),
        lambda header, arrays: header.update(temperature=0.0),
        lambda header, arrays: header.update(classes=["1", "5"]),
        lambda header, arrays: header.update(classes=["1", "5", "5"]),
        lambda header, arrays: header["patch"].update(size=20),
        lambda header, arrays: header["patch"].update(unknown=1),
        lambda header, arrays: header.update(contour={"size": 3}),
        lambda header, arrays: header.update(smallest_hand="many"),
        lambda header, arrays: arrays.pop("net_layout"),
        lambda header, arrays: arrays.pop("net_tflite"),
        lambda header, arrays: change_layout(arrays, outputs=["seen"]),
        lambda header, arrays: change_layout(arrays, places={}),
        lambda header, arrays: arrays.update(contour_mean=np.full(99, 1.0, np.float32)),
        flip_a_bit,
        forge,
    ],
)
def test_a_damaged_file_is_refused_in_one_line(
    path: Path, change: Callable[..., None], changed: Callable[..., Path]
) -> None:
    with pytest.raises(ModelError) as refusal:
        load_classifier(changed(path, change))
    assert str(path) in str(refusal.value)
    assert "\n" not in str(refusal.value)
