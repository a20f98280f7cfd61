"""The command: tables as text and JSON, contact sheets, and clear refusals."""

import argparse
import json
import subprocess
import sys
from copy import copy

import cv2
import numpy as np
import pytest

from lightgesture import models
from lightgesture.benchmarks import accuracy
from lightgesture.benchmarks.commands import evaluate
from lightgesture.benchmarks.contact_sheet import MAX_TILES, choose_evenly, save_sheet
from lightgesture.benchmarks.finding import ablation
from lightgesture.benchmarks.finding import report as finding_report
from lightgesture.benchmarks.reading import cost as reading_cost
from lightgesture.benchmarks.reading import report as reading_report
from lightgesture.errors import InputError, UsageError


def copy_named(method, name):
    """The same method under another name."""
    named = copy(method)
    named.name = name
    return named


@pytest.fixture
def command(monkeypatch, data, fake_classifier, fake_method):
    """Runs `evaluate` on the drawn data folder with fakes for model and pipeline."""

    def load(_name):
        return fake_classifier

    def make_pipeline(_model, _selector):
        return fake_method

    monkeypatch.setattr(models, "load_classifier", load)
    monkeypatch.setattr(accuracy, "product", make_pipeline)
    monkeypatch.setattr(finding_report, "selector_method", lambda name: copy_named(fake_method, name))
    monkeypatch.setattr(reading_report, "selector_method", lambda name: copy_named(fake_method, name))
    monkeypatch.setattr(reading_cost, "added_memory", lambda name: 7.5)
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)

    def run(*arguments):
        return evaluate.run(parser.parse_args(["--data", str(data), *arguments]))

    return run


def test_all_targets_as_text(command, capsys):
    assert command() == 0
    captured = capsys.readouterr()
    titles = [block.splitlines()[0] for block in captured.out.split("\n\n")]
    assert titles == [
        "Hands in given boxes",
        "Hands in given boxes, per token",
        "Hands in given boxes, per source",
        "Confusion of tokens (row: truth, column: read as)",
        "Reliability of the probabilities",
        "Hands in bad boxes",
        "Hands cut by the edge or half hidden",
        "Random boxes in frames without a gesturing diver",
        "Hands in boxes that the selector found",
        "What reading costs",
        "Hands found in whole frames",
        "Hands found by token, single frames of all groups",
        "Frames without a gesturing diver in which hands were found",
        "Hands in whole frames",
        "Tokens in single frames (fake)",
        "Instructions of signed sequences",
        "Frames without a gesturing diver: nothing may be found",
    ]
    assert captured.err == ""


def test_native_libraries_say_nothing_on_standard_error(data):
    command = [sys.executable, "-m", "lightgesture", "evaluate", "regions", "--selector", "learned"]
    done = subprocess.run([*command, "--data", str(data)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("Hands found in whole frames\n")


def test_regions_alone_are_found_and_not_read(command, monkeypatch, capsys):
    monkeypatch.setattr(models, "load_classifier", None)
    assert command("regions", "--json", "--selector", "classical", "--selector", "other.npz") == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {row["table"] for row in rows} == {"found", "found_by_token", "false_hands"}
    found = [(row["method"], row["group"], row["mode"]) for row in rows if row["table"] == "found"]
    assert found == [
        ("classical", "hover", "single"),
        ("other.npz", "hover", "single"),
        ("classical", "hover", "sequence"),
        ("other.npz", "hover", "sequence"),
        ("classical", "tank", "single"),
        ("other.npz", "tank", "single"),
    ]


def test_regions_are_read_by_a_named_model(command, capsys):
    assert command("regions", "--json", "--model", "svm") == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {row["table"] for row in rows} == {
        *("found", "found_by_token", "false_hands"),
        *("regions", "regions_by_token", "instructions", "negatives"),
    }
    methods = {row["method"] for row in rows if row["table"] == "regions"}
    assert methods == {"fake", "paper, bank", "paper, classifier"}


def test_the_ablation_is_a_report_of_its_own(command, monkeypatch, fake_method, capsys):
    monkeypatch.setattr(ablation, "ablations", lambda: [copy_named(fake_method, "without")])
    assert command("regions", "--ablation", "--selector", "learned", "--json") == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    (row,) = [row for row in rows if row["table"] == "ablation"]
    assert (row["method"], row["hover"], row["hover, sequence"], row["tank"]) == ("without", 0.5, 0.5, 1.0)
    assert "clips" not in row


@pytest.mark.parametrize(
    "options",
    [["--ablation"], ["--clips"], ["--selector", "learned"], ["--fold", "a.npz"], ["--compare", "b"]],
)
def test_options_about_finding_need_its_target(command, options):
    with pytest.raises(UsageError, match=f"{options[0]} is about finding hands"):
        command("hands", *options)


def test_hands_are_scored_in_frames_too(command, capsys):
    command("hands", "--json")
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    parts = [row["part"] for row in rows if row["table"] == "hands"]
    assert parts == [
        *("hands val", "hands val, none doubtful", "hover, boxes given", "tank, boxes given"),
        "all of lab, boxes given",
    ]


def test_models_stand_side_by_side(command, tmp_path, capsys):
    models_named = ("--model", "svm", "--model", "my own.npz", "--model", "svm")
    assert command("hands", "--json", *models_named, "--out", str(tmp_path)) == 0
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]

    def named(table, key):
        return [(row[key], row["model"]) for row in rows if row["table"] == table]

    assert named("hands_by_token", "token") == [
        *(("2", "svm"), ("2", "my own.npz"), ("5", "svm"), ("5", "my own.npz")),
    ]
    assert named("hands_by_source", "source") == [("anna", "svm"), ("anna", "my own.npz")]
    assert [model for _, model in named("hands_confusion", "truth")] == ["svm"] * 2 + ["my own.npz"] * 2
    assert named("hands_found", "source") == [("lab", "svm"), ("lab", "my own.npz")]
    costs = {row["model"]: row for row in rows if row["table"] == "hands_cost"}
    assert costs["svm"]["memory_mb"] == 7.5
    assert costs["my own.npz"]["file_kb"] is None
    assert {"errors_svm.png", "errors_my_own_npz.png"} <= {path.name for path in tmp_path.iterdir()}


@pytest.mark.parametrize("target", [[], ["regions"], ["suite"]])
def test_several_models_need_their_target(command, target):
    with pytest.raises(UsageError, match="name the target: evaluate hands"):
        command(*target, "--model", "svm", "--model", "cnn")


def test_without_whole_frames_the_first_hand_is_timed_twice(command, data, fake_classifier, capsys):
    for name in ("frames", "negatives"):
        (data / name).rename(data / f"no {name}")
    command("hands", "--json")
    tables = {json.loads(line)["table"] for line in capsys.readouterr().out.splitlines()}
    assert {"hands_cost", "hands_boxes", "hands_hidden"} <= tables
    assert not tables & {"hands_random", "hands_found"}
    assert fake_classifier.calls[-1] == ((112, 112, 3), [(11, 9, 79, 96)] * 2, ["right", "left"])


def test_contact_sheets_show_the_failures(command, tmp_path, capsys):
    out = tmp_path / "sheets"
    command("--out", str(out))
    names = {path.name for path in out.iterdir()}
    assert {"cnn_hover_boxes_given.jpg", "fake_hover_single.jpg", "fake_hover_sequence.jpg"} <= names
    assert "fake_reef_1_single.jpg" not in names
    assert {name for name in names if not name.endswith(".jpg")} == {
        *("errors_cnn.png", "reliability.png", "confusions.png"),
        *(
            f"found_{selector}_hover_{mode}.png"
            for selector in ("learned", "classical")
            for mode in ("single", "sequence")
        ),
    }
    sheet = cv2.imdecode(
        np.frombuffer((out / "fake_hover_single.jpg").read_bytes(), np.uint8), cv2.IMREAD_COLOR
    )
    assert sheet.shape == (240, 1600, 3)
    assert capsys.readouterr().err.count("wrote ") == len(names)


def test_labels_are_green_and_readings_red(command, tmp_path):
    command("regions", "--model", "svm", "--out", str(tmp_path))
    content = np.frombuffer((tmp_path / "fake_tank_single.jpg").read_bytes(), np.uint8)
    blue, green, red = (plane.astype(int) for plane in cv2.split(cv2.imdecode(content, cv2.IMREAD_COLOR)))
    assert ((red > 150) & (green < 120) & (blue < 120)).any()
    assert ((green > 150) & (red < 120) & (blue < 120)).any()


def test_missing_pictures_for_a_target_are_named(command, data):
    (data / "hands").rename(data / "away")
    with pytest.raises(InputError, match="holds no pictures for hands"):
        command("hands")


def test_targets_that_the_folder_lacks_are_left_out(command, data, capsys):
    (data / "frames").rename(data / "away")
    command("--json")
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {row["table"].split("_")[0] for row in rows} == {"hands"}


def test_paper_rows_need_the_training_pictures(command, data, capsys):
    (data / "hands").rename(data / "away")
    command("regions", "--model", "svm", "--json")
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {row["method"] for row in rows if row["table"] == "regions"} == {"fake"}


def test_refused_model_is_a_usage_error(command, monkeypatch):
    def refuse(name):
        raise models.ModelError(f"{name}: not built yet")

    monkeypatch.setattr(models, "load_classifier", refuse)
    with pytest.raises(UsageError, match="cnn: not built yet"):
        command("--model", "cnn")


def test_long_lists_are_thinned_evenly():
    assert choose_evenly(3, 5) == [0, 1, 2]
    assert choose_evenly(10, 5) == [0, 2, 4, 6, 8]
    assert len(choose_evenly(1000)) == MAX_TILES


def test_sheet_without_tiles_is_not_written(tmp_path):
    save_sheet(tmp_path / "none.jpg", [])
    assert list(tmp_path.iterdir()) == []
