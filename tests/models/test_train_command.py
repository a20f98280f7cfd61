import json
from pathlib import Path

import numpy as np
import pytest

from lightgesture.cli import main
from lightgesture.models import load_classifier
from lightgesture.sources import read_picture


def train(folder: Path, out: Path, *more: str) -> int:
    return main(
        [
            "train",
            "svm",
            "--data",
            str(folder),
            "--out",
            str(out),
            "--copies",
            "1",
            "--centres",
            "50",
            "--steps",
            "10",
            *more,
        ]
    )


def test_folders_become_a_model_and_its_card(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert train(folder, tmp_path / "mine.npz") == 0
    classifier = load_classifier(tmp_path / "mine.npz")
    assert classifier.classes == ("1", "5", "none")
    picture = read_picture(folder / "5" / "0.png")
    probabilities = classifier.probabilities(picture, [(0, 0, 60, 60)], ["left"])
    assert classifier.classes[int(probabilities[0].argmax())] == "5"
    card = json.loads((tmp_path / "mine.json").read_text(encoding="utf-8"))
    assert card["data"]["per_class"] == {"1": 12, "5": 12, "none": 12}
    assert card["data"]["licences"] == {"none stated": 36}
    assert card["data"]["what_they_allow"].startswith("Where no licence is stated none is granted")
    assert card["training"]["seed"] == 0
    assert card["held_out_sources"]["per_class"]["1"] > 0.8
    assert card["limits"]
    assert len(card["operating_points"]) > 3
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "wrote" in captured.err


def test_steps_are_told_as_lines(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert train(folder, tmp_path / "mine.npz") == 0
    told = capsys.readouterr().err.splitlines()
    assert "lightgesture: learn the machine: 10 of 10, done" in told
    assert len([line for line in told if "learn the machine" in line]) == 10
    assert train(folder, tmp_path / "quiet.npz", "--quiet") == 0
    assert capsys.readouterr().err == ""


@pytest.mark.slow
def test_the_same_seed_writes_the_same_file(folder: Path, tmp_path: Path) -> None:
    for name, seed in (("a", "3"), ("b", "3"), ("c", "4")):
        assert train(folder, tmp_path / f"{name}.npz", "--seed", seed, "--quiet") == 0
    content = {name: (tmp_path / f"{name}.npz").read_bytes() for name in "abc"}
    assert content["a"] == content["b"]
    assert content["a"] != content["c"]


@pytest.mark.slow
def test_backgrounds_and_scenes_add_regions(folder: Path, tmp_path: Path) -> None:
    scene = folder / "5" / "0.png"
    (tmp_path / "scenes.csv").write_text(
        f'file,set,x,y,w,h,face_boxes\n{scene.relative_to(tmp_path)},room,20,20,20,20,"0,0,9,9;50,50,9,9"\n',
        encoding="utf-8",
    )
    assert train(folder, tmp_path / "alone.npz", "--quiet") == 0
    alone = json.loads((tmp_path / "alone.json").read_text(encoding="utf-8"))
    more = ("--backgrounds", str(folder / "none"), "--scenes", str(tmp_path / "scenes.csv"), "--quiet")
    assert train(folder, tmp_path / "mine.npz", *more) == 0
    card = json.loads((tmp_path / "mine.json").read_text(encoding="utf-8"))
    assert card["data"]["backgrounds"] == {"pictures": 12, "sources": ["background none"]}
    assert card["data"]["scenes"] == {"pictures": 1, "sources": 1}
    # Beside the rows of the same pictures without them.
    assert card["data"]["patches"] > alone["data"]["patches"]


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["--data", "nowhere.csv"], 1, "nowhere.csv: cannot be read"),
        (["--data", "{folder}", "--backgrounds", "nowhere"], 1, "nowhere: no such folder"),
        (["--data", "{folder}", "--scenes", "nowhere.csv"], 1, "nowhere.csv: cannot be read"),
        (["--data", "{folder}", "--out", "model.pickle"], 2, "ends in .npz"),
        (["--data", "{folder}", "--out", "nowhere/model.npz"], 2, "nowhere: no such folder"),
        (["--data", "{folder}", "--seed", "-1"], 2, "--seed"),
        (["--data", "{folder}/5"], 2, "holds no class; a classifier needs pictures of at least two classes"),
        (["--data", "{folder}", "--without", "hands"], 2, "holds no class"),
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
    before = set(tmp_path.rglob("*"))
    assert main(["train", "svm", *(text.format(folder=folder) for text in arguments)]) == status
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
    assert set(tmp_path.rglob("*")) == before


def test_an_unknown_model_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["train", "forest"]) == 2
    assert "forest" in capsys.readouterr().err


def test_a_picture_that_cannot_be_decoded_stops_the_training(folder: Path, tmp_path: Path) -> None:
    (folder / "1" / "broken.png").write_bytes(np.arange(50, dtype=np.uint8).tobytes())
    assert train(folder, tmp_path / "mine.npz") == 1
    assert not (tmp_path / "mine.npz").exists()


@pytest.mark.parametrize("name", ["thumb up", "Größe"])
def test_a_class_that_no_grammar_could_name_is_refused_before_anything_is_drawn(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str
) -> None:
    (folder / "5").rename(folder / name)
    before = set(tmp_path.rglob("*"))
    for model in ("svm", "cnn"):
        if model == "cnn":
            pytest.importorskip("torch")
        out = str(tmp_path / "mine.npz")
        assert main(["train", model, "--data", str(folder), "--out", out]) == 2
        told = capsys.readouterr().err
        assert told.count("\n") == 1
        assert f"'{name}' cannot be a token of a grammar; name the folder" in told
    assert set(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("out", ["selector.bin", "no/such/folder/selector.npz"])
def test_a_selector_that_could_not_be_written_is_refused_before_the_training(out, tmp_path, capsys):
    assert main(["train", "regions", "--data", str(tmp_path), "--out", str(tmp_path / out)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_classical_trees_alone_need_the_file_that_keeps_the_rest(tmp_path, capsys):
    given = ["train", "regions", "--data", str(tmp_path), "--classical"]
    assert main([*given, "--out", str(tmp_path / "selector.npz")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "--start bundled" in line
    missing = ["--start", str(tmp_path / "none.npz")]
    assert main([*given, *missing, "--out", str(tmp_path / "selector.npz")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "--start" in line
    assert "none.npz" in line
    assert list(tmp_path.iterdir()) == []


def test_other_steps_are_told_with_what_to_do(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert train(folder, tmp_path / "mine.npz", "--quiet") == 0
    assert (
        main(["train", "svm", "--data", str(folder), "--out", str(tmp_path / "mine.npz"), "--steps", "20"])
        == 2
    )
    (line,) = capsys.readouterr().err.splitlines()
    assert (
        "holds parts of another training (copies 1 and not 16, centres 50 and not 2000, steps 10 and not 20)"
        in line
    )
    assert f"cp {tmp_path / 'mine.parts'}/patches.*" in line
    # What the line says: patches that lie in the folder of another training are used.
    other = tmp_path / "other.parts"
    other.mkdir()
    for file in (tmp_path / "mine.parts").glob("*.npy"):
        (other / file.name).write_bytes(file.read_bytes())
    (other / "patches.json").write_bytes((tmp_path / "mine.parts" / "patches.json").read_bytes())
    assert train(folder, tmp_path / "other.npz", "--steps", "20") == 0
    assert "draw patches" not in capsys.readouterr().err


def test_a_training_that_went_on_tells_the_seconds_of_all_its_runs(folder: Path, tmp_path: Path) -> None:
    assert train(folder, tmp_path / "mine.npz", "--quiet") == 0
    (tmp_path / "mine.parts" / "seconds.json").write_text("1000.0", encoding="utf-8")
    assert train(folder, tmp_path / "mine.npz", "--quiet") == 0
    card = json.loads((tmp_path / "mine.json").read_text(encoding="utf-8"))
    assert 1000 <= card["training"]["seconds"] < 1100


def test_an_interrupted_training_speaks_of_the_training(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("lightgesture.training.svm.train.train_svm", interrupt)
    assert train(folder, tmp_path / "mine.npz", "--quiet") == 130
    assert capsys.readouterr().err.splitlines() == [
        f"lightgesture: interrupted; {tmp_path / 'mine.parts'} keeps what was drawn and learnt; the same command goes "
        "on there"
    ]
    monkeypatch.setattr("lightgesture.training.svm.train.read_rows", interrupt)
    assert train(folder, tmp_path / "other.npz", "--quiet") == 130
    assert capsys.readouterr().err == "lightgesture: interrupted; nothing was drawn or learnt yet\n"
