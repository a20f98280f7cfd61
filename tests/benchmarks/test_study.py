"""Studies of reading: who is held out of which training, and the commands from pool to table."""

import csv
import json
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks.studies import baselines as reading_baselines
from lightgesture.benchmarks.studies import kinds as study_kinds
from lightgesture.benchmarks.studies import reading as reading_study
from lightgesture.benchmarks.studies import rows as study_rows
from lightgesture.benchmarks.studies.data import (
    held_out_subjects,
    open_study,
    rows_of_sources,
    training_of,
)
from lightgesture.benchmarks.studies.kinds import EVERYTHING, NOTHING, POOLS
from lightgesture.benchmarks.studies.rows import mean_and_worst
from lightgesture.errors import InputError, UsageError
from lightgesture.models import load_classifier
from lightgesture.training.datasets import fold_of
from lightgesture.training.nets import checkpoints
from lightgesture.training.pool.originals import PoolSettings
from lightgesture.training.pool.patch_pool import PatchPool

TOKENS = ("1", "5", "none")


def draw(token, seed):
    """uint8 (60, 60, 3): "1" an upright bar, "5" a disc, "none" a lying bar."""
    random = np.random.default_rng(seed)
    picture = random.normal(90, 8, (60, 60, 3))
    rows, columns = np.mgrid[:60, :60]
    inside = {
        "1": (abs(columns - 30) < 7) & (abs(rows - 30) < 24),
        "5": (columns - 30) ** 2 + (rows - 30) ** 2 < 20**2,
        "none": (abs(rows - 30) < 7) & (abs(columns - 30) < 24),
    }[token]
    picture[inside] += (30, 50, 90)
    return np.clip(picture, 0, 255).astype(np.uint8)


@pytest.fixture
def drawn(tmp_path):
    """A folder of drawings: six sources of two subjects each and the one that is left out; two sources of val."""
    folder = tmp_path / "data"
    for split, names in (
        ("train", [*(f"s{number}" for number in range(6)), "emre_drone"]),
        ("val", ["v0", "v1"]),
    ):
        rows = []
        for number, source in enumerate(names):
            for index in range(6):
                token = TOKENS[index % 3]
                path = f"{split}/{source}_{index}.png"
                (folder / "hands" / split).mkdir(parents=True, exist_ok=True)
                assert cv2.imwrite(str(folder / "hands" / path), draw(token, 100 * number + index))
                box = {"hx0": 8, "hy0": 8, "hx1": 52, "hy1": 52}
                subject = f"p{index // 3}"
                rows.append(
                    {"path": path, "set": source, "token": token, "subject": subject, **box, "note": ""}
                )
        with (folder / "hands" / f"{split}.csv").open("w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)
    return folder


@pytest.fixture
def training(drawn):
    return training_of(drawn, pool=PoolSettings(copies=1, rounds=1, rendered=0))


def small_pool():
    """Two hands of a, one of b; regions of a and of water."""
    sources = np.array(["a", "a", "b", "a", "water"])
    return PatchPool(
        np.zeros((5, 4, 4, 3), np.uint8),
        np.zeros((5, 2), np.float16),
        np.array(["1", "5", "1", "none", "none"]),
        sources,
        np.array([0, 1, 2, -1, -1]),
    )


def test_few_sources_keep_what_shows_no_people():
    sources = np.array(["a", "a", "b"])
    assert rows_of_sources(small_pool(), sources, ["b"]).tolist() == [False, False, True, False, True]
    assert rows_of_sources(small_pool(), sources, ["a", "b"]).all()


def test_subjects_are_held_out_where_a_source_tells_them_apart():
    sources = ["a"] * 12 + ["b"] * 3 + ["c"] * 2
    subjects = [f"p{number % 6}" for number in range(12)] + ["", "", ""] + ["only", "only"]
    held = held_out_subjects(sources, subjects, 5)
    assert {subject for subject, is_held in zip(subjects, held, strict=True) if is_held} == {"p0", "p5"}
    assert held.sum() == 4
    assert held_out_subjects(["a", "a"], ["x", "y"], 5).tolist() == [True, False]


def test_the_study_holds_the_manifest_without_the_left_out_people(drawn, training, tmp_path):
    study = open_study(drawn, tmp_path / "pool", training, lambda _: None)
    assert len(study.rows) == len(study.hands) == len(study.subjects) == 36
    assert study.classes == TOKENS
    assert "emre_drone" not in study.sources
    assert set(study.subjects) == {"p0", "p1"}
    again = open_study(drawn, tmp_path / "pool", training, lambda _: None)
    np.testing.assert_array_equal(study.pool.patches, again.pool.patches)


def test_a_pool_of_other_hands_is_refused(drawn, training, tmp_path):
    open_study(drawn, tmp_path / "pool", training, lambda _: None)
    with pytest.raises(InputError, match="holds a pool of other hands"):
        open_study(drawn, tmp_path / "pool", replace(training, without=("s0",)), lambda _: None)
    (tmp_path / "pool" / "patches.json").write_text('{"tokens": []}', encoding="utf-8")
    with pytest.raises(InputError, match="holds no pool that can be read"):
        open_study(drawn, tmp_path / "pool", training, lambda _: None)


def test_pools_differ_in_what_their_name_says():
    pool = PoolSettings()
    assert POOLS[EVERYTHING](pool) == pool
    made = {name: make(pool) for name, make in POOLS.items()}
    assert len({repr(one) for one in made.values()}) == len(POOLS)
    assert made["no water"].augment.light == replace(pool.augment.light, water=0.0)
    assert replace(made["no water"].augment, light=pool.augment.light) == pool.augment
    assert made["no rendered hands"] == replace(pool, rendered=0)
    assert pool.posed == 0
    assert made["posed hands"] == replace(pool, posed=20000)
    assert made["no mild copies"] == replace(pool, mild_share=0.0)
    nothing = made[NOTHING]
    assert (nothing.rendered, nothing.mild_copies) == (0, 0)
    assert (nothing.augment.rotation, nothing.augment.light.blur) == (0.0, 0.0)
    assert nothing.copies == pool.copies


def test_mean_and_worst_of_folds():
    rows = [{"held_hands": 32, "held_accuracy": 0.5}] * 5
    mean, worst = mean_and_worst("svm", [*rows, {"held_hands": 10, "held_accuracy": 0.2}])
    assert (mean["row"], mean["held_hands"], worst["held_accuracy"]) == ("svm mean", 170, 0.2)
    assert mean["held_accuracy"] == pytest.approx((5 * 0.5 + 0.2) / 6)
    assert mean_and_worst("svm", []) == []


class Recorder:
    """Stands in for the training of a row: keeps who is trained on and who is held out."""

    def __init__(self):
        self.rows = []

    def __call__(self, study, name, rows, held, training, folder):
        assert held.any()
        assert not set(study.pool.hands[rows].tolist()) & set(np.flatnonzero(held).tolist())
        trained = set(study.pool.sources[rows])
        self.rows.append((name, trained, set(study.sources[held]), training))
        return {"row": name, "sources": len(trained), "held_hands": int(held.sum()), "held_accuracy": 0.5}


@pytest.fixture
def study_command(monkeypatch, drawn, tmp_path):
    """Runs a study with a recorder in place of its trainings; returns that and the JSON rows."""
    monkeypatch.setattr(checkpoints, "need_torch", lambda: None)
    recorder = Recorder()
    monkeypatch.setattr(study_kinds, "fit_row", recorder)
    out = tmp_path / "rows.json"

    def run(kind, *more):
        pool = ("--pool", str(tmp_path / "pool"), "--copies", "1", "--rendered", "0")
        assert reading_study.main([kind, "--data", str(drawn), *pool, "--out", str(out), *more]) == 0
        return recorder.rows, json.loads(out.read_text(encoding="utf-8"))["rows"]

    return run


def test_each_source_is_held_out_in_one_fold(study_command):
    trained, rows = study_command("folds")
    assert len(trained) == len({fold_of(f"s{n}", 5) for n in range(6)}) < 5
    assert sorted(source for _, _, held, _ in trained for source in held) == [f"s{n}" for n in range(6)]
    for _, seen, held, _ in trained:
        assert not seen & held
    assert [row["row"] for row in rows][-2:] == ["cnn mean", "cnn worst fold"]


def test_the_svm_alone_answers_for_hands_that_it_never_saw(study_command):
    trained, rows = study_command("subjects", "--svm-alone", "--svm-steps", "60", "--svm-centres", "40")
    assert not trained
    (row,) = rows
    assert (row["row"], row["held_hands"], row["sources"]) == ("svm", 12, 6)
    assert row["val_accuracy"] == 1.0


def test_the_svm_alone_needs_no_torch_and_its_settings_are_told(study_command, monkeypatch, tmp_path):
    def refuse():
        raise UsageError("no torch here")

    monkeypatch.setattr(checkpoints, "need_torch", refuse)
    study_command("subjects", "--svm-alone", "--svm-steps", "5", "--svm-centres", "20")
    told = json.loads((tmp_path / "rows.json").read_text(encoding="utf-8"))["settings"]
    assert told["svm"] == {"centres": 20, "steps": 5}


def test_the_svm_has_folds_of_its_own(study_command):
    trained, rows = study_command(
        "folds", "--svm", "--svm-steps", "5", "--svm-centres", "20", "--fold", "0", "--fold", "1"
    )
    assert [row["row"] for row in rows if row["row"].startswith("svm fold")] == [
        name.replace("cnn", "svm") for name, *_ in trained
    ]
    assert [row["row"] for row in rows][-2:] == ["svm mean", "svm worst fold"]


def test_subjects_of_every_source_are_held_out(study_command):
    ((_, seen, held, _),), rows = study_command("subjects")
    assert seen >= held == {f"s{n}" for n in range(6)}
    assert rows[0]["held_hands"] == 18


def test_sources_grow_and_stay(study_command):
    trained, _ = study_command("sources", "--counts", "1", "2")
    names = [name for name, *_ in trained]
    assert names[:2] == ["1 sources", "2 sources"]
    first, second, every = (seen for _, seen, _, _ in trained)
    assert len(first) == 1
    assert first < second < every


@pytest.mark.parametrize(
    ("kind", "names"),
    [("sizes", ["small", "medium", "large"]), ("outline", ["patch alone", "patch and outline"])],
)
def test_nets_differ_in_one_thing(study_command, kind, names):
    trained, rows = study_command(kind)
    assert [row["row"] for row in rows] == names
    assert len({(training.size, training.contours) for *_, training in trained}) == len(names)
    assert len({(tuple(sorted(seen)), tuple(sorted(held))) for _, seen, held, _ in trained}) == 1


def test_the_learning_curve_has_a_training_of_its_own_for_each_length(study_command):
    trained, rows = study_command("steps", "--counts", "2", "5")
    assert [row["row"] for row in rows] == ["2 steps", "5 steps"]
    assert [training.steps for *_, training in trained] == [2, 5]


def test_each_alteration_has_a_pool_of_its_own(study_command, tmp_path):
    trained, _ = study_command("augmentation", "--only", "everything", "--only", "no mirror", "--rounds", "2")
    assert [training.pool.augment.mirror for *_, training in trained] == [0.5, 0.0]
    assert [training.pool.rounds for *_, training in trained] == [2, 2]
    drawn_pools = sorted(path.parent.parent.name for path in tmp_path.rglob("studies/**/patches.json"))
    assert drawn_pools == ["everything", "no_mirror"]


def test_the_same_training_of_two_studies_has_one_folder(drawn, training, tmp_path, monkeypatch):
    class TrainedError(Exception):
        pass

    def told(_pool, _rows, _classes, _training, folder, _progress):
        raise TrainedError(folder)

    monkeypatch.setattr(study_rows, "learn", told)
    study = open_study(drawn, tmp_path / "pool", training, lambda _: None)
    every = np.ones(len(study.pool.hands), bool)
    first, last = every.copy(), every.copy()
    first[0], last[-1] = False, False
    places = []
    for name, rows, own in (
        ("sizes", every, training),
        ("sources", every, replace(training, jobs=2)),
        ("fold 0", first, training),
        ("fold 1", last, training),
        ("other seed", every, replace(training, seed=1)),
    ):
        with pytest.raises(TrainedError) as place:
            study_rows.fit_row(study, name, rows, np.zeros(len(study.hands), bool), own, tmp_path)
        places.append(place.value.args[0])
    assert places[0] == places[1]
    assert len(set(places)) == 4


@pytest.mark.slow
def test_a_net_is_trained_and_scored(drawn, tmp_path, capsys):
    pytest.importorskip("torch")
    arguments = ["--data", str(drawn), "--pool", str(tmp_path / "pool"), "--copies", "2", "--rendered", "0"]
    more = ["--steps", "30", "--size", "small", "--out", str(tmp_path / "rows.json")]
    for _ in range(2):
        assert reading_study.main(["subjects", *arguments, *more, "--svm", "--svm-steps", "200"]) == 0
    cnn, svm = json.loads((tmp_path / "rows.json").read_text(encoding="utf-8"))["rows"]
    assert (cnn["held_hands"], cnn["val_hands"], cnn["sources"]) == (12, 8, 6)
    assert cnn["val_accuracy"] > 0.7
    assert svm["val_accuracy"] == 1.0
    assert capsys.readouterr().err.count("step 30 of 30") == 1


def test_contours_become_a_model_file(drawn, tmp_path, capsys):
    out = tmp_path / "contours.npz"
    pool = ("--pool", str(tmp_path / "pool"), "--copies", "2", "--rendered", "0", "--steps", "60")
    arguments = ["--data", str(drawn), "--out", str(out), "--centres", "40"]
    assert reading_baselines.main(["contours", *arguments, *pool, "--json", str(tmp_path / "rows.json")]) == 0
    classifier = load_classifier(out)
    assert classifier.classes == TOKENS
    rows = json.loads((tmp_path / "rows.json").read_text(encoding="utf-8"))["rows"]
    assert rows[0]["model"] == "contours"
    assert rows[0]["hands"] == 8
    assert rows[0]["accuracy"] == 1.0
    assert "wrote" in capsys.readouterr().err


@pytest.mark.slow
def test_the_papers_network_is_trained_and_scored(drawn, tmp_path):
    pytest.importorskip("torch")
    pool = ("--pool", str(tmp_path / "pool"), "--copies", "4", "--rendered", "0", "--steps", "40")
    rows = tmp_path / "rows.json"
    assert reading_baselines.main(["paper", "--data", str(drawn), *pool, "--json", str(rows)]) == 0
    first = json.loads(rows.read_text(encoding="utf-8"))["rows"][0]
    assert (first["model"], first["hands"]) == ("paper's network", 8)
    assert first["accuracy"] > 0.7


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["folds", "--pool", "p", "--data", "nowhere"], 1, "nowhere: no such folder"),
        (["subjects", "--pool", "p", "--data", "nowhere"], 1, "nowhere: no such folder"),
    ],
)
def test_wrong_use_is_one_line(arguments, status, words, capsys, monkeypatch):
    monkeypatch.setattr(checkpoints, "need_torch", lambda: None)
    assert reading_study.main(arguments) == status
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.err.count("\n") == 1
