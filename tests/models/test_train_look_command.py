"""`lightgesture train look`: a second look of its own labels, or taught by those of other models."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from lightgesture.cli import main
from lightgesture.models import load_classifier
from lightgesture.models.calibration import softmax
from lightgesture.models.cnn import CnnClassifier

pytest.importorskip("torch")
from lightgesture.training.nets.hand_samples import HandSamples
from lightgesture.training.nets.teachers import ANSWERS, taught_by
from lightgesture.training.pool.patch_kinds import MARGIN
from lightgesture.training.pool.patch_pool import PatchPool

QUICK = ("--copies", "1", "--synthetic", "0", "--quiet")


def train(folder: Path, kind: str, out: Path, *more: str) -> int:
    return main(["train", kind, "--data", str(folder), "--out", str(out), *QUICK, *more])


def weights(path: Path) -> NDArray[np.float64]:
    """Of a model's larger net, all in one row."""
    model = load_classifier(str(path))
    assert isinstance(model, CnnClassifier)
    assert model.model.second is not None
    layers = model.model.second.network.weights.values()
    return np.concatenate([layer.weights.ravel() for layer in layers]).astype(np.float64)


@pytest.mark.slow
def test_a_look_is_taught_by_others_and_goes_on_from_the_first(folder: Path, tmp_path: Path) -> None:
    net = ("--teachers", "1", "--teacher-steps", "2", "--steps", "1", "--size", "small")
    assert train(folder, "cnn", tmp_path / "one.npz", *net) == 0
    first = ("--first", str(tmp_path / "one.npz"))
    assert train(folder, "look", tmp_path / "two.npz", *first, "--steps", "2", "--seed", "1") == 0
    teachers = [word for name in ("one", "two") for word in ("--teacher", str(tmp_path / f"{name}.npz"))]
    assert train(folder, "look", tmp_path / "both.npz", *first, *teachers, "--steps", "1") == 0
    one, two, both = (weights(tmp_path / f"{name}.npz") for name in ("one", "two", "both"))
    assert np.abs(both - one).mean() < 0.25 * np.abs(both - two).mean()
    card = json.loads((tmp_path / "both.json").read_text(encoding="utf-8"))
    assert len(card["training"]["taught_by_models_of_sha256"]) == 2


def test_the_mean_of_what_looks_say_is_kept(tmp_path: Path) -> None:
    model = load_classifier("cnn")
    assert isinstance(model, CnnClassifier)
    assert model.model.second is not None
    side = model.model.patch.size + 2 * MARGIN
    patches = np.random.default_rng(0).integers(0, 255, (3, side, side, 3)).astype(np.uint8)
    names = np.array(["5", "none", "ok"])
    pool = PatchPool(patches, np.zeros((3, 0), np.float16), names, names, np.arange(3))
    samples = HandSamples(pool, np.array([True, False, True]), model.classes, MARGIN)
    drawn = taught_by([model, model], samples, tmp_path).draw(np.random.default_rng(1), 8)
    inner = slice(MARGIN, side - MARGIN)
    expected = softmax(model.second_scores(patches[[0, 2], inner, inner]), model.model.second.temperature)
    told = np.load(tmp_path / ANSWERS)
    np.testing.assert_allclose(np.exp(told.astype(np.float32)), np.maximum(expected, 1e-4), rtol=0.01)
    assert drawn.answers is not None
    assert {tuple(row) for row in drawn.answers} <= {tuple(row) for row in told.astype(np.float32)}


def test_a_teacher_without_a_second_look_is_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    net = ("--teachers", "0", "--steps", "1", "--size", "small")
    assert train(folder, "cnn", tmp_path / "small.npz", *net) == 0
    given = ("--first", str(tmp_path / "small.npz"), "--teacher", str(tmp_path / "small.npz"))
    assert train(folder, "look", tmp_path / "new.npz", *given) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "small.npz: has no second look of the classes 1, 5, none" in line
    assert not (tmp_path / "new.parts").exists()
