"""`practice`: what is asked for, what is noted of it, and what becomes of it at the end."""

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
from lightgesture.errors import ExitStatus, InputError, UsageError
from lightgesture.frames import Frame
from lightgesture.fsm import Decoder, Signs, load_grammar
from lightgesture.practice.guide import Guide
from lightgesture.practice.page import mirror_drawing, mirrored
from lightgesture.practice.picture import summary_page
from lightgesture.practice.session import NOT_READ, Session
from lightgesture.practice.study import read_people, tabulate, tell_table, to_csv
from lightgesture.practice.summary import summary, tell_summary, view
from lightgesture.practice.tasks import STUDY, drawn_tasks, named_tasks, study_tasks
from lightgesture.records import FrameRecord, Hand
from lightgesture.signs.sheet import Text
from lightgesture.sources import Source, open_source
from lightgesture.web import WebListener

GRAMMAR = load_grammar()
SONAR = load_grammar("docs/grammars/sonar.toml")
SAMPLE = "lightgesture/data/sample.mp4"
STEP_S = 0.1
HOLD_S = 0.5


class Diver:
    """Signs to a decoder, ten frames a second, and gives what comes of it to a session."""

    def __init__(self, tasks, grammar=GRAMMAR, limit_s=60.0):
        self.decoder = Decoder(grammar, rule="seconds", hold_seconds=HOLD_S)
        self.session = Session(tasks, grammar, limit_s, is_revised=False)
        self.frame = 0

    def look(self, left, right):
        """One frame; None: a hand that is not read."""
        time_s = self.frame * STEP_S
        box = (0, 0, 10, 10)
        hands = tuple(
            Hand(
                side=side,
                token=token,
                confidence=0.9,
                box=box,
                track=1,
                reason=None if token else "low_confidence",
            )
            for side, token in (("left", left), ("right", right))
        )
        at = {"source": "test", "frame": self.frame, "time_s": time_s}
        events = self.decoder.step(Signs.of_tokens(left, right), time_s, self.frame)
        self.session.take([FrameRecord(hands=hands, **at), *events])
        if self.session.wants_fresh:
            self.decoder.interrupt("again", time_s, self.frame)
            self.session.freshened()
        self.frame += 1

    def sign(self, text, frames=8):
        for pair in text.split():
            for _ in range(frames):
                self.look(*pair.split(","))
            self.look(None, None)


def summary_of(session, person=None, level=None):
    return summary(session, "test", "grammar.toml", person, level)


def test_a_sentence_that_is_signed_as_asked():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO", "CONTD SNAP GO"]))
    assert diver.session.asked.pair == ("ok", "0")
    diver.sign("ok,0 5,5")
    assert diver.session.asked.word == "GO"
    diver.sign("ok,ok pic,0 pic,pic ok,ok")
    assert diver.session.is_done
    first, second = diver.session.progress
    assert (first.is_done, first.mistakes, second.is_done) == (True, [], True)
    assert first.seconds == pytest.approx([0.5, 0.9, 0.9])
    assert first.total_s == pytest.approx(2.3)
    assert not diver.session.confusions
    assert diver.session.last == ("right", "CONTD SNAP GO in 2.6 s")
    diver.sign("5,5")  # nothing is asked for any more
    assert view(diver.session)["is_done"]


def test_digits_need_no_joining_word():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER 50 GO"]))
    diver.sign("ok,0 5,5 ok,5 ok,0 ok,ok")
    progress = diver.session.progress[0]
    assert progress.is_done
    assert [seconds is None for seconds in progress.seconds] == [False, False, False, True, False, False]


def test_another_word_begins_the_sentence_again():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 5,1")
    progress = diver.session.progress[0]
    assert [(mistake.reason, mistake.word, mistake.is_fatal) for mistake in progress.mistakes] == [
        ("wrong_word", "HOVER", True)
    ]
    assert diver.decoder.state == "idle"
    diver.sign("ok,0 5,5 ok,ok")
    assert progress.is_done
    assert (progress.fatal, progress.slips) == (1, 0)


def test_a_pair_that_is_no_word_is_a_slip():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 3,5 5,5 ok,ok")
    progress = diver.session.progress[0]
    assert progress.is_done
    assert (progress.fatal, progress.slips) == (0, 1)
    assert progress.mistakes[0].detail == "3,5 was read for HOVER, and is no word; show it again"
    assert diver.session.confusions == {("5", "3"): 1}
    assert diver.session.readings["5"] == 4


def test_another_sentence_and_a_rejection_are_mistakes():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER 5 GO"]))
    diver.sign("ok,0 5,5 ok,ok")
    diver.sign("ok,0 5,5 pic,0")
    reasons = [mistake.reason for mistake in diver.session.progress[0].mistakes]
    assert reasons == ["other_sentence", "out_of_order"]


def test_hands_that_are_not_read_are_noted_and_passages_are_not():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    for _ in range(2):
        diver.look("1", "2")  # on the way
    for _ in range(6):
        diver.look("ok", None)
    assert diver.session.confusions == {("0", NOT_READ): 1}
    assert diver.session.readings == {"ok": 1, "0": 1}


def test_the_last_sign_held_on_is_no_confusion():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0", frames=20)
    assert not diver.session.confusions


def test_time_is_over():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO", "STOP UP GO"]), limit_s=3.0)
    diver.sign("ok,0 1,1 1,1 1,1")
    first = diver.session.progress[0]
    assert not first.is_done
    assert first.mistakes[-1].reason == "time"
    assert diver.session.number == 1
    assert diver.decoder.state == "idle"
    diver.sign("ok,0 right,right ok,ok")
    assert diver.session.progress[1].is_done


def test_a_sentence_to_be_confirmed():
    diver = Diver(named_tasks(SONAR, ["STOP SONAR 3 GO"]), SONAR)
    for sign in diver.session.current.task.sentence.signs:
        diver.sign(",".join(sign.pair))
        diver.look(None, None)
    assert diver.session.progress[0].is_done


def test_words_that_are_taken_back_are_no_mistakes():
    """By the rule "sentence" words come before the verdict."""
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.session = Session(named_tasks(GRAMMAR, ["STOP HOVER GO"]), GRAMMAR, 60.0, is_revised=True)
    diver.sign("ok,0 5,1")
    assert diver.session.progress[0].mistakes == []


def test_random_sentences_can_be_said_and_come_again_with_the_seed():
    for name in (None, "docs/grammars/sonar.toml", "docs/grammars/repeat.toml"):
        grammar = load_grammar(name)
        texts = [task.sentence.text for task in drawn_tasks(grammar, 6, seed=3)]
        assert len(set(texts)) == 6
        assert texts == [task.sentence.text for task in drawn_tasks(grammar, 6, seed=3)]
        assert texts != [task.sentence.text for task in drawn_tasks(grammar, 6, seed=4)]
    assert "ABORT" not in [task.sentence.text for task in drawn_tasks(SONAR, 50, seed=1)]


def test_the_study_has_the_papers_gestures():
    tasks = study_tasks(GRAMMAR)
    gestures = {
        kind: sum(len(task.sentence.signs) for task in tasks if task.kind == kind) for _, kind, _ in STUDY
    }
    assert gestures == {"STOP": 10, "CONTD": 10, "complex": 16}
    with pytest.raises(UsageError, match="study's sentences"):
        study_tasks(SONAR)


def a_person(person, level, *, wrong=0):
    """Signs all of the study, the first sentence wrong some times before."""
    diver = Diver(study_tasks(GRAMMAR))
    for _ in range(wrong):
        diver.sign("ok,0 5,1")
    for progress in diver.session.progress:
        diver.sign(" ".join(",".join(sign.pair) for sign in progress.task.sentence.signs))
    assert diver.session.is_done
    return summary_of(diver.session, person, level)


def test_the_table_of_a_group(tmp_path):
    people = [a_person("a", "beginner", wrong=2), a_person("b", "beginner"), a_person("c", "medium")]
    for content in people:
        (tmp_path / f"person-{content['person']}.json").write_text(json.dumps(content), encoding="utf-8")
    rows = tabulate(read_people(str(tmp_path)))
    assert [(row.kind, row.level, row.people, row.mistakes) for row in rows] == [
        ("STOP", "beginner", 2, 1.0),
        ("STOP", "medium", 1, 0.0),
        ("CONTD", "beginner", 2, 0.0),
        ("CONTD", "medium", 1, 0.0),
        ("complex", "beginner", 2, 0.0),
        ("complex", "medium", 1, 0.0),
    ]
    assert [(row.instructions, row.gestures) for row in rows[::2]] == [(2, 10), (2, 10), (2, 16)]
    assert to_csv(rows).splitlines()[1].startswith("STOP,2,10,beginner,2,1.0,0.0,")
    assert len(tell_table(rows)) == 7


def test_a_table_says_what_was_given_up(tmp_path):
    content = a_person("a", "expert")
    content["sentences"][0] |= {"done": False, "seconds": None}
    row = tabulate([content])[0]
    assert (row.seconds, row.given_up) == (None, 1)
    assert "1 given up" in tell_table([row])[1]


def test_a_file_that_is_no_result_is_named(tmp_path):
    (tmp_path / "person-x.json").write_text("{}", encoding="utf-8")
    with pytest.raises(UsageError, match="person-x"):
        read_people(str(tmp_path))


def test_the_picture_holds_all_words_and_confusions():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    for page in (summary_page(summary_of(diver.session)),):
        assert {"no sign was read", "no hand was read"} <= {
            item.text for item in page.items if isinstance(item, Text)
        }
    diver.sign("ok,0 3,5 5,5 ok,ok")
    page = summary_page(summary_of(diver.session, person="anna"))
    texts = [item.text for item in page.items if isinstance(item, Text)]
    assert {"STOP", "HOVER", "GO", "3", "Practice of anna"} <= set(texts)
    for item in page.items:
        assert item.x >= 0
        assert item.y <= page.height


def test_the_summary_in_lines():
    diver = Diver(named_tasks(GRAMMAR, ["STOP HOVER GO"]))
    diver.sign("ok,0 3,5 5,5 ok,ok")
    lines = list(tell_summary(summary_of(diver.session)))
    assert lines[0] == "1 of 1 sentence signed, 0 mistakes, 1 slip; 1.1 s a sign"
    assert lines[2] == "  5 as 3: 1 of 4"


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
