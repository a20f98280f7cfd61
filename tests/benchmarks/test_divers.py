"""Real divers: labels and sides, what is found and read of them, tokens where none is shown, runs put together."""

import argparse
import csv
import json
from dataclasses import replace

import cv2
import numpy as np
import pytest

from lightgesture import models
from lightgesture.benchmarks import methods
from lightgesture.benchmarks.commands import evaluate
from lightgesture.benchmarks.divers.measures import contrast, size_at_reference
from lightgesture.benchmarks.divers.pictures import DiverFrame, DiverHand, choose_frames, read_divers, side_of
from lightgesture.benchmarks.divers.rows import FrameRow, HandRow, read_rows, write_rows
from lightgesture.benchmarks.divers.scoring import DiverMethod, score_divers
from lightgesture.benchmarks.divers.tables import bin_name, diver_tables
from lightgesture.benchmarks.scorer import Reading
from lightgesture.errors import InputError, UsageError
from lightgesture.features.profile import save_profile
from lightgesture.features.profile_learning import learn_profile

HEADER = ("file", "sequence", "kind", "x", "y", "w", "h", "shape", "glove", "view")
ROWS = (
    ("frames/reef/a.png", "reef_1", "hand", "20.0", "30.0", "31.0", "41.0", "5", "bare", "palm"),
    ("frames/reef/a.png", "reef_1", "hand", "110", "30", "31", "41", "rest", "bare", "back"),
    ("frames/reef/a.png", "reef_1", "head", "70", "10", "20", "20", "", "", ""),
    ("frames/reef/b.png", "reef_2", "hand", "20", "30", "31", "41", "ok", "glove", "side"),
    ("frames/pool/c.png", "pool_1", "diver", "60", "20", "40", "90", "", "", ""),
    ("frames/pool/d.png", "pool_1", "", "", "", "", "", "", "", ""),
)


@pytest.fixture
def divers(tmp_path):
    """Four pictures of three dives at two places; in the last one nothing is labelled."""
    folder = tmp_path / "data" / "divers"
    for file in {row[0] for row in ROWS}:
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        image = np.full((120, 160, 3), (150, 110, 40), np.uint8)
        cv2.ellipse(image, (35, 50), (15, 20), 0, 0, 360, (120, 150, 210), -1)
        path.write_bytes(cv2.imencode(".png", image)[1].tobytes())
    write_table(folder, ROWS)
    return tmp_path / "data"


def write_table(folder, rows):
    with (folder / "boxes.csv").open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream).writerows([HEADER, *rows])


class Finds:
    """Finds the image-left hand in every picture and reads "5" there, and another one with "2" far from any."""

    name = "fake"

    def read(self, image):
        del image
        return [Reading((20, 30, 31, 41), "right", "5"), Reading((60, 80, 20, 20), "left", "2")]


@pytest.fixture
def scored(divers, fake_classifier):
    return score_divers([DiverMethod("fake", Finds(), fake_classifier)], read_divers(divers))


def test_the_table_tells_hands_heads_places_and_dives(divers):
    frames = {frame.file: frame for frame in read_divers(divers)}
    first = frames["frames/reef/a.png"]
    assert (first.place, first.dive, first.heads) == ("reef", "reef_1", ((70, 10, 20, 20),))
    assert first.hands == (
        DiverHand((20, 30, 31, 41), "5", "bare", "palm"),
        DiverHand((110, 30, 31, 41), "rest", "bare", "back"),
    )
    assert [hand.is_sign for hand in first.hands] == [True, False]
    assert first.hands[0].outline == (21, 32, 29, 37)
    assert frames["frames/pool/c.png"].bodies == ((60, 20, 40, 90),)
    assert frames["frames/pool/d.png"].hands == ()


def test_a_damaged_box_is_told_with_its_line(divers):
    write_table(divers / "divers", [(*ROWS[0][:4], "no number", *ROWS[0][5:])])
    with pytest.raises(InputError, match="line 2: x,y,w,h is no box"):
        read_divers(divers)


def test_places_and_dives_are_chosen_by_name(divers):
    frames = read_divers(divers)
    assert choose_frames(frames) == frames
    chosen = choose_frames(frames, ["pool"], ["reef_2"])
    assert [frame.dive for frame in chosen] == ["reef_2", "pool_1", "pool_1"]
    with pytest.raises(UsageError, match="--dive lake: no such dive; there are pool_1, reef_1, reef_2"):
        choose_frames(frames, dives=["lake"])


@pytest.mark.parametrize(
    ("hands", "heads", "bodies", "sides"),
    [
        ([(10, 0, 10, 10), (30, 0, 10, 10)], [(0, 0, 4, 4)], [], ["right", "left"]),
        ([(10, 0, 10, 10)], [(0, 0, 4, 4)], [(40, 0, 4, 4)], ["left"]),
        ([(10, 0, 10, 10)], [], [(40, 0, 4, 4)], ["right"]),
        ([(10, 0, 10, 10)], [], [], ["right"]),
        ([(90, 0, 10, 10)], [], [], ["left"]),
        ([(10, 0, 10, 10), (60, 0, 10, 10)], [(20, 0, 4, 4), (50, 0, 4, 4)], [], ["right", "left"]),
        ([(25, 0, 10, 10), (40, 0, 10, 10)], [(20, 0, 4, 4), (50, 0, 4, 4)], [], ["left", "right"]),
    ],
)
def test_sides_go_by_order_and_by_the_nearest_axis(tmp_path, hands, heads, bodies, sides):
    frame = DiverFrame(
        *(tmp_path, "a", "p", "d", tuple(DiverHand(box) for box in hands), tuple(heads), tuple(bodies))
    )
    assert [side_of(hand, frame, 100) for hand in frame.hands] == sides


def test_hands_are_scored_found_and_in_given_boxes(scored, fake_classifier):
    first, second, third = scored.hands
    assert (first.shape, first.iou, first.found_token, first.side) == ("5", 1.0, "5", "right")
    assert (first.named, first.p_named, first.p_none, first.given_token) == ("5", 0.6, 0.3, "")
    assert (second.iou, second.found_token, second.side) == (0.0, "", "left")
    assert (third.shape, third.found_token) == ("ok", "5")
    assert first.size == pytest.approx(size_at_reference((20, 30, 31, 41), 160), abs=0.05)
    assert fake_classifier.calls[0][1:] == ([(21, 32, 29, 37), (111, 32, 29, 37)], ["right", "left"])


def test_tokens_beside_the_shown_signs_are_stray(scored):
    assert [(row.file[-5], row.signs, row.tokens, row.stray) for row in scored.frames] == [
        ("a", 1, "5 2", 1),
        ("b", 1, "5 2", 1),
        ("c", 0, "5 2", 2),
        ("d", 0, "5 2", 2),
    ]


def test_tables_count_by_group(scored):
    signs, others, stray = diver_tables(scored.hands, scored.frames)
    rows = {(row["by"], row["group"]): row for row in signs.rows}
    everything = rows["all", "all"]
    assert (everything["signs"], everything["found"], everything["read"], everything["wrong"]) == (2, 2, 1, 1)
    assert (everything["named"], everything["given_read"], everything["given_wrong"]) == (1, 0, 0)
    assert (rows["glove", "bare"]["read"], rows["glove", "glove"]["read"]) == (1, 0)
    assert rows["token", "ok"]["wrong"] == 1
    (row,) = [row for row in others.rows if row["by"] == "shape"]
    assert (row["group"], row["hands"], row["found"], row["token"], row["none_auroc"]) == (
        "rest",
        1,
        0,
        0,
        0.5,
    )
    rows = {row["place"]: row for row in stray.rows}
    assert list(rows) == ["all", "pool", "reef"]
    assert (rows["all"]["frames"], rows["all"]["any_token"], rows["all"]["two_tokens"]) == (2, 2, 2)
    assert (rows["all"]["sign_frames"], rows["all"]["stray_frames"]) == (2, 2)


def test_a_wrong_token_on_a_found_sign_is_no_stray_one(divers, fake_classifier):
    class Wrong(Finds):
        def read(self, image):
            return super().read(image)[:1]

    scored = score_divers([DiverMethod("fake", Wrong(), fake_classifier)], read_divers(divers))
    assert [row.stray for row in scored.frames] == [0, 0, 1, 1]


def test_groups_by_a_number_have_bounds():
    assert [bin_name(value, (8.0, 16.0)) for value in (0.0, 8.0, 15.9, 16.0)] == [
        *("under 8", "8 to 16", "8 to 16", "16 or more"),
    ]


def test_contrast_is_the_distance_of_hand_and_background():
    image = np.zeros((100, 100, 3), np.uint8)
    assert contrast(image, (30, 30, 40, 40)) == 0.0
    image[30:70, 30:70] = 255
    assert contrast(image, (30, 30, 40, 40)) == pytest.approx(100.0, abs=0.1)
    assert contrast(image, (200, 200, 5, 5)) == 0.0
    assert contrast(image, (0, 0, 100, 100)) == 0.0  # nothing is around it


def test_rows_come_back_from_their_file(tmp_path, scored):
    hands = [replace(scored.hands[0], p_none=None), *scored.hands[1:]]
    write_rows(tmp_path / "h.csv", hands)
    write_rows(tmp_path / "f.csv", scored.frames)
    assert read_rows(tmp_path / "h.csv", HandRow) == hands
    assert read_rows(tmp_path / "f.csv", FrameRow) == list(scored.frames)
    with pytest.raises(InputError, match="is no row of an evaluation"):
        read_rows(tmp_path / "f.csv", HandRow)


@pytest.fixture
def command(monkeypatch, divers, fake_classifier):
    """Runs `evaluate divers` with fakes for model and pipeline."""
    monkeypatch.setattr(models, "load_classifier", lambda _: fake_classifier)
    monkeypatch.setattr(methods, "reading_method", lambda *_: Finds())
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)
    return lambda *arguments: evaluate.run(
        parser.parse_args(["divers", "--data", str(divers), *map(str, arguments)])
    )


def told(capsys, table):
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    return [row for row in rows if row["table"] == table]


def test_models_and_selectors_stand_side_by_side(command, capsys):
    assert command("--json", "--model", "cnn", "--model", "svm", "--selector", "my.npz") == 0
    rows = told(capsys, "signs")
    assert [row["method"] for row in rows if row["by"] == "all"] == ["cnn, my.npz", "svm, my.npz"]


def test_selectors_are_scored_with_a_profile_too(command, tmp_path, capsys):
    image = np.zeros((40, 40, 3), np.uint8)
    image[10:30, 10:30] = (200, 60, 20)
    save_profile(tmp_path / "blue.json", learn_profile([image], [[(10, 10, 20, 20)]], "glove", "drawn"))
    command("--json", "--selector", "classical", "--profile", tmp_path / "blue.json")
    rows = told(capsys, "signs")
    assert [row["method"] for row in rows if row["by"] == "all"] == [
        "cnn, classical",
        "cnn, classical, profile",
    ]
    with pytest.raises(UsageError, match=r"none\.json"):
        command("--profile", tmp_path / "none.json")


def test_sheets_and_rows_are_written(command, tmp_path, capsys):
    assert command("--out", tmp_path / "out") == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        *("divers_hands.csv", "divers_frames.csv"),
        *("divers_missed_cnn_1.jpg", "divers_given_cnn_1.jpg", "divers_stray_cnn_1.jpg"),
    }
    assert capsys.readouterr().err.count("wrote ") == 5


def test_runs_on_other_dives_are_put_together(command, tmp_path, capsys):
    command("--json")
    whole = told(capsys, "signs")
    command("--place", "reef", "--out", tmp_path / "1", "--model", "a.npz")
    command("--dive", "pool_1", "--out", tmp_path / "2", "--model", "b.npz")
    capsys.readouterr()
    assert command("--json", "--join", tmp_path / "1", "--join", tmp_path / "2") == 0
    assert told(capsys, "signs") == [{**row, "method": "joined"} for row in whole]
    with pytest.raises(InputError, match=r"stands in .*1 and in .*1"):
        command("--join", tmp_path / "1", "--join", tmp_path / "1")


def test_selectors_of_folds_are_scored_on_the_dives_that_they_did_not_see(command, tmp_path, capsys):
    for file, dives in (("1", ["divers reef_1", "divers reef_2"]), ("2", ["divers reef_2", "divers pool_1"])):
        card = {"left_out": {"sources": dives, "fold": None}}
        (tmp_path / f"{file}.json").write_text(json.dumps(card), encoding="utf-8")
    command("--json", "--place", "reef")
    reef = told(capsys, "signs")
    assert command("--json", "--fold", tmp_path / "1.npz") == 0
    assert told(capsys, "signs") == [{**row, "method": "joined"} for row in reef]
    command("--json")
    whole = told(capsys, "signs")
    # A dive that two files left out is scored by the first.
    command("--json", "--fold", tmp_path / "1.npz", "--fold", tmp_path / "2.npz")
    assert told(capsys, "signs") == [{**row, "method": "joined"} for row in whole]
    with pytest.raises(InputError, match=r"none\.json"):
        command("--fold", tmp_path / "none.npz")


@pytest.mark.parametrize(
    "more", [["--selector", "learned"], ["--profile", "a"], ["--model", "cnn", "--model", "svm"]]
)
def test_folds_name_their_selectors_themselves(command, more):
    with pytest.raises(UsageError, match="--fold names the selectors itself"):
        command("--fold", "1.npz", *more)


def test_rows_of_several_models_are_not_put_together(command, tmp_path):
    command("--out", tmp_path / "1", "--model", "cnn", "--model", "svm")
    with pytest.raises(InputError, match="rows of several models or selectors"):
        command("--join", tmp_path / "1")


@pytest.mark.parametrize("options", [["--place", "reef"], ["--dive", "a"], ["--join", "a"]])
def test_options_about_divers_need_their_target(options):
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)
    with pytest.raises(UsageError, match=f"{options[0]} is about real divers"):
        evaluate.run(parser.parse_args(["regions", *options]))


def test_a_folder_without_divers_is_named(command, divers):
    (divers / "divers" / "boxes.csv").unlink()
    with pytest.raises(InputError, match="holds no pictures for divers"):
        command()


def test_the_real_table_is_read(real_data):
    frames = read_divers(real_data)
    hands = [hand for frame in frames for hand in frame.hands]
    assert len(hands) > 900
    assert {frame.place for frame in frames} >= {"barbados", "kingston", "seneca"}
    assert sum(hand.is_sign for hand in hands) == 96
