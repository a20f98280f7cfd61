import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lightgesture.errors import UsageError
from lightgesture.models import ModelError, load_classifier
from lightgesture.models.svm import SvmClassifier
from lightgesture.models.svm_file import SvmModel
from lightgesture.training.model_files import write_svm_model
from lightgesture.training.samples import TrainingSample
from lightgesture.training.svm.machine import SvmSettings, train_svm


@pytest.fixture
def model(samples: list[TrainingSample], quick: SvmSettings) -> SvmModel:
    return train_svm(samples, quick, classes=("1", "5", "none"))[0]


@pytest.fixture
def path(model: SvmModel, tmp_path: Path) -> Path:
    write_svm_model(model, tmp_path / "model.npz")
    return tmp_path / "model.npz"


def test_a_written_model_reads_back_the_same(model: SvmModel, path: Path) -> None:
    classifier = load_classifier(path)
    assert isinstance(classifier, SvmClassifier)
    back = classifier.model
    assert back.classes == model.classes
    assert back.features == model.features
    assert (back.gamma, back.temperature, back.smallest_hand) == (
        model.gamma,
        model.temperature,
        model.smallest_hand,
    )
    for name in ("mean", "projection", "centres", "weights", "bias"):
        assert np.array_equal(getattr(back, name), getattr(model, name)), name
    assert [entry.name for entry in path.parent.iterdir()] == ["model.npz"]


def test_every_cut_is_refused(path: Path) -> None:
    whole = path.read_bytes()
    for length in range(0, len(whole), max(1, len(whole) // 40)):
        path.write_bytes(whole[:length])
        with pytest.raises(ModelError) as refusal:
            load_classifier(path)
        assert str(path) in str(refusal.value)
        assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x05\x06" + bytes(18)])
def test_other_files_are_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "other.npz").write_bytes(content)
    with pytest.raises(ModelError, match=r"other\.npz"):
        load_classifier(str(tmp_path / "other.npz"))


def test_a_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot be read"):
        load_classifier(tmp_path)


def test_a_pickle_is_never_opened(tmp_path: Path) -> None:
    header = np.frombuffer(json.dumps({"format": 1, "kind": "svm"}).encode(), np.uint8)
    names = ("mean", "projection", "centres", "weights", "bias")
    arrays = {name: np.array([{}], object) for name in names}
    with (tmp_path / "pickle.npz").open("wb") as stream:
        np.savez(stream, header=header, **arrays)  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="pickle"):
        load_classifier(tmp_path / "pickle.npz")


def test_another_version_is_refused(path: Path, changed: Callable[..., Path]) -> None:
    changed(path, lambda header, arrays: header.update(format=99))
    with pytest.raises(ModelError, match="format 99"):
        load_classifier(path)


def test_another_kind_is_refused(path: Path, changed: Callable[..., Path]) -> None:
    changed(path, lambda header, arrays: header.update(kind="forest"))
    with pytest.raises(ModelError, match="no svm model"):
        load_classifier(path)


@pytest.mark.parametrize("name", ["mean", "projection", "centres", "weights", "bias"])
def test_wrong_shapes_and_nan_are_refused(path: Path, name: str, changed: Callable[..., Path]) -> None:
    whole = path.read_bytes()

    def cut(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
        arrays[name] = arrays[name][:-1]

    with pytest.raises(ModelError, match="shape"):
        load_classifier(changed(path, cut))
    path.write_bytes(whole)

    def spoil(header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
        arrays[name] = arrays[name].copy()
        arrays[name].flat[0] = np.nan

    with pytest.raises(ModelError, match="NaN"):
        load_classifier(changed(path, spoil))


@pytest.mark.parametrize(
    "change",
    [
        lambda header, arrays: header.pop("gamma"),
        lambda header, arrays: header.update(gamma=-1.0),
        lambda header, arrays: header.update(temperature=float("inf")),
        lambda header, arrays: header["features"]["hog"].update(unknown=3),
        lambda header, arrays: header["features"]["hog"].pop("cell"),
        lambda header, arrays: header["features"]["hog"].update(cell="six"),
        lambda header, arrays: header["features"]["hog"].update(cell=7),
        lambda header, arrays: header["features"].pop("contour"),
        lambda header, arrays: header.update(features=None),
        lambda header, arrays: header.update(classes=7),
        lambda header, arrays: arrays.pop("bias"),
        lambda header, arrays: arrays.update(bias=np.array(["a", "b", "c"])),
    ],
)
def test_a_damaged_header_is_refused_in_one_line(
    path: Path, change: Callable[..., None], changed: Callable[..., Path]
) -> None:
    with pytest.raises(ModelError) as refusal:
        load_classifier(changed(path, change))
    assert str(path) in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_a_model_that_cannot_be_written_leaves_nothing(model: SvmModel, tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file, no folder")
    with pytest.raises(UsageError, match="cannot be written"):
        write_svm_model(model, tmp_path / "taken" / "model.npz")
    assert [entry.name for entry in tmp_path.iterdir()] == ["taken"]
