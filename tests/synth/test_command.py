import argparse
import json

import cv2
import numpy as np
import pytest

from lightgesture.errors import UsageError
from lightgesture.synth import command as synth
from lightgesture.synth.output import render_frames
from lightgesture.synth.scene import Scene
from lightgesture.synth.showcase import SAMPLE_SPEC
from lightgesture.synth.spec import SceneSpec, WaterSpec


def run(*words):
    parser = argparse.ArgumentParser()
    synth.add_arguments(parser)
    return synth.run(parser.parse_args([str(word) for word in words]))


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "dive.toml"
    path.write_text('sentences = ["STOP UP GO"]\nsize = [96, 72]\nhold = [15, 15]\npassage = [3, 3]\n')
    return path


def test_a_scene_file_becomes_video_and_truth(scene_file, tmp_path, capsys):
    assert run(scene_file, "--out", tmp_path / "out", "--quiet") == 0
    video = cv2.VideoCapture(str(tmp_path / "out" / "dive.mp4"))
    frames = 0
    while video.read()[0]:
        frames += 1
    records = [json.loads(line) for line in (tmp_path / "out" / "dive.jsonl").read_text().splitlines()]
    assert sum(record["type"] == "frame" for record in records) == frames > 50
    assert [record["text"] for record in records if record["type"] == "instruction"] == ["STOP UP GO"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["dive.jsonl", "dive.mp4"]
    assert "dive.mp4" in capsys.readouterr().out


def test_pictures_instead_of_video(scene_file, tmp_path):
    scene_file.write_text("sentences = []\nsize = [64, 64]\n")
    assert run(scene_file, "--out", tmp_path, "--pictures", "--quiet") == 0
    names = sorted(path.name for path in (tmp_path / "dive").iterdir())
    assert names[0] == "000000.png"
    assert cv2.imread(str(tmp_path / "dive" / names[-1])).shape == (64, 64, 3)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        ([], "nothing to render"),
        (["nowhere.toml"], "nowhere.toml: no such file"),
        (["--seed", "1", "--difficulty", "2"], "outside 0 to 1"),
        (["--seed", "-1"], "--seed at least 0"),
        (["--seed", "1", "--jobs", "0"], "--jobs must be at least 1"),
        (["--seed", "1", "--sentence", "STOP DANCE GO"], "no sign for the word 'DANCE'"),
    ],
)
def test_wrong_use_is_told_in_one_line(words, complaint):
    with pytest.raises(UsageError, match=complaint) as caught:
        run(*words)
    assert "\n" not in str(caught.value)


def test_the_sample_signs_its_sentence_with_both_hands_in_view():
    scene = Scene(SAMPLE_SPEC)
    holds = [hold for hold in scene.timeline if hold.pair]
    assert [hold.word for hold in holds] == ["STOP", "HOVER", "5", "AND", "0", "GO"]
    assert all(hold.end - hold.start >= 22 for hold in holds)
    frame = scene.frame((holds[0].start + holds[0].end) // 2)
    assert {hand.side: hand.token for hand in frame.record.hands} == {"left": "ok", "right": "0"}


@pytest.mark.slow
def test_several_processes_render_the_same_frames():
    spec = SceneSpec(size=(80, 64), sentences=(), water=WaterSpec(kind="none"))
    scene = Scene(spec)
    alone, together = (list(render_frames(scene, jobs)) for jobs in (1, 2))
    assert [frame.record for frame in together] == [frame.record for frame in alone]
    assert all(np.array_equal(a.image, b.image) for a, b in zip(together, alone, strict=True))
