"""`recognize`: single pictures through the command line."""

import json

import cv2
import numpy as np
import pytest

from lightgesture.errors import ExitStatus
from lightgesture.fsm import load_grammar
from lightgesture.records import Hand
from lightgesture.results.annotated_picture import meaning, pair_of
from lightgesture.results.ownership import is_ours

pytestmark = pytest.mark.usefixtures("fake")


def test_json_records(run, make_picture):
    paths = [
        make_picture("a b.png"),
        make_picture("ö.jpg"),
        make_picture("dark.png", np.zeros((9, 9), np.uint8)),
    ]
    result = run("recognize", *paths, "--json")
    assert (result.status, result.err) == (ExitStatus.OK, [])
    found = [json.loads(line) for line in result.out]
    assert [record["source"] for record in found] == [str(path) for path in paths]
    assert [(record["type"], record["frame"], record["time_s"]) for record in found] == [
        ("frame", None, None)
    ] * 3
    assert [len(record["hands"]) for record in found] == [2, 2, 0]


def test_plain_words(run, make_picture):
    paths = [make_picture("a.png"), make_picture("dark.png", np.zeros((9, 9), np.uint8))]
    assert run("recognize", *paths).out == [
        str(paths[0]),
        "  right hand: 5  (confidence 0.98; 7 x 8 pixels at 5, 6)",
        "  left hand: not read: only partly in the picture  (confidence 0.30; 3 x 4 pixels at 1, 2)",
        str(paths[1]),
        "  no hand found",
    ]


def test_bad_pictures_among_good_ones(run, make_picture, tmp_path):
    text, empty = tmp_path / "text.png", tmp_path / "empty.png"
    text.write_text("no picture")
    empty.touch()
    bad = [text, empty, tmp_path / "gone.png", tmp_path]
    result = run("recognize", make_picture("a.png"), *bad, make_picture("b.png"), "--json")
    assert result.status == ExitStatus.SOME_FAILED
    assert len(result.out) == 2
    assert len(result.err) == 4
    for line, path in zip(result.err, bad, strict=True):
        assert line.startswith(f"lightgesture: {path}: ")


def test_debug_pictures(run, make_picture, tmp_path):
    folder = tmp_path / "debug"
    run(
        "recognize",
        make_picture("x/a.png"),
        make_picture("y/a.png"),
        make_picture("b.png"),
        "--debug-dir",
        folder,
    )
    names = sorted(str(path.relative_to(folder)) for path in folder.rglob("mask-*.png"))
    assert names == ["b/mask-000000.png", "x_a.png/mask-000000.png", "y_a.png/mask-000000.png"]


def test_debug_folder_that_is_a_file(run, make_picture, tmp_path):
    (tmp_path / "debug").write_text("a file")
    result = run("recognize", make_picture("a.png"), "--debug-dir", tmp_path / "debug")
    assert result.status == ExitStatus.USAGE
    assert len(result.err) == 1


def test_options_of_decode_are_refused(run, make_picture):
    result = run("recognize", make_picture("a.png"), "--hold", "3")
    assert result.status == ExitStatus.USAGE
    assert result.err == ["lightgesture: unrecognized arguments: --hold; see lightgesture recognize --help"]


def test_annotated_pictures_and_records(run, make_picture, tmp_path):
    out = tmp_path / "out"
    path = make_picture("a.png", np.full((90, 120, 3), 80, np.uint8))
    for _ in range(2):  # what is ours is replaced
        result = run("recognize", "--annotate", path, "--out", out)
        assert (result.status, result.err) == (ExitStatus.OK, [])
    assert sorted(file.name for file in out.iterdir()) == ["a.jsonl", "a_annotated.png"]
    assert json.loads((out / "a.jsonl").read_text())["source"] == str(path)
    drawn = cv2.imread(str(out / "a_annotated.png"))
    assert drawn.shape[1] == 120
    assert drawn.shape[0] > 90
    assert is_ours(out / "a_annotated.png")
    run("recognize", path, "--annotate", "over", "--rotate", 90, "--out", out)
    assert cv2.imread(str(out / "a_annotated.png")).shape == (120, 90, 3)
    run("recognize", path, "--annotate", "beside", "--out", out)
    assert cv2.imread(str(out / "a_annotated.png")).shape[0] == 90


def test_annotated_pictures_need_a_folder_and_replace_nothing_else(run, make_picture, tmp_path):
    path = make_picture("a.png")
    assert run("recognize", path, "--annotate").err == [
        "lightgesture: --annotate: its files need a folder; name one with --out DIR"
    ]
    foreign = make_picture("a_annotated.png")
    before = foreign.read_bytes()
    result = run("recognize", path, "--annotate", "--out", tmp_path)
    assert result.status == ExitStatus.USAGE
    assert result.err[0].startswith(f"lightgesture: {foreign}: would be replaced and is none of this program")
    assert foreign.read_bytes() == before
    result = run("recognize", foreign, path, "--annotate", "--out", tmp_path)
    assert f"{foreign}: would be replaced and is an input" in result.err[0]


@pytest.mark.parametrize(
    ("left", "right", "words"),
    [
        ("ok", "0", "STOP before a sentence, 0 within one"),
        ("5", "5", "HOVER"),
        ("3", "left", "no word"),
        ("5", None, None),
    ],
)
def test_the_word_of_a_pair(left, right, words):
    hands = tuple(
        Hand(side=side, token=token, confidence=0.9, box=(0, 0, 9, 9), track=None, reason=None)
        for side, token in (("right", right), ("left", left))
    )
    pair = pair_of(hands)
    assert (None if pair is None else meaning(pair, load_grammar())) == words
