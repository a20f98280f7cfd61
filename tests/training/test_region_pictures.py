"""Training pictures of a data folder: reduced with their boxes, never of a source that is left out."""

import csv

import cv2
import numpy as np
import pytest

from lightgesture.training.datasets import fold_of
from lightgesture.training.pool.left_out import LeftOut, left_out
from lightgesture.training.regions.region_pictures import read_material, without_hands

LANDMARKS = ";".join(f"{40 + 8 * (i % 5)};{100 - 4 * i}" for i in range(21))


def write_table(folder, name, rows):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def write_picture(path, size=(640, 480)):
    path.parent.mkdir(parents=True, exist_ok=True)
    picture = np.random.default_rng(0).integers(0, 255, (size[1], size[0], 3), np.uint8)
    cv2.rectangle(picture, (200, 100), (299, 199), (255, 255, 255), -1)
    cv2.imwrite(str(path), picture)


@pytest.fixture(name="data", scope="module")
def _data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    box = {"x": 200, "y": 100, "w": 100, "h": 100, "token": "5"}
    rooms = [{"file": f"train/{name}.png", "set": name, "hand": "single", **box} for name in ("anna", "ben")]
    write_table(folder, "webcam/train.csv", [{**row, "face_boxes": "300,20,81,101"} for row in rooms])
    single = {"file": "frames/subhi/one/1.png", "hand": "image-left", **box, "sequence": "", "order": ""}
    moving = {**single, "file": "frames/subhi/two/1.png", "sequence": "subhi_2", "order": 1}
    drone = {**single, "file": "frames/drone/a/1.png"}
    write_table(folder, "frames/labels.csv", [single, moving, drone])
    waters = [
        {"file": f"negatives/{name}.png", "set": name, "sequence": "", "order": ""}
        for name in ("funie", "u45", "hidden")
    ]
    write_table(folder, "negatives/negatives.csv", waters)
    hands = [
        {"path": f"train/{name}.png", "set": name, "token": "5", "lm": LANDMARKS}
        for name in ("anna", "cleo", "emre_drone")
    ]
    write_table(folder, "hands/train.csv", hands)
    for row in rooms:
        write_picture(folder / "webcam" / row["file"])
    for row in (single, moving, drone, *waters):
        write_picture(folder / row["file"])
    for row in hands:
        write_picture(folder / "hands" / row["path"], (112, 112))
    return folder


def sources(material):
    return (
        [next(iter(one.sources)) for one in material.frames],
        [next(iter(one.sources)) for one in material.empty],
        {hand.source for hand in material.hands},
    )


def test_only_what_may_be_trained_on_is_read(data):
    frames, empty, hands = sources(read_material(data, LeftOut(), 0))
    assert frames == ["anna", "ben", "subhi"]
    assert sorted(empty) == ["funie", "u45"]
    assert hands == {"anna", "cleo"}


def test_sources_left_out_by_name_are_in_nothing(data):
    material = read_material(data, left_out(["anna", "subhi", "funie"]), 0)
    frames, empty, hands = sources(material)
    assert frames == ["ben"]
    assert empty == ["u45"]
    assert "anna" not in hands
    assert {one.source for one in (*material.rooms(), *material.waters())} == {"ben", "u45"}


def test_a_fold_is_left_out_of_every_kind(data):
    for number in (1, 2):
        frames, empty, hands = sources(read_material(data, left_out(fold=f"{number}/2"), 0))
        assert all(fold_of(name, 2) != number - 1 for name in (*frames, *empty, *hands))


def test_boxes_and_faces_shrink_with_the_picture(data):
    anna, _, subhi = read_material(data, LeftOut(), 0).frames
    assert anna.image.shape == (240, 320, 3)
    assert anna.boxes == ((100, 50, 50, 50),)
    assert anna.faces == ((150, 10, 40, 50),)
    assert anna.all_faces
    assert not subhi.all_faces


def test_a_background_keeps_nothing_of_the_hand(data):
    frame = read_material(data, LeftOut(), 0).frames[0]
    assert frame.image[60:90, 110:140].mean() > 250
    assert without_hands(frame)[60:90, 110:140].mean() < 200
