"""The finder on unseen dives: no fold learns from its own dives, and every picture is found in once."""

import csv
import json

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.divers.rows import FRAMES_FILE
from lightgesture.benchmarks.studies import dives
from lightgesture.features.find.selector_file import load_learned
from lightgesture.models.loading import SHIPPED
from lightgesture.training.nets.checkpoints import sha256_of
from lightgesture.training.pictures.boxed import BoxedPicture
from lightgesture.training.pictures.real_divers import RealDiver
from lightgesture.training.regions import nets
from lightgesture.training.regions.learned import Pictures
from lightgesture.training.regions.region_pictures import Material

DIVES = [f"reef_{number}" for number in range(12)]


def of_dive(dive):
    image = np.zeros((24, 32, 3), np.uint8)
    return RealDiver(BoxedPicture(image, (), sources=frozenset({f"divers {dive}"})), False)


@pytest.fixture(name="pictures")
def _pictures():
    return Pictures(Material([], [], [], [of_dive(dive) for dive in DIVES]), Material([], [], [], []), [], [])


@pytest.fixture(name="data")
def _data(tmp_path):
    folder = tmp_path / "data" / "divers"
    rows = []
    for dive in DIVES:
        rows.append({"file": f"frames/reef/{dive}.png", "sequence": dive, "kind": ""})
        path = folder / rows[-1]["file"]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(cv2.imencode(".png", np.full((120, 160, 3), 90, np.uint8))[1].tobytes())
    with (folder / "boxes.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return tmp_path / "data"


def test_each_fold_learns_from_all_dives_but_its_own(monkeypatch, tmp_path, data, pictures):
    pytest.importorskip("torch")
    learnt = []

    def learn(given, folder, seed, settings, progress):
        del folder, seed, progress
        sources = (source for one in given.for_nets.divers for source in one.picture.sources)
        learnt.append({source.removeprefix("divers ") for source in sources})
        assert (settings.locator_steps, settings.refiner_steps) == (10, 8)
        return load_learned()

    monkeypatch.setattr(dives, "learn_choice", learn)
    monkeypatch.setattr(dives, "read_pictures", lambda *_: pictures)
    parts, out = tmp_path / "parts", tmp_path / "out.json"
    arguments = ["--data", str(data), "--parts", str(parts), "--steps", "10", "--reader", "cnn"]
    arguments += ["--out", str(out)]
    assert dives.main(arguments) == 0
    assert len(learnt) == dives.FOLDS
    for fold, own in enumerate(learnt):
        assert own == {dive for dive in DIVES if dives.fold_of_dive(dive) != fold}
        assert (parts / f"fold{fold}.npz").is_file()
    with (parts / FRAMES_FILE).open(encoding="utf-8") as stream:
        assert sorted(row["dive"] for row in csv.DictReader(stream)) == sorted(DIVES)
    assert json.loads(out.read_text())["settings"] == {
        "steps": 10,
        "start": None,
        "reader": sha256_of(SHIPPED["cnn"]),
        "seed": 0,
    }
    assert dives.main(arguments) == 0
    assert len(learnt) == dives.FOLDS, "what is done is not done again"


def test_a_folder_of_another_training_is_refused(monkeypatch, tmp_path, data, pictures, capsys):
    pytest.importorskip("torch")
    monkeypatch.setattr(dives, "learn_choice", lambda *_: load_learned())
    monkeypatch.setattr(dives, "read_pictures", lambda *_: pictures)
    arguments = ["--data", str(data), "--parts", str(tmp_path / "parts"), "--fold", "1"]
    arguments += ["--reader", "cnn"]
    assert dives.main([*arguments, "--steps", "10"]) == 0
    assert dives.main([*arguments, "--steps", "20"]) == 2
    assert "holds parts of another training (locator_steps 10 and not 20" in capsys.readouterr().err
    other = tmp_path / "other.npz"
    other.write_bytes(SHIPPED["cnn"].read_bytes() + b" ")
    monkeypatch.setattr(nets, "larger_net", lambda _: None)
    assert dives.main([*arguments, "--steps", "10", "--reader", str(other)]) == 2
    assert "holds parts of another training" in capsys.readouterr().err


def test_each_fold_is_read_by_a_net_that_has_not_seen_its_dives(monkeypatch, tmp_path, data, pictures):
    pytest.importorskip("torch")
    without = []

    def second_look(study, first, frames, training, folder):
        del study, folder
        assert training.steps == 7
        without.append({frame.dive for frame in frames})
        return first

    monkeypatch.setattr(dives, "learn_choice", lambda *_: load_learned())
    monkeypatch.setattr(dives, "read_pictures", lambda *_: pictures)
    monkeypatch.setattr(dives, "open_study", lambda *_: None)
    monkeypatch.setattr(dives, "second_look_without", second_look)
    parts = tmp_path / "parts"
    arguments = ["--data", str(data), "--parts", str(parts), "--steps", "10", "--reader", "cnn"]
    arguments += ["--pool", str(tmp_path / "pool"), "--look-steps", "7"]
    assert dives.main(arguments) == 0
    assert without == [{dive for dive in DIVES if dives.fold_of_dive(dive) == fold} for fold in range(5)]


def test_a_pool_needs_a_net_to_stand_beside(monkeypatch, tmp_path, data, capsys):
    pytest.importorskip("torch")
    monkeypatch.setattr(dives, "read_pictures", lambda *_: pytest.fail("pictures were composed"))
    arguments = ["--data", str(data), "--parts", str(tmp_path), "--reader", "cnn", "--model", "svm"]
    assert dives.main([*arguments, "--pool", str(tmp_path)]) == 2
    assert "svm: is no net; --pool trains a larger net" in capsys.readouterr().err


@pytest.mark.parametrize("fold", ["5", "-1", "one"])
def test_a_fold_that_there_is_not_is_refused(fold, tmp_path, capsys):
    with pytest.raises(SystemExit):
        dives.main(["--parts", str(tmp_path), f"--fold={fold}"])
    assert f"{fold} is not from 0 to 4" in capsys.readouterr().err
