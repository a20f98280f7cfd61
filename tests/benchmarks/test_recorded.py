"""Boxes of another program: read, refused where they are none, and scored beside ours."""

import json
from types import SimpleNamespace

import pytest

from lightgesture.benchmarks.finding.mediapipe_hands import describe
from lightgesture.benchmarks.finding.recorded import read_recorded, recorded_runs
from lightgesture.benchmarks.scorer import Reading
from lightgesture.errors import InputError
from lightgesture.training.datasets import read_frames


def row(file, mode="single", hands=(), method="other"):
    return {"method": method, "mode": mode, "file": file, "hands": list(hands), "ms": 12.5}


def write(path, rows):
    path.write_text("\n".join(json.dumps(item) for item in rows), encoding="utf-8")
    return path


def test_boxes_are_scored_for_groups_that_are_complete(data, tmp_path):
    hand = {"box": [20.4, 30, 31, 41], "side": "right", "score": 0.9}
    names = [f"frames/lab/hover/{number}.png" for number in (2, 10)]
    rows = [row(name, mode, [hand]) for name in names for mode in ("single", "sequence")]
    rows += [row("frames/lab/tank/a.png"), row(names[0], method="half")]
    recorded = read_recorded(write(tmp_path / "boxes.jsonl", rows))
    runs = recorded_runs(recorded, read_frames(data), data)
    assert [(run.method, run.group, run.mode, run.score.found, run.score.hands) for run in runs] == [
        ("other", "hover", "single", 2, 4),
        ("other", "hover", "sequence", 2, 4),
        ("other", "tank", "single", 0, 1),
    ]
    assert runs[0].answers[0].readings == (Reading((20, 30, 31, 41), "right", None),)


@pytest.mark.parametrize(
    "bad",
    [
        "{",
        "[]",
        json.dumps({"method": "a"}),
        json.dumps(row("a", mode="twice")),
        json.dumps(row("a", hands=[{"box": [1, 2, 3], "side": None}])),
        json.dumps(row("a", hands=[{"box": [1, 2, 3, 4], "side": "middle"}])),
        json.dumps(row("a", hands=[{"box": [1, 2, 3, None], "side": None}])),
        json.dumps(row("a", hands=[{"box": [1, 2, 3, float("inf")], "side": None}])),
    ],
)
def test_the_line_that_is_no_row_is_named(tmp_path, bad):
    path = tmp_path / "boxes.jsonl"
    path.write_text(json.dumps(row("a")) + "\n" + bad + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"boxes\.jsonl: line 2 is no row"):
        read_recorded(path)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.jsonl: cannot be read"):
        read_recorded(tmp_path / "none.jsonl")


def test_landmarks_become_grown_boxes_with_the_divers_side():
    """What MediaPipe calls Left in an unmirrored picture is the right hand."""

    def landmarks(*points):
        return SimpleNamespace(landmark=[SimpleNamespace(x=x, y=y) for x, y in points])

    def handedness(label, score):
        return SimpleNamespace(classification=[SimpleNamespace(label=label, score=score)])

    result = SimpleNamespace(
        multi_hand_landmarks=[landmarks((0.1, 0.2), (0.3, 0.7)), landmarks((0.6, 0.2), (0.7, 0.4))],
        multi_handedness=[handedness("Left", 0.8), handedness("Right", 0.9)],
    )
    first, second = describe(result, 1000, 100)
    assert first == {"box": (591, 18, 118, 24), "side": "left", "score": 0.9}
    assert second == {"box": (82, 16, 236, 58), "side": "right", "score": 0.8}
    empty = SimpleNamespace(multi_hand_landmarks=None, multi_handedness=None)
    assert describe(empty, 10, 10) == []
