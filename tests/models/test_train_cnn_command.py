"""`train cnn`: folders of pictures become a net and its card, the same for the same seed."""

import json
from pathlib import Path

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.models import load_classifier
from lightgesture.sources import read_picture

pytest.importorskip("torch")
QUICK = ("--copies", "4", "--synthetic", "0", "--steps", "120", "--teacher-steps", "15", "--size", "small")


def train(folder: Path, out: Path, *more: str) -> int:
    return main(["train", "cnn", "--data", str(folder), "--out", str(out), *QUICK, *more])


def test_a_short_training_writes_a_net_of_the_classes_of_its_folders(folder: Path, tmp_path: Path) -> None:
    (folder / "5").rename(folder / "disc")
    more = ("--copies", "1", "--steps", "8", "--teachers", "0", "--quiet")
    assert train(folder, tmp_path / "mine.npz", *more) == 0
    assert load_classifier(tmp_path / "mine.npz").classes == ("1", "disc", "none")
    card = json.loads((tmp_path / "mine.json").read_text(encoding="utf-8"))
    assert card["data"]["per_class"] == {"1": 12, "disc": 12, "none": 12}
    assert card["limits"][0].startswith(
        "classes whose pictures come from one source: 1 (hands), disc (hands)"
    )


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--outline", "--teachers", "0")], ids=["taught", "outline"])
def test_folders_become_a_model_and_its_card(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], more: tuple[str, ...]
) -> None:
    assert train(folder, tmp_path / "mine.npz", *more) == 0
    classifier = load_classifier(tmp_path / "mine.npz")
    assert classifier.classes == ("1", "5", "none")
    right = 0
    for token in ("1", "5"):
        for index in range(12):
            picture = read_picture(folder / token / f"{index}.png")
            row = classifier.probabilities(picture, [(0, 0, 60, 60)], ["left"])[0]
            right += classifier.classes[int(row[:2].argmax())] == token
    assert right >= 20
    card = json.loads((tmp_path / "mine.json").read_text(encoding="utf-8"))
    assert card["data"]["per_class"] == {"1": 12, "5": 12, "none": 12}
    assert card["model"]["looks_at_the_outline"] == bool(more)
    assert card["model"]["held_out_accuracy_in_floating_point"] in (0.0, 0.5, 1.0)  # of two hands
    assert len(card["operating_points"]) > 3
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "wrote" in captured.err


@pytest.mark.slow
def test_the_same_seed_writes_the_same_file(folder: Path, tmp_path: Path) -> None:
    for name, seed in (("a", "3"), ("b", "3"), ("c", "4")):
        more = ("--seed", seed, "--quiet", "--teachers", "0")
        assert train(folder, tmp_path / f"{name}.npz", *more) == 0
    arrays = {}
    for name in "abc":
        with np.load(tmp_path / f"{name}.npz") as file:
            arrays[name] = dict(file)
    assert all((arrays["a"][key] == arrays["b"][key]).all() for key in arrays["a"])
    assert any((arrays["a"][key] != arrays["c"][key]).any() for key in arrays["a"] if key.endswith("tflite"))


@pytest.mark.slow
def test_teachers_that_learn_at_a_time_change_nothing(folder: Path, tmp_path: Path) -> None:
    for jobs in ("1", "2"):
        assert train(folder, tmp_path / f"{jobs}.npz", "--quiet", "--teachers", "2", "--jobs", jobs) == 0
    one, two = (dict(np.load(tmp_path / f"{jobs}.npz")) for jobs in ("1", "2"))
    assert all((one[key] == two[key]).all() for key in one)
    answers = np.load(tmp_path / "1.parts" / "answers.npy")
    assert answers.dtype == np.float16
    assert answers.shape[1] == 3


@pytest.mark.slow
def test_answers_about_other_patches_are_refused(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, answers = tmp_path / "mine.npz", tmp_path / "mine.parts" / "answers.npy"
    assert train(folder, out, "--quiet", "--teachers", "1") == 0
    out.unlink()
    np.save(answers, np.load(answers)[1:])
    assert train(folder, out, "--quiet", "--teachers", "1") == 2
    assert f"{answers}: holds answers about other patches" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["--data", "nowhere.csv"], 1, "nowhere.csv: cannot be read"),
        (["--data", "{folder}", "--out", "model.pickle"], 2, "ends in .npz"),
        (["--data", "{folder}", "--steps", "0"], 2, "--steps"),
        (["--data", "{folder}", "--teacher-steps", "0"], 2, "--teacher-steps is 0"),
        ([], 2, "--data"),
    ],
)
def test_wrong_use_is_one_line(
    folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    status: int,
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["train", "cnn", *(text.format(folder=folder) for text in arguments)]) == status
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
