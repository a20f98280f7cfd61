"""Public sets in their published forms, on tiny made-up folders: what is read, and what is refused."""

import argparse
import json

import cv2
import numpy as np
import pytest

from lightgesture import models
from lightgesture.benchmarks import methods
from lightgesture.benchmarks.commands import evaluate
from lightgesture.benchmarks.commands.evaluate_divers import FORMATS as NAMED
from lightgesture.benchmarks.divers.pictures import DiverHand, spread
from lightgesture.benchmarks.public.caddy import read_caddy
from lightgesture.benchmarks.public.hagrid import read_hagrid
from lightgesture.benchmarks.public.registry import FORMATS, read_public
from lightgesture.benchmarks.public.scubanet import LARGEST, read_scubanet, read_voc
from lightgesture.benchmarks.scorer import Reading
from lightgesture.errors import InputError, UsageError

VOC = """<annotation><folder>x</folder><filename>{name}</filename>
<source><database>Unknown</database></source><size><width>160</width><height>120</height></size>
<object><name>Diver</name><pose>Unspecified</pose>
<bndbox><xmin>10</xmin><ymin>5</ymin><xmax>100</xmax><ymax>110</ymax></bndbox></object>
<object><name>Hand</name><bndbox><xmin>20</xmin><ymin>30</ymin><xmax>51</xmax><ymax>71</ymax></bndbox></object>
<object><name>head</name><bndbox><xmin>40.5</xmin><ymin>8</ymin><xmax>60.5</xmax><ymax>28</ymax></bndbox></object>
</annotation>"""
TABLE = """scenario,stereo left,stereo right,label name,label id,roi left,roi right,synthetic
biograd-A,/biograd-A/true_positives/raw/a_left.jpg,/r.jpg,two,12,"[20,30,31,41]","[1,2,3,4]",0
biograd-A,/biograd-A/true_positives/raw/a_left.jpg,/r.jpg,two,12,"[20,30,31,41]","[1,2,3,4]",1
genova-A,/genova-A/true_positives/raw/b_left.jpg,/r.jpg,mosaic,9,"[20,30,31,41];[90,30,31,41]",,0
genova-A,/genova-A/true_positives/raw/c_left.jpg,/r.jpg,up,2,"[20,30,31,41]",,0
"""
NEGATIVES = """scenario,stereo left,stereo right,label name,label id,synthetic
genova-A,/genova-A/true_negatives/raw/d_left.jpg,/r.jpg,,-1,0
"""
LABELS = {
    "one": {
        "p1": {
            "bboxes": [[0.125, 0.25, 0.2, 0.35]],
            "labels": ["one"],
            "user_id": "u",
            "leading_hand": "right",
        },
        "p2": {"bboxes": [[0.1, 0.1, 0.2, 0.2], [0.5, 0.5, 0.2, 0.2]], "labels": ["one", "no_gesture"]},
    },
    "peace_inverted": {"p3": {"bboxes": [[0.1, 0.1, 0.2, 0.2]], "labels": ["peace_inverted"]}},
}


def picture(path):
    path.parent.mkdir(parents=True, exist_ok=True)
    image = np.full((120, 160, 3), (150, 110, 40), np.uint8)
    path.write_bytes(cv2.imencode(path.suffix, image)[1].tobytes())


@pytest.fixture
def scubanet(tmp_path):
    folder = tmp_path / "scubanet"
    for place, name in (("reef", "a"), ("reef", "b"), ("lake", "a")):
        picture(folder / place / "images" / f"{name}.jpg")
        labels = folder / place / "labels" / f"{name}.xml"
        labels.parent.mkdir(exist_ok=True)
        labels.write_text(VOC.format(name=f"{name}.jpg"), encoding="utf-8")
    return folder


@pytest.fixture
def caddy(tmp_path):
    folder = tmp_path / "caddy"
    folder.mkdir()
    (folder / "CADDY_true_positives.csv").write_text(TABLE, encoding="utf-8")
    (folder / "CADDY_true_negatives.csv").write_text(NEGATIVES, encoding="utf-8")
    (folder / "notes.csv").write_text("who,what\nsomebody,nothing\n", encoding="utf-8")
    for name in (
        "biograd-A/true_positives/raw/a",
        "genova-A/true_positives/raw/b",
        "genova-A/true_negatives/raw/d",
    ):
        picture(folder / f"{name}_left.jpg")
    return folder


@pytest.fixture
def hagrid(tmp_path):
    folder = tmp_path / "hagrid"
    for name, labels in LABELS.items():
        file = folder / "annotations" / "test" / f"{name}.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(labels), encoding="utf-8")
        for key in labels:
            picture(folder / "images" / name / f"{key}.jpg")
    return folder


def test_a_voc_file_names_picture_diver_head_and_hand(scubanet):
    frames = {frame.file: frame for frame in read_scubanet(scubanet)}
    assert sorted(frames) == ["lake/images/a.jpg", "reef/images/a.jpg", "reef/images/b.jpg"]
    frame = frames["lake/images/a.jpg"]
    assert (frame.place, frame.path.is_file()) == ("lake/images", True)
    assert frame.hands == (DiverHand((20, 30, 31, 41)),)
    assert frame.hands[0].may_be_sign
    assert not frame.hands[0].is_sign
    assert (frame.heads, frame.bodies) == (((40, 8, 20, 20),), ((10, 5, 90, 105),))


def test_pictures_are_found_by_the_name_of_their_labels_too(scubanet):
    (scubanet / "reef" / "labels" / "b.xml").write_text(
        VOC.format(name=r"C:\old\frame7.jpg"), encoding="utf-8"
    )
    assert "reef/images/b.jpg" in {frame.file for frame in read_scubanet(scubanet)}


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ('<!DOCTYPE a [<!ENTITY b "c">]><annotation>&b;</annotation>', "declares a document type"),
        ('<!DOCTYPE a SYSTEM "file:///etc/passwd"><annotation/>', "declares a document type"),
        ("<annotation><object>", "is no XML"),
        ("no labels", "is no XML"),
        (VOC.format(name="a").replace("<xmax>51</xmax>", ""), "has no name or no box"),
        (VOC.format(name="a").replace("<xmax>51</xmax>", "<xmax>20</xmax>"), "has no name or no box"),
        (VOC.format(name="a").replace("<xmax>51</xmax>", "<xmax>nan</xmax>"), "has no name or no box"),
        (VOC.format(name="a").replace("<xmax>51</xmax>", "<xmax>1e999</xmax>"), "has no name or no box"),
        (" " * (LARGEST + 1), "has more than"),
    ],
)
def test_damaged_and_dangerous_labels_are_refused(tmp_path, content, told):
    file = tmp_path / "a.xml"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=told):
        read_voc(file)


def test_caddy_has_a_gesture_a_row_and_pictures_without_one(caddy):
    frames = {frame.path.name: frame for frame in read_caddy(caddy)}
    assert {name: (frame.place, frame.dive) for name, frame in frames.items()} == {
        "d_left.jpg": ("genova", "genova-A"),
        "a_left.jpg": ("biograd", "biograd-A"),
        "b_left.jpg": ("genova", "genova-A"),
        "c_left.jpg": ("genova", "genova-A"),
    }
    assert frames["a_left.jpg"].hands == (DiverHand((20, 30, 31, 41), "2", "glove", margin=0.0),)
    assert frames["a_left.jpg"].hands[0].outline == (20, 30, 31, 41)
    assert [(hand.box, hand.shape) for hand in frames["b_left.jpg"].hands] == [
        ((20, 30, 31, 41), "mosaic"),
        ((90, 30, 31, 41), "mosaic"),
    ]
    assert frames["c_left.jpg"].hands[0].shape == "thumb_up"
    assert frames["d_left.jpg"].hands == ()
    assert len(read_caddy(caddy)) == 4  # what was made from others by computer is left out


@pytest.mark.parametrize("roi", ["[20,30,31]", "[20,30,0,41]", "hand"])
def test_a_damaged_region_is_told_with_its_line(caddy, roi):
    table = caddy / "CADDY_true_positives.csv"
    table.write_text(TABLE.replace("[20,30,31,41]", roi), encoding="utf-8")
    with pytest.raises(InputError, match=r"line 2: .* is no"):
        read_caddy(caddy)


def test_boxes_of_hagrid_are_shares_of_the_picture(hagrid):
    frames = {frame.path.stem: frame for frame in read_hagrid(hagrid)}
    assert (frames["p1"].place, frames["p1"].file) == ("one", "images/one/p1.jpg")
    pixels = frames["p1"].in_pixels(160, 120)
    assert [(hand.box, hand.shape, hand.glove) for hand in pixels.hands] == [((20, 30, 32, 42), "1", "bare")]
    assert pixels.in_pixels(999, 999) is pixels
    assert [hand.shape for hand in frames["p2"].hands] == ["1", "rest"]
    assert frames["p3"].hands[0].shape == "2"


@pytest.mark.parametrize(
    "content",
    [
        "[]",
        "{",
        '{"a": {"bboxes": [[0, 0, 1]], "labels": ["ok"]}}',
        '{"a": {"bboxes": [[0, 0, 1, 1]], "labels": []}}',
        '{"a": {"bboxes": [[0, 0, 0, 1]], "labels": ["ok"]}}',
        '{"a": {"labels": ["ok"]}}',
        '{"a": {"bboxes": [[0, 0, 1, Infinity]], "labels": ["ok"]}}',
    ],
)
def test_damaged_labels_of_hagrid_are_told(hagrid, content):
    file = hagrid / "annotations" / "test" / "one.json"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(InputError, match=r"one\.json: is no file of HaGRID's labels"):
        read_hagrid(hagrid)


def test_formats_of_the_command_are_those_that_are_read():
    assert tuple(FORMATS) == NAMED


def test_missing_pictures_are_counted(caddy, tmp_path):
    told = []
    frames = read_public(caddy, "caddy", told.append)
    assert len(frames) == 3
    assert told == [f"{caddy}: 1 of 4 labelled pictures are missing and left out"]
    for path in caddy.rglob("*.jpg"):
        path.unlink()
    with pytest.raises(InputError, match="holds none of the 4 pictures of its caddy labels"):
        read_public(caddy, "caddy", told.append)
    with pytest.raises(InputError, match="no such folder"):
        read_public(tmp_path / "away", "caddy", told.append)


@pytest.mark.parametrize("name", NAMED)
def test_a_folder_of_something_else_is_refused(tmp_path, name):
    with pytest.raises(InputError, match="name the folder of"):
        read_public(tmp_path, name, print)


def test_pictures_are_spread_evenly():
    assert spread(list("abcdef"), 3) == ["a", "c", "e"]
    assert spread(list("abc"), 5) == list("abc")
    assert spread(list("abc"), None) == list("abc")


class Finds:
    """Finds one hand in every picture and reads "1" there."""

    name = "fake"

    def read(self, image):
        del image
        return [Reading((20, 30, 32, 42), "right", "1")]


@pytest.fixture
def command(monkeypatch, fake_classifier, capsys):
    """Runs `evaluate` with fakes for model and pipeline; the rows of its tables by their names."""
    monkeypatch.setattr(models, "load_classifier", lambda _: fake_classifier)
    monkeypatch.setattr(methods, "reading_method", lambda *_: Finds())
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)

    def run(*arguments):
        assert evaluate.run(parser.parse_args([*map(str, arguments), "--json"])) == 0
        rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
        return {
            name: [row for row in rows if row["table"] == name] for name in ("signs", "other_hands", "stray")
        }

    return run


def test_the_tables_of_divers_are_made_of_hagrid(command, hagrid, tmp_path):
    tables = command(hagrid, "--format", "hagrid", "--out", tmp_path / "out")
    by_token = {row["group"]: row for row in tables["signs"] if row["by"] == "token"}
    assert (by_token["1"]["signs"], by_token["1"]["found"], by_token["1"]["read"]) == (2, 1, 1)
    assert (tmp_path / "out" / "divers_hands.csv").is_file()
    few = command(hagrid, "--format", "hagrid", "--most", "1")
    assert [row["signs"] for row in few["signs"] if row["by"] == "all"] == [1]


def test_hands_of_no_told_shape_may_be_signs(command, scubanet):
    tables = command(scubanet, "--format", "scubanet", "--place", "reef/images")
    (row,) = [row for row in tables["other_hands"] if row["by"] == "shape"]
    assert (row["group"], row["hands"], row["found"], row["token"]) == ("not told", 2, 2, 2)
    assert tables["signs"] == []
    assert [row["any_token"] for row in tables["stray"]] == [0, 0]


def test_tokens_beside_gestures_of_caddy_are_stray(command, caddy):
    tables = command(caddy, "--format", "caddy")
    everywhere = tables["stray"][0]
    assert (everywhere["frames"], everywhere["any_token"]) == (2, 2)  # two hands of `mosaic`, and no gesture


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nowhere"], "nowhere: no such target"),
        (["--format", "caddy"], "name its folder too"),
        (["hands", "--most", "3"], "--most is about real divers"),
    ],
)
def test_misplaced_words_are_refused(arguments, told):
    parser = argparse.ArgumentParser()
    evaluate.add_arguments(parser)
    with pytest.raises(UsageError, match=told):
        evaluate.run(parser.parse_args(arguments))
