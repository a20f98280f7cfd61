"""`lightgesture practice` with recordings, streams and its page."""

import json
import threading
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from lightgesture import cli
from lightgesture.actions.practice import Plan, run_practice
from lightgesture.benchmarks.mjpeg_server import MjpegServer
from lightgesture.config.settings import DecodeSettings
from lightgesture.errors import ExitStatus, InputError
from lightgesture.frames import Frame
from lightgesture.practice.guide import Guide
from lightgesture.practice.page import mirror_drawing, mirrored
from lightgesture.practice.session import Session
from lightgesture.practice.summary import view
from lightgesture.practice.tasks import named_tasks
from lightgesture.records import FrameRecord, Hand
from lightgesture.sources import Source, open_source
from lightgesture.web import WebListener
from tests.app.practice_makers import GRAMMAR

SAMPLE = "lightgesture/data/sample.mp4"


def test_a_mirror_moves_boxes_and_not_sides():
    hand = Hand(side="left", token="5", confidence=0.9, box=(10, 20, 30, 40), track=1, reason=None)
    record = FrameRecord(source=None, frame=0, time_s=0.0, hands=(hand,))
    (turned,) = mirrored([record], 200)
    assert turned.hands == (replace(hand, box=(160, 20, 30, 40)),)
    image = np.zeros((200, 200, 3), np.uint8)
    image[:, :20] = 255
    drawn = mirror_drawing()(image, [])
    assert drawn[100, 190].min() == 255
    assert drawn[100, 10].max() == 0


def run(capsys, *words):
    status = cli.main(["practice", *map(str, words)])
    out, err = capsys.readouterr()
    return status, out.splitlines(), err.splitlines()


def test_a_recording_is_practised_with(tmp_path, capsys):
    status, out, err = run(capsys, SAMPLE, "--sentence", "stop hover 50 go", "--out", tmp_path, "--seed", 1)
    assert status == 0
    assert "right after" in out[1]
    assert len(err) == 1
    (path,) = tmp_path.glob("*.json")
    content = json.loads(path.read_text(encoding="utf-8"))
    assert content["sentences"][0]["done"]
    assert [sign["word"] for sign in content["sentences"][0]["signs"]] == [
        "STOP",
        "HOVER",
        "5",
        "AND",
        "0",
        "GO",
    ]
    assert path.with_suffix(".png").read_bytes().startswith(b"\x89PNG")


def test_a_person_of_the_study_gets_a_file_and_the_group_a_table(tmp_path, capsys):
    words = (SAMPLE, "--study", "--person", "p1", "--level", "medium", "--out", tmp_path, "--json", "--quiet")
    status, out, err = run(capsys, *words)
    assert (status, len(out), err) == (0, 1, [])
    content = json.loads(out[0])
    assert (content["person"], content["level"], content["sentences"][0]["done"]) == ("p1", "medium", True)
    assert {path.name for path in tmp_path.iterdir()} == {"person-p1.json", "person-p1.png", "study.csv"}


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("97",), "no such device"),
        (("no_such_file.mp4",), "is no stream"),
        ((SAMPLE, "--sentence", "STOP GO"), "GO cannot follow STOP"),
        ((SAMPLE, "--study"), "--person"),
        ((SAMPLE, "--study", "--person", "../x"), "letters, digits"),
        ((SAMPLE, "--study", "--person", "a", "--sentence", "STOP UP GO"), "leave out --sentence"),
        ((SAMPLE, "--grammar", "docs/grammars/sonar.toml", "--study", "--person", "a"), "study's sentences"),
        ((SAMPLE, "--limit", "0"), "--limit"),
        ((SAMPLE, "--count", "0"), "--count"),
    ],
)
def test_wrong_use_is_told_in_one_line(tmp_path, capsys, words, told):
    status, out, err = run(capsys, *words, "--out", tmp_path)
    assert (status, out) == (2, [])
    assert len(err) == 1
    assert told in err[0]


def test_a_recording_that_breaks_off_keeps_what_was_signed(tmp_path, capsys, monkeypatch):
    class Broken(Source):
        name = "broken.mp4"

        def __iter__(self):
            yield Frame(np.full((48, 64, 3), 90, np.uint8), 0, 0.0)
            raise InputError("broken.mp4: ends in the middle of a frame")

    monkeypatch.setattr("lightgesture.actions.practice.open_source", lambda *_: Broken())
    status, out, err = run(capsys, SAMPLE, "--sentence", "STOP HOVER 50 GO", "--out", tmp_path)
    assert status == 1
    assert err[1] == "lightgesture: broken.mp4: ends in the middle of a frame"
    assert out[1] == "0 of 1 sentence signed, 0 mistakes, 0 slips"
    assert len(list(tmp_path.glob("*.json"))) == 1


class FakePage:
    """A page whose browsers come and go."""

    address = "http://127.0.0.1:1/"

    def __init__(self):
        self.viewers = 0
        self.told = {}

    def show(self, image_bgr, records):
        pass

    def tell(self, name, value):
        self.told[name] = value


def test_a_browser_that_closes_is_told_once_and_the_practice_goes_on(monkeypatch):
    session = Session(named_tasks(GRAMMAR, ["STOP HOVER GO"]), GRAMMAR, 60.0, is_revised=False)
    page, messages, clock = FakePage(), [], [0.0]
    monkeypatch.setattr("lightgesture.practice.guide.time.monotonic", lambda: clock[0])
    guide = Guide(session, None, page, lambda _: None, messages.append, threading.Event())
    for viewers, now_s in ((0, 0.0), (0, 20.0), (1, 30.0), (0, 31.0), (0, 36.0), (0, 60.0)):
        page.viewers, clock[0] = viewers, now_s
        guide.show(None, [])
    assert len(messages) == 1
    assert "the page was closed" in messages[0]
    assert page.told["practice"]["sentence"] == "STOP HOVER GO"


def test_an_interruption_keeps_what_was_signed(tmp_path, monkeypatch, capsys):
    class Interrupting(Guide):
        def __init__(self, *parts):
            super().__init__(*parts)
            self.stopping = parts[-1]

        def show(self, image_bgr, records):
            self.stopping.is_interrupted = True
            self.stopping.set()

    monkeypatch.setattr("lightgesture.actions.practice.Guide", Interrupting)
    for plan in (
        Plan(sentences=("STOP HOVER GO",), folder=str(tmp_path / "free")),
        Plan(is_study=True, person="p1", folder=str(tmp_path / "study")),
    ):
        assert run_practice(SAMPLE, DecodeSettings(quiet=True), plan) == ExitStatus.INTERRUPTED
        (path,) = Path(plan.folder).glob("*.json")
        assert not path.name.startswith("person-")
        assert not (Path(plan.folder) / "study.csv").exists()


def test_a_stream_that_never_comes_is_given_up(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("lightgesture.actions.practice.GIVE_UP_S", 0.3)
    status, out, err = run(capsys, "http://127.0.0.1:9/", "--sentence", "STOP HOVER GO", "--out", tmp_path)
    assert status == 1
    assert out[1] == "0 of 1 sentence signed, 0 mistakes, 0 slips"
    assert err[-1].endswith("given up")


@pytest.mark.slow
def test_a_camera_of_the_network_is_practised_with(tmp_path, capsys):
    with open_source(SAMPLE) as frames:
        pictures = [cv2.imencode(".jpg", frame.image)[1].tobytes() for frame in frames]
    with MjpegServer(pictures, 30.0) as camera:
        status, out, _ = run(capsys, camera.address, "--sentence", "STOP HOVER 50 GO", "--out", tmp_path)
    assert status == 0
    assert "right after" in out[1]


def test_the_page_gets_the_practice():
    with WebListener(0, grammar=GRAMMAR) as page:
        session = Session(named_tasks(GRAMMAR, ["STOP HOVER GO"]), GRAMMAR, 60.0, is_revised=False)
        page.tell("practice", view(session))
        import urllib.request

        with urllib.request.urlopen(f"{page.address}state.json", timeout=10) as answer:
            state = json.load(answer)
    assert state["practice"]["signs"][0] == {"word": "STOP", "pair": ["ok", "0"], "seconds": None}
    assert state["expected"] == ["CONTD", "STOP"]
