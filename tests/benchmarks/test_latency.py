"""The latency benchmark: what it counts, and that it leaves OpenCV as it found it."""

import json
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from lightgesture.benchmarks import latency, timing
from lightgesture.benchmarks.latency import PAPER, measure, read_clips
from lightgesture.benchmarks.tables import Table
from lightgesture.benchmarks.timing import (
    FRAME,
    SINGLE,
    WARM_UP,
    limited_threads,
    time_calls,
)
from lightgesture.front_end import StageClock

ROUNDS = 2


class FakePipeline:
    """Two stages a frame, timed by the real clock."""

    def __init__(self, model, rule):
        assert (model, rule) == ("cnn", "frames")
        self.front = SimpleNamespace(clock=StageClock())
        self.threads = set()

    def process(self, image, time_s):
        assert image.shape == (480, 640, 3)
        self.last = time_s
        self.front.clock.start()
        for stage in ("colour", "tracks"):
            self.front.clock.lap(stage)
        self.front.clock.end_frame()
        self.threads.add(cv2.getNumThreads())

    def recognize(self, image):
        return image


class FakeChain:
    def process(self, image):
        return image


@pytest.fixture
def fake_pipelines(monkeypatch):
    made = []

    def make(model, rule):
        made.append(FakePipeline(model, rule))
        return made[-1]

    monkeypatch.setattr(timing, "Pipeline", make)
    return made


@pytest.fixture
def no_starts(monkeypatch):
    monkeypatch.setattr(latency, "fresh_starts", lambda count=1: Table("starts", "Starts", ("seconds",), ()))
    side = Table("side_by_side", "Side by side", ("size", "what"), ({"size": "640x480", "what": "copy"},))
    monkeypatch.setattr(latency, "side_by_side", lambda *frames: [side])


@pytest.fixture
def no_sample(monkeypatch, tmp_path):
    monkeypatch.setattr(latency, "SAMPLE", tmp_path / "sample.mp4")


def test_warm_up_is_run_but_not_counted():
    seen = []
    frames = [np.zeros((2, 2, 3), np.uint8)] * 2
    assert len(time_calls(seen.append, frames, ROUNDS)) == 4
    assert len(seen) == WARM_UP + 4


def test_a_row_per_clip_threads_and_stage(fake_pipelines):
    frames = [np.zeros((480, 640, 3), np.uint8)] * 5
    rows = measure({"clip": frames}, "cnn", FakeChain, ROUNDS)
    stages = ["colour", "tracks", FRAME, SINGLE, PAPER]
    assert [(row["threads"], row["stage"]) for row in rows] == [
        (n, stage) for n in (1, 2) for stage in stages
    ]
    assert {row["calls"] for row in rows} == {10}
    assert all(0 <= row["median_ms"] <= row["p95_ms"] for row in rows)
    assert [pipeline.threads for pipeline in fake_pipelines] == [{1}, {2}]


def test_time_goes_on_from_round_to_round(fake_pipelines):
    measure({"clip": [np.zeros((480, 640, 3), np.uint8)] * 2}, "cnn", None, ROUNDS)
    assert fake_pipelines[0].last == pytest.approx((WARM_UP + 3) / 30)


def test_threads_are_restored_even_after_an_error():
    before = cv2.getNumThreads()
    inside = []

    def fail():
        with limited_threads(1):
            inside.append(cv2.getNumThreads())
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert inside == [1]
    assert cv2.getNumThreads() == before


@pytest.mark.usefixtures("no_sample")
def test_clips_are_scaled_to_one_size(data):
    clips = read_clips(data)
    assert list(clips) == ["hover"]
    assert [frame.shape for frame in clips["hover"]] == [(480, 640, 3)] * 2


@pytest.mark.usefixtures("no_sample", "no_starts", "fake_pipelines")
def test_table_and_file(data, tmp_path, capsys):
    out = tmp_path / "times.json"
    assert latency.main(["--data", str(data), "--rounds", "2", "--out", str(out)]) == 0
    assert "paper's region selection" in capsys.readouterr().out
    content = json.loads(out.read_text())
    assert content["machine"]["opencv"] == cv2.__version__
    assert content["settings"]["rounds"] == 2
    assert {row["clip"] for row in content["rows"] if row["table"] != "side_by_side"} == {"hover"}
    assert {row["table"] for row in content["rows"]} == {"side_by_side", "latency", "finding"}
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith("times")] == ["times.json"]


@pytest.mark.usefixtures("no_sample", "no_starts")
def test_a_quick_run_is_of_one_size_and_writes_the_same_file(tmp_path, monkeypatch):
    monkeypatch.setattr(latency, "read_clips", lambda folder: {"clip": [np.zeros((48, 64, 3), np.uint8)] * 3})
    assert latency.main(["--quick", "--json", str(tmp_path / "times.json")]) == 0
    content = json.loads((tmp_path / "times.json").read_text())
    assert {row["table"] for row in content["rows"]} == {"side_by_side"}


@pytest.mark.usefixtures("no_sample", "no_starts", "fake_pipelines")
@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (["--data", "nowhere"], 1, "nowhere: no such folder"),
        (["--out", "/proc/nowhere/times.json"], 2, "cannot be written"),
    ],
)
def test_bad_options_are_told_in_one_line(data, capsys, monkeypatch, tmp_path, options, status, message):
    monkeypatch.chdir(tmp_path)
    base = [] if "--data" in options else ["--data", str(data), "--rounds", "1"]
    assert latency.main([*base, *options]) == status
    errors = capsys.readouterr().err.strip().splitlines()
    assert len(errors) == 1
    assert message in errors[0]


@pytest.mark.usefixtures("no_sample")
def test_nothing_to_time_is_told(data, capsys):
    (data / "frames").rename(data / "away")
    assert latency.main(["--data", str(data)]) == 1
    assert "bundled clip is missing" in capsys.readouterr().err
